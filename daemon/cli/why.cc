// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "calib/criticism/search/evidence.h"
#include "calib/report/evidence_report.h"
#include "calib/report/explain_figures.h"
#include "calib/report/figure_words.h"
#include "daemon/cli/command.h"
#include "daemon/cli/figures_flag.h"
#include "daemon/cli/fit_flags.h"
#include "daemon/cli/formulas.h"
#include "daemon/cli/work_progress.h"

namespace mgtd::daemon::cli {
namespace {

constexpr const char* kWhyHelp =
    "The evidence for one effect: how far beyond chance, which poses carry it, what the fit leaves without "
    "and\n"
    "with it, what else it could be, and what would tell them apart. An effect of the model is taken out of "
    "it\n"
    "first.\n\n"
    "  mgt why axis.offset.temperature run.mgtrun\n"
    "  mgt why axis.offset.temperature run.mgtrun --at s3.z\n\n"
    "Exit code 0.";

struct WhyArguments {
  std::string run, effect, at;
  bool poses{false};
  std::shared_ptr<FitFlags> flags;
  FiguresFlag figures;
};

int run_why(const Session& session, WhyArguments args) {
  if (const auto ready = ready_for_figures(session, args.figures); !ready)
    return print_error(session, ready.error());
  if (const std::size_t at = args.effect.find('@'); at != std::string::npos && args.at.empty())
    args.at = args.effect.substr(at + 1, args.effect.find(',', at) - at - 1);
  const auto source = read_source(args.run, *args.flags);
  if (!source) return print_error(session, source.error());
  const auto options = fit_options(*args.flags, *source);
  if (!options) return print_error(session, options.error());
  calib::criticism::search::ExplainOptions wanted{.fit = *options, .also = formulas_of(*source, *options)};
  const auto evidence = with_progress("why", *options, [&](const calib::fit::FitOptions& told) {
    wanted.fit = told;
    return calib::criticism::search::evidence_of(source->table, wanted, args.effect, args.at, args.poses);
  });
  if (!evidence) return print_error(session, evidence.error());
  nlohmann::json out = calib::report::to_json(*evidence);
  if (auto drawn = hand_out(
          args.figures, [&] { return std::vector{calib::report::evidence_of(*evidence)}; }, out);
      !drawn)
    return print_error(session, drawn.error());
  if (session.json) {
    if (args.poses) out["figure"] = calib::report::words_json(calib::report::evidence_of(*evidence));
    print_json(out);
  } else {
    print_text(session, calib::report::to_text(*evidence));
  }
  return 0;
}

}  // namespace

void add_why(CLI::App& app, Session& session) {
  auto args = std::make_shared<WhyArguments>();
  CLI::App* const command = add_command(app, session, "why", "the evidence for one effect, and against it",
                                        [args, &session] { return run_why(session, *args); });
  command->footer(kWhyHelp);
  command->add_option("EFFECT", args->effect, "NAME or NAME@WHERE: see mgt effects")->required();
  command->add_option("RUN", args->run, "*.mgtrun or a pose table in CSV")->required();
  command->add_option("--at", args->at, "where it acts (s3.z, s3, all); else where it shows best");
  command->add_flag("--poses", args->poses, "with --json: what is left at each pose, without and with it");
  add_figures_flag(command, args->figures);
  args->flags = add_model_flags(command);
}

}  // namespace mgtd::daemon::cli
