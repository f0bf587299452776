// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration/apply.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

#include "daemon/cli/calibration_file.h"
#include "daemon/cli/command.h"
#include "daemon/cli/output_file.h"
#include "daemon/cli/work_progress.h"
#include "daemon/store/pose_source.h"

namespace mgtd::daemon::cli {
namespace {

struct ApplyArguments {
  std::string calibration, run, output;
  calib::calibration::ApplyOptions options;
};

/// Median over the rows of the closure's chi-square; empty where no row has the uncertainty of its closure.
std::optional<double> median_closure_chi2(const std::vector<calib::calibration::AppliedPose>& rows) {
  std::vector<double> chi2;
  for (const calib::calibration::AppliedPose& row : rows)
    if (std::isfinite(row.sample.closure.chi2)) chi2.push_back(row.sample.closure.chi2);
  if (chi2.empty()) return std::nullopt;
  const auto middle = chi2.begin() + static_cast<std::ptrdiff_t>(chi2.size() / 2);
  std::nth_element(chi2.begin(), middle, chi2.end());
  return *middle;
}

/// Refuses a calibration of another rig.
void doubt_closure(const std::vector<calib::calibration::AppliedPose>& rows) {
  constexpr double kDoubtful = 100;
  const auto chi2 = median_closure_chi2(rows);
  if (!chi2) return;
  const double dof = rows.front().sample.closure.dof, expected = dof - 0.6;  // median of chi-square, nearly
  if (*chi2 < kDoubtful * std::max(1.0, dof / 4)) return;
  fmt::print(
      stderr,
      "closure_chi2 is {:.3g} in the median of the rows where {:.1f} is expected: the calibration does not "
      "hold for these readings, or is that of another rig; mgt check tells what has changed\n",
      *chi2, expected);
}

int run_apply(const Session& session, const ApplyArguments& args) {
  const auto output = OutputFile::at(args.output, {args.calibration, args.run});
  if (!output) return print_error(session, output.error());
  const auto flags = with_places_of({args.calibration, args.run}, {});
  if (!flags) return print_error(session, flags.error());
  const auto calibration = with_progress("apply", [&] { return calibration_of(args.calibration, *flags); });
  if (!calibration) return print_error(session, calibration.error());
  const auto source = store::read_run(args.run, store::Masked::kept);
  if (!source) return print_error(session, source.error());
  if (auto same = same_array(*calibration, args.calibration, *source); !same)
    return print_error(session, same.error());
  const auto rows = with_progress(
      "apply", [&] { return calib::calibration::apply(*calibration, source->table, args.options); });
  if (!rows) return print_error(session, rows.error());
  const std::string csv = calib::calibration::format_applied(*rows);
  std::set<std::string> left_out;
  for (const calib::calibration::AppliedPose& row : *rows)
    left_out.insert(row.left_out.begin(), row.left_out.end());
  for (const std::string& effect : left_out)
    fmt::print(stderr, "{} was left out where its inputs are missing: see the column left_out\n", effect);
  doubt_closure(*rows);
  if (auto written = output->write(csv, fmt::format("{} rows", rows->size())); !written)
    return print_error(session, written.error());
  if (session.json) {
    print_json({{"schema", "mgt.apply/1"},
                {"calibration", calibration->id},
                {"poses", rows->size()},
                {"left_out", left_out},
                {"output", output->wanted() ? nlohmann::json(output->path()) : nlohmann::json()}});
  } else if (!output->wanted()) {
    fmt::print("{}", csv);
  }
  return 0;
}

}  // namespace

void add_apply(CLI::App& app, Session& session) {
  auto args = std::make_shared<ApplyArguments>();
  CLI::App* const command =
      add_command(app, session, "apply", "calibrated field of every sensor and the tensor, row by row (CSV)",
                  [args, &session] { return run_apply(session, *args); });
  command
      ->add_option("CAL", args->calibration,
                   "CAL.json of mgt fit -o, or a run to fit first, with the model it keeps")
      ->required();
  command->add_option("RUN", args->run, "*.mgtrun or a pose table in CSV")->required();
  command->add_option("-o,--output", args->output, "file; standard output when absent");
  command->add_flag("--remove-site", args->options.remove_site,
                    "take the site's effects out too; needs the table angles");
  command->add_flag("--missing-ok", args->options.missing_ok,
                    "leave effects out whose inputs the table lacks, with wider standard deviations");
}

}  // namespace mgtd::daemon::cli
