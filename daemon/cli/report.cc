// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "daemon/cli/command.h"
#include "daemon/cli/doubts.h"
#include "daemon/cli/fit_flags.h"
#include "daemon/cli/report_page.h"
#include "daemon/cli/work_progress.h"

namespace mgtd::daemon::cli {
namespace {

constexpr const char* kReportHelp =
    "One page in HTML that needs nothing else: what was measured, the verdict and the checks, errors before "
    "and\n"
    "after, what the model leaves against time, angles, temperature and every extra column, what each effect "
    "takes\n"
    "out, what could be missing, and what this run cannot tell. Every section says what good looks like.\n\n"
    "  mgt report run.mgtrun -o report.html";

struct ReportArguments {
  std::string run, output;
  std::shared_ptr<FitFlags> flags;
};

Result<ReportContent> content_of(const ReportArguments& args) {
  auto source = read_source(args.run, *args.flags);
  if (!source) return tl::unexpected(source.error());
  auto options = fit_options(*args.flags, *source);
  if (!options) return tl::unexpected(options.error());
  auto fitted = calib::fit::method_choice::fit(source->table, *options);
  if (!fitted) return tl::unexpected(fitted.error());
  auto comparison = calib::criticism::tests::compare(source->table, *options);
  if (!comparison) return tl::unexpected(comparison.error());
  auto explained = calib::criticism::search::explain(source->table, {.fit = *options});
  if (!explained) return tl::unexpected(explained.error());
  auto history = history_of(args.run, *source);
  if (!history) return tl::unexpected(history.error());
  auto doubts = doubts_of(args.run, *source, *options);
  if (!doubts) return tl::unexpected(doubts.error());
  const std::string name = std::filesystem::path(args.run).filename().string();
  ReportContent out{.run = name,
                    .source = std::move(*source),
                    .fit = std::move(*fitted),
                    .comparison = std::move(*comparison),
                    .explained = std::move(*explained),
                    .waterfall = {},
                    .history = std::move(*history),
                    .doubts = std::move(*doubts),
                    .command = fmt::format("mgt report {} -o {}", name, args.output)};
  // With the model that explain ended with, the waterfall shows what adding the named effects would remove.
  if (!out.explained.model.empty()) {
    calib::fit::FitOptions whole = *options;
    whole.effects = out.explained.model;
    if (auto steps = calib::criticism::search::waterfall(out.source.table, whole))
      out.waterfall = std::move(*steps);
  }
  return out;
}

int run_report(const Session& session, const ReportArguments& args) {
  const auto content = with_progress("report", [&] { return content_of(args); });
  if (!content) return report(session, content.error());
  const std::string page = report_page(*content);
  if (auto written = write_file(args.output, page); !written) return report(session, written.error());
  if (session.json) {
    print_json({{"schema", "mgt.report/1"},
                {"output", args.output},
                {"bytes", page.size()},
                {"verdict", to_string(content->explained.finding)}});
  } else {
    fmt::print("report written to {}\n", args.output);
  }
  return 0;
}

}  // namespace

void add_report(CLI::App& app, Session& session) {
  auto args = std::make_shared<ReportArguments>();
  CLI::App* const command = add_command(app, session, "report", "everything about a run on one HTML page",
                                        [args, &session] { return run_report(session, *args); });
  command->footer(kReportHelp);
  command->add_option("RUN", args->run, "*.mgtrun or a pose table in CSV")->required();
  command->add_option("-o,--output", args->output, "report.html")->required();
  args->flags = add_model_flags(command);
}

}  // namespace mgtd::daemon::cli
