// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/explain.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "calib/criticism/search/stand_ins.h"
#include "calib/report/explain_figures.h"
#include "calib/report/explain_json.h"
#include "calib/report/explain_text.h"
#include "calib/report/figure_words.h"
#include "daemon/cli/command.h"
#include "daemon/cli/doubts.h"
#include "daemon/cli/figures_flag.h"
#include "daemon/cli/fit_flags.h"
#include "daemon/cli/formulas.h"
#include "daemon/cli/remaining_law.h"
#include "daemon/cli/search_figures.h"
#include "daemon/cli/work_progress.h"

namespace mgtd::daemon::cli {
namespace {

constexpr const char* kExplainHelp =
    "Verdicts: PASS nothing stands out; EXPLAINED what is named, one effect or several, accounts for it;\n"
    "AMBIGUOUS several could; PARTIAL effects were found, and something more is there; UNKNOWN something "
    "that\n"
    "is in no library; BAD-DATA. Wandering offsets, and noise that is larger than the dwells show, count as\n"
    "noise, not as laws. One clean run in a hundred gets a verdict other than PASS.\n\n"
    "Columns: k, number of coefficients; d and p, how far beyond chance; share, the part of the excess of\n"
    "chi-square that the effect would take away (1: all of it; -: the noise is not known from these poses,\n"
    "and nothing was found).\n\n"
    "Where something remains (PARTIAL, UNKNOWN), mgt discover --quick looks for its formula, first without\n"
    "what was named: a name that formulas account for is taken back, and where none remains the verdict is\n"
    "UNKNOWN. Where formulas alone leave something, it looks beside what was named. --no-law leaves that\n"
    "out.\n\n"
    "  mgt explain run.mgtrun\n"
    "  mgt explain run.mgtrun --with site.gradient     what is missing beside a gradient of the site\n\n"
    "Exit code 0: PASS. 1: any other verdict.";

struct ExplainArguments {
  std::string run;
  bool confusion{false}, impact{false}, no_law{false};
  std::shared_ptr<FitFlags> flags;
  FiguresFlag figures;
};

using Figures = std::vector<calib::report::figures::Figure>;

/// Pictures where they were asked for, else the words that stand beside those of the console.
Result<void> add_figures(const ExplainArguments& args, const PoseTable& table,
                         const calib::criticism::search::ExplainOptions& options,
                         const calib::criticism::search::ExplainReport& explained, nlohmann::json& out) {
  const auto with_limits = [&](Figures figures) {
    for (auto& figure : limit_figures(explained)) figures.push_back(std::move(figure));
    return figures;
  };
  if (args.confusion && !args.figures.asked()) {
    Figures candidates;
    if (!explained.candidates.empty()) candidates.push_back(calib::report::candidates_of(explained));
    out["figures"] = calib::report::words_by_name(with_limits(std::move(candidates)));
  }
  const auto drawn = [&] { return with_limits(candidate_figures(table, options, explained)); };
  return hand_out(args.figures, drawn, out);
}

int run_explain(const Session& session, const ExplainArguments& args) {
  if (const auto ready = ready_for_figures(session, args.figures); !ready)
    return print_error(session, ready.error());
  const auto source = read_source(args.run, *args.flags);
  if (!source) return print_error(session, source.error());
  const auto options = fit_options(*args.flags, *source);
  if (!options) return print_error(session, options.error());
  calib::criticism::search::ExplainOptions wanted{.fit = *options,
                                                  .also = formulas_of(*source, *options),
                                                  .confusion = args.confusion,
                                                  .impact = args.impact};
  auto explained = with_progress("explain", *options, [&](const calib::fit::FitOptions& told) {
    wanted.fit = told;
    return calib::criticism::search::explain(source->table, wanted);
  });
  if (!explained) return print_error(session, explained.error());
  const auto doubts = doubts_of(args.run, *source, *options);
  if (!doubts) return print_error(session, doubts.error());
  const auto law = args.no_law
                       ? std::nullopt
                       : law_of_the_rest(source->table, *options, explained->model, explained->finding);
  if (law) calib::criticism::search::take_back_stand_ins(law->instead_of, *explained);
  explained->formulas_account = law && law->found && law->found->accounts_for_everything();
  nlohmann::json out = calib::report::to_json(*explained);
  if (auto drawn = add_figures(args, source->table, wanted, *explained, out); !drawn)
    return print_error(session, drawn.error());
  if (session.json) {
    if (!args.no_law) out["law"] = law_json(law, *source, args.run);
    out["chosen_in_doubt"] = doubts_json(*doubts);
    print_json(out);
  } else {
    std::string text = calib::report::to_text(*explained, table_width(session));
    if (!doubts->empty()) text += "\nopen since it was chosen:\n" + doubts_text(*doubts);
    text += law_text(law, *source, args.run);
    print_text(session, text);
  }
  return explained->finding == calib::criticism::search::Finding::pass ? 0 : 1;
}

}  // namespace

void add_explain(CLI::App& app, Session& session) {
  auto args = std::make_shared<ExplainArguments>();
  CLI::App* const command = add_command(app, session, "explain",
                                        "which physical effect is missing, and what these poses cannot tell",
                                        [args, &session] { return run_explain(session, *args); });
  command->footer(kExplainHelp);
  command->add_option("RUN", args->run, "*.mgtrun or a pose table in CSV")->required();
  command->add_flag("--confusion", args->confusion, "also: which effects look alike on this run");
  command->add_flag("--impact", args->impact, "also: what ignoring each effect would do to the tensor, nT/m");
  command->add_flag("--no-law", args->no_law, "without a search for the formula of what remains");
  add_figures_flag(command, args->figures);
  args->flags = add_model_flags(command);
}

}  // namespace mgtd::daemon::cli
