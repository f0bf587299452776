// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "calib/criticism/search/improve.h"
#include "calib/effects/library/library.h"
#include "calib/report/improve_report.h"
#include "calib/report/waterfall_report.h"
#include "daemon/acquire/calibrated_with.h"
#include "daemon/cli/command.h"
#include "daemon/cli/fit_flags.h"
#include "daemon/cli/formulas.h"
#include "daemon/cli/output_file.h"
#include "daemon/cli/remaining_law.h"
#include "daemon/cli/work_progress.h"

namespace mgtd::daemon::cli {
namespace {

constexpr const char* kImproveHelp =
    "Each round adds the effect that explain names, fits everything again and judges what is left. An "
    "effect\n"
    "that makes held-out poses worse is not added.\n\n"
    "Where something remains (PARTIAL, UNKNOWN), mgt discover --quick looks for its formula, without the "
    "added\n"
    "effects first, since they may only stand in for it, and then beside them; --no-law leaves that out.\n\n"
    "  mgt improve run.mgtrun -o cal.json\n\n"
    "Exit code 0: nothing stands out any more. 1: something is left.";

struct ImproveArguments {
  std::string run, output;
  bool no_law{false};
  std::shared_ptr<FitFlags> flags;
};

/// The options with the effects of the final model; empty if one of them is not known.
std::optional<calib::fit::FitOptions> with_final_model(calib::fit::FitOptions options,
                                                       const calib::calibration::Calibration& calibration) {
  options.effects.clear();
  for (const calib::calibration::CalibratedEffect& e : calibration.effects) {
    auto effect =
        calib::effects::library::make_effect(e.effect, static_cast<int>(calibration.sensors.size()));
    if (!effect) return std::nullopt;
    options.effects.push_back(std::move(*effect));
  }
  return options;
}

/// What each effect of the final model removes from the error.
std::optional<calib::criticism::search::Waterfall> waterfall_of(const PoseTable& table,
                                                                const calib::fit::FitOptions& options) {
  if (options.effects.empty()) return std::nullopt;
  auto steps = with_progress("waterfall", options, [&](const calib::fit::FitOptions& told) {
    return calib::criticism::search::waterfall(table, told);
  });
  return steps ? std::optional(std::move(*steps)) : std::nullopt;
}

int run_improve(const Session& session, const ImproveArguments& args) {
  const auto output = OutputFile::at(args.output, files_read(args.run, *args.flags));
  if (!output) return print_error(session, output.error());
  const auto source = read_source(args.run, *args.flags);
  if (!source) return print_error(session, source.error());
  const auto options = fit_options(*args.flags, *source);
  if (!options) return print_error(session, options.error());
  const auto formulas = formulas_of(*source, *options);
  auto improved = with_progress("improve", *options, [&](const calib::fit::FitOptions& told) {
    return calib::criticism::search::improve(source->table, told, formulas);
  });
  if (!improved) return print_error(session, improved.error());
  acquire::name_instruments(improved->fit.calibration, args.run);
  const calib::calibration::Calibration& calibration = improved->fit.calibration;
  if (auto written =
          output->write(calib::calibration::to_json_text(calibration), "calibration " + calibration.id);
      !written)
    return print_error(session, written.error());
  const auto whole = with_final_model(*options, calibration);
  const auto steps = whole ? waterfall_of(source->table, *whole) : std::nullopt;
  const auto law = whole && !args.no_law
                       ? law_of_the_rest(source->table, *options, whole->effects, improved->finding)
                       : std::nullopt;
  if (law && !law->instead_of.empty() && output->wanted())
    fmt::print(stderr, "{} holds {}: formulas account for everything without that\n", output->path(),
               fmt::join(law->instead_of, ", "));
  if (session.json) {
    nlohmann::json out = calib::report::to_json(*improved);
    out["waterfall"] = steps ? calib::report::to_json(*steps) : nlohmann::json();
    if (!args.no_law) out["law"] = law_json(law, *source, args.run);
    print_json(out);
  } else {
    const std::size_t width = table_width(session);
    std::string text = calib::report::to_text(*improved, width);
    if (steps) text += "\n" + calib::report::to_text(*steps, width);
    print_text(session, text + law_text(law, *source, args.run));
  }
  return improved->finding == calib::criticism::search::Finding::pass ? 0 : 1;
}

}  // namespace

void add_improve(CLI::App& app, Session& session) {
  auto args = std::make_shared<ImproveArguments>();
  CLI::App* const command =
      add_command(app, session, "improve", "explain, add, fit again, until nothing is left",
                  [args, &session] { return run_improve(session, *args); });
  command->footer(kImproveHelp);
  command->add_option("RUN", args->run, "*.mgtrun or a pose table in CSV")->required();
  command->add_option("-o,--output", args->output, "write the calibration here (CAL.json)");
  command->add_flag("--no-law", args->no_law, "without a search for the formula of what remains");
  args->flags = add_model_flags(command);
}

}  // namespace mgtd::daemon::cli
