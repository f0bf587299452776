// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <optional>

#include "calib/criticism/tests/comparison.h"
#include "calib/criticism/tests/measured_columns.h"
#include "calib/criticism/tests/residual_columns.h"
#include "calib/report/comparison_report.h"
#include "calib/report/figure_words.h"
#include "calib/report/measured_report.h"
#include "calib/report/residual_columns_report.h"
#include "calib/report/run_figures.h"
#include "daemon/cli/command.h"
#include "daemon/cli/figures_flag.h"
#include "daemon/cli/fit_flags.h"
#include "daemon/cli/output_file.h"
#include "daemon/cli/work_progress.h"

namespace mgtd::daemon::cli {
namespace {

constexpr const char* kCompareHelp =
    "Five ways of looking at what the joint fit leaves, each against time, azimuth, temperature and every\n"
    "extra column, with the means over each as a small plot. A scalar residual with no attitude residual is "
    "a\n"
    "sensor; an attitude residual alone is the table; what is alike in all sensors is the site.\n\n"
    "  mgt compare run.mgtrun --poses --json       arrays by column, one entry a pose; where the fit is\n"
    "                                              refused, what was measured, beside the refusal\n"
    "  mgt compare run.mgtrun -o residuals.csv     the same as a table\n\n"
    "Exit code 0: the model fits to the noise. 1: it does not.";

struct CompareArguments {
  std::string run, output;
  bool poses{false};
  std::shared_ptr<FitFlags> flags;
  FiguresFlag figures;
};

/// The nine panels, where the sensors were looked at from, and what happened when.
std::vector<calib::report::figures::Figure> figures_of(const calib::report::PanelModel& model) {
  std::vector<calib::report::figures::Figure> out = calib::report::panel_figures(model, nullptr);
  out.push_back(calib::report::coverage_of(model));
  out.push_back(calib::report::time_figure(model));
  if (auto closure = calib::report::closure_figure(model)) out.push_back(std::move(*closure));
  return out;
}

int run_compare(const Session& session, const CompareArguments& args) {
  if (const auto ready = ready_for_figures(session, args.figures); !ready)
    return print_error(session, ready.error());
  const auto output = OutputFile::at(args.output, files_read(args.run, *args.flags));
  if (!output) return print_error(session, output.error());
  const auto source = read_source(args.run, *args.flags);
  if (!source) return print_error(session, source.error());
  const auto options = fit_options(*args.flags, *source);
  if (!options) return print_error(session, options.error());
  const auto comparison = with_progress("compare", *options, [&](const calib::fit::FitOptions& told) {
    return calib::criticism::tests::compare(source->table, told);
  });
  const auto refused = [&](const Error& error) {
    if (!args.poses) return print_error(session, error);
    const auto measured = calib::criticism::tests::measured_columns(source->table, *options);
    return print_error(session, error, calib::report::to_json(measured));
  };
  if (!comparison) return refused(comparison.error());
  std::optional<calib::criticism::tests::ResidualColumns> left;
  if (args.poses || output->wanted() || args.figures.asked()) {
    auto found =
        with_progress("compare", [&] { return calib::criticism::tests::residual_columns(*comparison->fit); });
    if (!found) return refused(found.error());
    left = *std::move(found);
  }
  if (output->wanted()) {
    if (auto written = output->write(calib::report::to_csv(*left), "what is left at each pose"); !written)
      return print_error(session, written.error());
  }
  nlohmann::json out = calib::report::to_json(*comparison);
  if (auto drawn = hand_out(
          args.figures,
          [&] {
            return figures_of({*comparison, *left});
          },
          out);
      !drawn)
    return print_error(session, drawn.error());
  if (session.json) {
    if (args.poses) {
      out["poses"] = calib::report::to_json(*left);
      out.update(calib::report::panels_json({*comparison, *left}));
    }
    print_json(out);
  } else {
    print_text(session, calib::report::to_text(*comparison, table_width(session)));
  }
  return comparison->fits ? 0 : 1;
}

}  // namespace

void add_compare(CLI::App& app, Session& session) {
  auto args = std::make_shared<CompareArguments>();
  CLI::App* const command =
      add_command(app, session, "compare", "compare model and measurement: where does the model fail?",
                  [args, &session] { return run_compare(session, *args); });
  command->footer(kCompareHelp);
  command->add_option("RUN", args->run, "*.mgtrun or a pose table in CSV")->required();
  command->add_flag("--poses", args->poses, "with --json: what is left at each pose");
  command->add_option("-o,--output", args->output, "write what is left at each pose here (CSV)");
  add_figures_flag(command, args->figures);
  args->flags = add_model_flags(command);
}

}  // namespace mgtd::daemon::cli
