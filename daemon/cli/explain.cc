// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/explain.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "calib/report/explain_json.h"
#include "calib/report/explain_text.h"
#include "daemon/cli/command.h"
#include "daemon/cli/doubts.h"
#include "daemon/cli/fit_flags.h"
#include "daemon/cli/formulas.h"

namespace mgtd::cli {
namespace {

constexpr const char* kExplainHelp =
    "Verdicts: PASS nothing stands out; EXPLAINED what is named, one effect or several, accounts for it;\n"
    "AMBIGUOUS several could; PARTIAL effects were found and more is there; UNKNOWN something that is in no\n"
    "library; BAD-DATA. Offsets that wander and noise that is larger than the dwells say are noise, not "
    "laws.\n"
    "One clean run in a hundred is called something other than PASS.\n\n"
    "Columns: k coefficients; d and p how far beyond chance; share the part of the excess of chi-square "
    "that\n"
    "the effect would take away (1: all of it; -: these poses do not tell their noise, and nothing was "
    "found).\n\n"
    "  mgt explain run.mgtrun\n"
    "  mgt explain run.mgtrun --with site.gradient     what is missing beside a gradient of the site\n\n"
    "Exit code 0: PASS. 1: any other verdict.";

struct ExplainArguments {
  std::string run;
  std::shared_ptr<FitFlags> flags;
};

int run_explain(const Session& session, const ExplainArguments& args) {
  const auto source = read_source(args.run, *args.flags);
  if (!source) return report(session, source.error());
  const auto options = fit_options(*args.flags, *source);
  if (!options) return report(session, options.error());
  const auto explained =
      calib::explain(source->table, {.fit = *options, .also = formulas_of(*source, *options)});
  if (!explained) return report(session, explained.error());
  const auto doubts = doubts_of(args.run, *source, *options);
  if (!doubts) return report(session, doubts.error());
  if (session.json) {
    nlohmann::json out = calib::to_json(*explained);
    out["chosen_in_doubt"] = doubts_json(*doubts);
    print_json(out);
  } else {
    fmt::print("{}", calib::to_text(*explained));
    if (!doubts->empty()) fmt::print("\nopen since it was chosen:\n{}", doubts_text(*doubts));
  }
  return explained->finding == calib::Finding::pass ? 0 : 1;
}

}  // namespace

void add_explain(CLI::App& app, Session& session) {
  auto args = std::make_shared<ExplainArguments>();
  CLI::App* const command =
      add_command(app, session, "explain", "which physical effect is missing, and what cannot be told",
                  [args, &session] { return run_explain(session, *args); });
  command->footer(kExplainHelp);
  command->add_option("RUN", args->run, "*.mgtrun or a pose table in CSV")->required();
  args->flags = add_model_flags(command);
}

}  // namespace mgtd::cli
