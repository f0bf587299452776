// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/explain.h"

#include <fmt/format.h>

#include "calib/criticism/explain_json.h"
#include "calib/criticism/explain_text.h"
#include "daemon/cli/command.h"
#include "daemon/cli/fit_flags.h"

namespace mgtd::cli {
namespace {

constexpr const char* kHelp =
    "Verdicts: PASS nothing stands out; EXPLAINED one effect accounts for it; AMBIGUOUS several could;\n"
    "PARTIAL effects were found and more is there; UNKNOWN something that is in no library; BAD-DATA.\n"
    "One clean run in a hundred is called something other than PASS.\n\n"
    "  mgt explain run.mgtrun\n"
    "  mgt explain run.mgtrun --with site.gradient     what is missing beside a gradient of the site\n\n"
    "Exit code 0: PASS. 1: any other verdict.";

struct Arguments {
  std::string run;
  std::shared_ptr<FitFlags> flags;
};

int run_explain(const Session& session, const Arguments& args) {
  const auto source = daemon::read_run(args.run);
  if (!source) return report(session, source.error());
  const auto options = fit_options(*args.flags, *source);
  if (!options) return report(session, options.error());
  const auto explained = calib::explain(source->table, {.fit = *options});
  if (!explained) return report(session, explained.error());
  if (session.json) {
    print_json(calib::to_json(*explained));
  } else {
    fmt::print("{}", calib::to_text(*explained));
  }
  return explained->finding == calib::Finding::pass ? 0 : 1;
}

}  // namespace

void add_explain(CLI::App& app, Session& session) {
  auto args = std::make_shared<Arguments>();
  CLI::App* const command =
      add_command(app, session, "explain", "which physical effect is missing, and what cannot be told",
                  [args, &session] { return run_explain(session, *args); });
  command->footer(kHelp);
  command->add_option("RUN", args->run, "*.mgtrun or a pose table in CSV")->required();
  args->flags = add_model_flags(command);
}

}  // namespace mgtd::cli
