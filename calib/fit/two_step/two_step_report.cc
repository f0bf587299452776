// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/two_step/two_step_report.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "calib/fit/calibration_frame.h"
#include "calib/fit/error_summary.h"
#include "calib/fit/orientation.h"
#include "calib/fit/two_step/agreeing_readings.h"
#include "calib/fit/two_step/influence.h"
#include "calib/fit/two_step/two_step.h"

namespace mgtd::calib::fit::two_step {
namespace {

std::vector<Eigen::Index> where(Eigen::Index n, auto keep) {
  std::vector<Eigen::Index> out;
  for (Eigen::Index k = 0; k < n; ++k) {
    if (keep(k)) out.push_back(k);
  }
  return out;
}

/// The poses less every second one of the standard set, counted by azimuth: in a run that goes out in double
/// steps and comes back between them, one half was measured on the way out and the other on the way back.
Readings half_of(const Readings& readings, std::size_t parity) {
  std::vector<Eigen::Index> turn = where(readings.poses(), [&](Eigen::Index k) {
    const auto at = static_cast<std::size_t>(k);
    return readings.standard[at] && readings.angles[at];
  });
  std::sort(turn.begin(), turn.end(), [&](Eigen::Index a, Eigen::Index b) {
    return readings.angles[static_cast<std::size_t>(a)]->azimuth_rad <
           readings.angles[static_cast<std::size_t>(b)]->azimuth_rad;
  });
  std::vector<bool> dropped(static_cast<std::size_t>(readings.poses()), false);
  for (std::size_t j = parity; j < turn.size(); j += 2) dropped[static_cast<std::size_t>(turn[j])] = true;
  return readings.subset(
      where(readings.poses(), [&](Eigen::Index k) { return !dropped[static_cast<std::size_t>(k)]; }));
}

/// Step 1 is common to both halves, as in the paper's Table 5; only step 2 sees half of the standard set.
Result<PerSensor<sensor::SensorModel>> from_half(const Readings& readings, std::size_t parity,
                                                 const TwoStep& whole) {
  const Readings half = half_of(readings, parity);
  PerSensor<Eigen::Matrix3Xd> b_S_nT(half.y_nT.size());
  for (std::size_t i = 0; i < b_S_nT.size(); ++i) b_S_nT[i] = whole.step1[i].correct(half.y_nT[i]);
  auto alignment = align(half, b_S_nT, whole.alignment.bz_nT > 0 ? 1.0 : -1.0);
  if (!alignment) return tl::unexpected(alignment.error());
  turn_to(*alignment, whole.origin.declination_rad);
  PerSensor<sensor::SensorModel> out(b_S_nT.size());
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = sensor_from(whole.step1[i].K, whole.step1[i].offset_nT, alignment->R_PS[i]);
  }
  return out;
}

double largest_angle_difference(const PerSensor<sensor::SensorModel>& a,
                                const PerSensor<sensor::SensorModel>& b) {
  double mean_gamma = 0, worst = 0;
  const auto sensors = static_cast<double>(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) mean_gamma += (a[i].gamma_rad - b[i].gamma_rad) / sensors;
  for (std::size_t i = 0; i < a.size(); ++i) {
    worst =
        std::max({worst, std::abs(a[i].alpha_rad - b[i].alpha_rad), std::abs(a[i].beta_rad - b[i].beta_rad),
                  std::abs(a[i].gamma_rad - b[i].gamma_rad - mean_gamma)});
  }
  return worst;
}

std::optional<HalvesComparison> compare_halves(const Readings& readings, const TwoStep& whole,
                                               const sensor::Geometry& geometry) {
  const auto odd = from_half(readings, 1, whole), even = from_half(readings, 0, whole);
  if (!odd || !even) return std::nullopt;
  return HalvesComparison{summarise(corrected_fields(readings, *odd), readings.f_nT, geometry),
                          summarise(corrected_fields(readings, *even), readings.f_nT, geometry), *odd, *even,
                          largest_angle_difference(*odd, *even)};
}

/// Every pose corrected by a fit that has not seen it.
std::optional<ErrorSummary> hold_out(const Readings& readings, const FitOptions& options,
                                     const sensor::Geometry& geometry) {
  FieldTable b(3 * static_cast<Eigen::Index>(readings.y_nT.size()), readings.poses());
  const Eigen::Index n = readings.poses();
  for (Eigen::Index fold = 0; fold < kFolds; ++fold) {
    const Eigen::Index from = fold * n / kFolds, to = (fold + 1) * n / kFolds;
    const auto fitted =
        two_step(readings.subset(where(n, [&](Eigen::Index k) { return k < from || k >= to; })), options);
    if (!fitted) return std::nullopt;
    b.middleCols(from, to - from) = corrected_fields(readings, fitted->sensors).middleCols(from, to - from);
  }
  return summarise(b, readings.f_nT, geometry);
}

/// Noise of a pose mean for the standard errors: what the spreads say, or what the residual says where it is
/// larger by more than chance (three standard deviations of a variance).
calibration::AxisNoise effective_noise(const Readings& readings, const TwoStep& fitted,
                                       const ErrorSummary& step1) {
  calibration::AxisNoise noise = readings.pose_noise_nT;
  const auto n = static_cast<double>(readings.poses());
  const double dof = std::max(1.0, n - 9);
  const double by_chance = 1 + 3 * std::sqrt(2 / dof);
  const double scalar = readings.f_sd_nT.squaredNorm() / n;
  for (std::size_t i = 0; i < readings.y_nT.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const double variance =
        std::max(0.0, step1.total_field_rmse_nT[i] * step1.total_field_rmse_nT[i] * n / dof - scalar);
    for (int a = 0; a < 3; ++a) {
      const double stated = noise(at, a) / fitted.sensors[i].scale[a];
      if (variance > by_chance * stated * stated)
        noise(at, a) = std::sqrt(variance) * fitted.sensors[i].scale[a];
    }
  }
  return noise;
}

/// Step 1 only: sensors orthogonal and to scale, their frames left as they stand.
ErrorSummary after_step1(const Readings& readings, const TwoStep& fitted, const sensor::Geometry& geometry) {
  FieldTable b(3 * static_cast<Eigen::Index>(readings.y_nT.size()), readings.poses());
  for (std::size_t i = 0; i < readings.y_nT.size(); ++i) {
    b.middleRows<3>(3 * static_cast<Eigen::Index>(i)) =
        fitted.sensors[i].mounting * fitted.step1[i].correct(readings.y_nT[i]);
  }
  return summarise(b, readings.f_nT, geometry);
}

void fill_uncertainty(FitReport& report, const Readings& readings, const FitOptions& options,
                      const TwoStep& fitted) {
  calibration::Calibration& c = report.calibration;
  const calibration::AxisNoise effective = effective_noise(readings, fitted, report.after_step1);
  c.pose_noise_nT = (readings.pose_noise_nT.array() > 0).select(readings.pose_noise_nT, effective);
  report.noise_nT = calibration::root_mean_square(c.pose_noise_nT);
  report.noise_known = (readings.pose_noise_nT.array() > 0).all();
  const FieldTable b = corrected_fields(readings, fitted.sensors);
  report.chi2 = field_chi2(b, readings, fitted.sensors, c.pose_noise_nT);
  report.summary = {
      .termination = Termination::closed_form,
      .initial_cost = field_chi2(raw_fields(readings), readings,
                                 PerSensor<sensor::SensorModel>(fitted.sensors.size()), c.pose_noise_nT),
      .final_cost = report.chi2};
  report.dof = static_cast<double>(static_cast<Eigen::Index>(readings.y_nT.size()) * (readings.poses() - 9));
  const Influence spread = influence(readings, options, fitted, effective);
  c.covariance = spread.covariance;
  const Eigen::Vector3d site = fitted.site_direction();
  report.site = {.f_nT = readings.mean_f_nT(),
                 .inclination_rad = std::asin(site[2]),
                 .declination_rad = fitted.origin.declination_rad,
                 .inclination_sd_rad = spread.inclination_sd_rad,
                 .declination_sd_rad = spread.declination_sd_rad};
  report.azimuth_origin = fitted.origin;
}

}  // namespace

Result<FitReport> two_step_report(const PoseTable& table, const FitOptions& options) {
  const auto all = readings_of(table, options);
  if (!all) return tl::unexpected(all.error());
  const AgreeingReadings agreeing =
      options.most_left_out > 0 ? agreeing_readings(*all) : AgreeingReadings{*all, {}};
  const Readings* const readings = &agreeing.kept;
  const auto fitted = two_step(*readings, options);
  if (!fitted) return tl::unexpected(fitted.error());
  FitReport report;
  calibration::Calibration& c = report.calibration;
  c = calibration_frame(table, *readings, options);
  c.sensors = fitted->sensors;
  report.before = summarise(raw_fields(*readings), readings->f_nT, c.geometry);
  report.after_step1 = after_step1(*readings, *fitted, c.geometry);
  report.after = summarise(corrected_fields(*readings, fitted->sensors), readings->f_nT, c.geometry);
  fill_uncertainty(report, *readings, options, *fitted);
  if (options.method != Method::simplified) {
    FitOptions baseline = options;
    baseline.method = Method::simplified;
    if (const auto simple = two_step(*readings, baseline)) {
      report.simplified = summarise(corrected_fields(*readings, simple->sensors), readings->f_nT, c.geometry);
    }
  }
  if (const auto unseen = readings_of(table, options, PoseUse::check)) {
    report.check_poses = summarise(corrected_fields(*unseen, c.sensors), unseen->f_nT, c.geometry);
  }
  report.held_out = hold_out(*readings, options, c.geometry);
  report.halves = compare_halves(*readings, *fitted, c.geometry);
  report.outliers = left_out_nodes(*all, agreeing, *fitted);
  if (options.most_left_out > 0)
    report.contradicting = static_cast<double>(agreeing.left_out.size()) / static_cast<double>(all->poses());
  report.table.stated_sd_rad = options.table_sd_rad;
  return report;
}

}  // namespace mgtd::calib::fit::two_step
