// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include "calib/criticism/improve.h"
#include "calib/criticism/improve_report.h"
#include "daemon/cli/command.h"
#include "daemon/cli/fit_flags.h"

namespace mgtd::cli {
namespace {

constexpr const char* kHelp =
    "Each round adds the effect that explain names, fits everything again and judges what is left. An "
    "effect\n"
    "that makes poses left out worse is not added.\n\n"
    "  mgt improve run.mgtrun -o cal.json\n\n"
    "Exit code 0: nothing stands out any more. 1: something is left.";

struct Arguments {
  std::string run, output;
  std::shared_ptr<FitFlags> flags;
};

int run_improve(const Session& session, const Arguments& args) {
  const auto source = daemon::read_run(args.run);
  if (!source) return report(session, source.error());
  const auto options = fit_options(*args.flags, *source);
  if (!options) return report(session, options.error());
  const auto improved = calib::improve(source->table, *options);
  if (!improved) return report(session, improved.error());
  if (!args.output.empty()) {
    const calib::Calibration& calibration = improved->fit.calibration;
    if (auto written = write_file(args.output, calib::to_json_text(calibration)); !written)
      return report(session, written.error());
    fmt::print(stderr, "calibration {} written to {}\n", calibration.id, args.output);
  }
  if (session.json) {
    print_json(calib::to_json(*improved));
  } else {
    fmt::print("{}", calib::to_text(*improved));
  }
  return improved->finding == calib::Finding::pass ? 0 : 1;
}

}  // namespace

void add_improve(CLI::App& app, Session& session) {
  auto args = std::make_shared<Arguments>();
  CLI::App* const command =
      add_command(app, session, "improve", "explain, add, fit again, until nothing is left",
                  [args, &session] { return run_improve(session, *args); });
  command->footer(kHelp);
  command->add_option("RUN", args->run, "*.mgtrun or a pose table in CSV")->required();
  command->add_option("-o,--output", args->output, "write the calibration here (CAL.json)");
  args->flags = add_model_flags(command);
}

}  // namespace mgtd::cli
