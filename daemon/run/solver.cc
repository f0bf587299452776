// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/solver.h"

#include "calib/criticism/tests/exchange_in_run.h"
#include "calib/effects/library/library.h"
#include "calib/report/rearrangement_text.h"
#include "daemon/acquire/calibrated_with.h"

namespace mgtd::daemon::run {

calib::fit::FitOptions fit_options(const store::RunOptions& options) {
  calib::fit::FitOptions out;
  out.field_nT = options.field_nT;
  out.field_sd_nT = options.field_sd_nT.value_or(out.field_sd_nT);
  out.inclination_rad = options.inclination_rad;
  out.declination_rad = options.declination_rad;
  out.geometry = options.geometry;
  out.table_sd_rad = options.table_sd_rad.value_or(out.table_sd_rad);
  return out;
}

Result<calib::fit::FitOptions> fit_options(const store::PoseSource& source) {
  calib::fit::FitOptions out = source.header ? fit_options(source.header->options) : calib::fit::FitOptions{};
  for (const std::string& spec : source.model) {
    auto effect = calib::effects::library::make_effect(
        spec, calib::effects::EffectContext{.table = &source.table, .offset_nT = {}}.sensors());
    if (!effect) return tl::unexpected(effect.error());
    out.effects.push_back(std::move(*effect));
  }
  return out;
}

Result<calib::fit::FitReport> solve_run(const std::filesystem::path& run_file, std::stop_token stop) {
  const auto source = store::read_run(run_file);
  if (!source) return tl::unexpected(source.error());
  auto options = fit_options(*source);
  if (options) options->stop = std::move(stop);
  if (!options) return tl::unexpected(options.error());
  auto report = calib::fit::method_choice::fit(source->table, *options);
  if (!report) return report;
  acquire::name_instruments(report->calibration, run_file);
  if (report->calibration.accepted_by_checks) return report;
  // The cause, before what it led to.
  if (const auto exchange = calib::criticism::tests::exchange_in_run(source->table, options->field_nT))
    report->found_beside.insert(report->found_beside.begin(), calib::report::exchange_text(*exchange));
  return report;
}

}  // namespace mgtd::daemon::run
