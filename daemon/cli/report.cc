// SPDX-License-Identifier: Apache-2.0
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "calib/report/report_page.h"
#include "daemon/cli/command.h"
#include "daemon/cli/fit_flags.h"
#include "daemon/cli/output_file.h"
#include "daemon/cli/report_wishes.h"
#include "daemon/cli/work_progress.h"

namespace mgtd::daemon::cli {
namespace {

constexpr const char* kReportHelp =
    "One page in HTML that needs nothing else: the verdict and the checks, what was measured, the noise, "
    "what\n"
    "this run cannot tell, what each effect takes out, what the model leaves in nine figures before and "
    "after,\n"
    "what could be missing, errors, parameters, what effects cost and bring, and how the model came to be. "
    "Every\n"
    "figure says what a good one looks like, with the number of this run, and holds its data as a table.\n\n"
    "  mgt report run.mgtrun -o report.html";

struct ReportArguments {
  ReportWishes wishes;
  std::shared_ptr<FitFlags> flags;
};

int run_report(const Session& session, const ReportArguments& args) {
  std::vector<std::string> read = files_read(args.wishes.run, *args.flags);
  read.insert(read.end(), args.wishes.earlier.begin(), args.wishes.earlier.end());
  const auto output = OutputFile::at(args.wishes.output, read);
  if (!output) return print_error(session, output.error());
  const auto content = [&] {
    const WorkProgress shown("report");
    return report_content(args.wishes, *args.flags, shown.rounds());
  }();
  if (!content) return print_error(session, content.error());
  const std::string page = calib::report::report_page(*content);
  if (auto written = output->write(page, "report"); !written) return print_error(session, written.error());
  if (session.json)
    print_json({{"schema", "mgt.report/1"},
                {"output", args.wishes.output},
                {"bytes", page.size()},
                {"verdict", to_string(content->explained.finding)}});
  return 0;
}

}  // namespace

void add_report(CLI::App& app, Session& session) {
  auto args = std::make_shared<ReportArguments>();
  CLI::App* const command = add_command(app, session, "report", "everything about a run on one HTML page",
                                        [args, &session] { return run_report(session, *args); });
  command->footer(kReportHelp);
  command->add_option("RUN", args->wishes.run, "*.mgtrun or a pose table in CSV")->required();
  command->add_option("-o,--output", args->wishes.output, "report.html")->required();
  command->add_option("--operator", args->wishes.operator_name, "who measured: stands in the report");
  command->add_option("--site", args->wishes.site, "where: stands in the report");
  command
      ->add_option("--earlier", args->wishes.earlier,
                   "an earlier calibration (CAL.json) or run of the same rig, to show how its parameters "
                   "moved; may be "
                   "given again")
      ->allow_extra_args(false);
  args->flags = add_model_flags(command);
}

}  // namespace mgtd::daemon::cli
