// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/readings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "calib/fit/dwell_motion.h"
#include "calib/fit/site_difference.h"
#include "calib/stats/median.h"

namespace mgtd::calib::fit {
namespace {

/// Times the median spread of the axis. A dwell that is above it was disturbed and tells nothing of the
/// noise.
constexpr double kDisturbed = 5;

/// Of the variance within the dwells: what is left of it when the motion of the field is taken off.
constexpr double kLeastOfSpread = 0.1;

std::size_t sensors_of(const PoseTable& table) {
  return table.poses.empty() ? kSensorCount : table.poses.front().y_nT.size();
}

calibration::AxisNoise none_known(const PoseTable& table) {
  return calibration::AxisNoise::Zero(static_cast<Eigen::Index>(sensors_of(table)), 3);
}

calibration::AxisNoise median_spread(const PoseTable& table) {
  calibration::AxisNoise out = none_known(table);
  for (std::size_t i = 0; i < sensors_of(table); ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      std::vector<double> values;
      for (const Pose& pose : table.poses)
        if (pose.sd_nT[i][a]) values.push_back(*pose.sd_nT[i][a]);
      out(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(a)) = stats::median(std::move(values));
    }
  }
  return out;
}

/// Mean square over quiet poses of sd^2 / weight(pose), per axis; zero where nothing is known.
template <class Weight>
calibration::AxisNoise pooled(const PoseTable& table, Weight weight) {
  calibration::AxisNoise sum = none_known(table), count = sum;
  const calibration::AxisNoise usual = median_spread(table);
  for (const Pose& pose : table.poses) {
    for (std::size_t i = 0; i < pose.sd_nT.size(); ++i) {
      for (std::size_t a = 0; a < 3; ++a) {
        const auto& sd = pose.sd_nT[i][a];
        if (!sd) continue;
        const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(a);
        if (usual(row, column) > 0 && *sd > kDisturbed * usual(row, column)) continue;
        sum(row, column) += *sd * *sd / weight(pose);
        count(row, column) += 1;
      }
    }
  }
  return (count.array() > 0).select(sum.array() / count.array().max(1), 0.0).sqrt();
}

}  // namespace

calibration::AxisNoise pooled_sample_noise(const PoseTable& table) {
  const calibration::AxisNoise spread = pooled(table, [](const Pose&) { return 1.0; });
  const auto motion = dwell_motion(table);
  if (!motion || !motion->vector) return spread;
  const double square = std::pow(motion->component_nT, 2);
  return (spread.array().square() - square).max(kLeastOfSpread * spread.array().square()).sqrt();
}

Readings Readings::subset(const std::vector<Eigen::Index>& which) const {
  Readings out;
  out.y_nT.resize(y_nT.size());
  for (std::size_t i = 0; i < y_nT.size(); ++i) out.y_nT[i] = y_nT[i](Eigen::all, which);
  out.f_nT = f_nT(which);
  out.f_sd_nT = f_sd_nT(which);
  out.pose_noise_nT = pose_noise_nT;
  for (const Eigen::Index k : which) {
    out.angles.push_back(angles[static_cast<std::size_t>(k)]);
    out.standard.push_back(standard[static_cast<std::size_t>(k)]);
    out.number.push_back(number[static_cast<std::size_t>(k)]);
  }
  return out;
}

Result<Readings> readings_of(const PoseTable& table, const FitOptions& options, PoseUse use) {
  std::vector<const Pose*> used;
  for (const Pose& pose : table.poses) {
    if ((pose.set == "check") == (use == PoseUse::check)) used.push_back(&pose);
  }
  if (used.empty()) {
    return fail(ErrorCode::refused, "no pose to use",
                "poses of the set 'check' are never fitted: add others");
  }
  Readings out;
  const auto n = static_cast<Eigen::Index>(used.size());
  out.y_nT.resize(sensors_of(table));
  for (auto& y : out.y_nT) y.resize(3, n);
  out.f_nT.resize(n);
  out.f_sd_nT.resize(n);
  const SiteDifference difference = site_difference(table);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Pose& pose = *used[static_cast<std::size_t>(k)];
    if (!pose.f_nT && !pose.ref_nT && !options.field_nT) {
      return fail(
          ErrorCode::refused, fmt::format("pose {} has no f_nT and no field is given", pose.number),
          "give the total field of the site with --field NT, or measure it with a scalar magnetometer");
    }
    const TotalField field = pose.f_nT || pose.ref_nT ? total_field(pose, difference)
                                                      : TotalField{options.field_nT.value_or(0), 0.0};
    out.f_nT[k] = field.f_nT;
    out.f_sd_nT[k] = field.sd_nT;
    if (!pose.ref_nT && !(out.f_nT[k] > 1000 && out.f_nT[k] < 200'000)) {
      return fail(ErrorCode::refused,
                  fmt::format("pose {}: a total field of {} nT", pose.number, out.f_nT[k]),
                  "it must be in nT, between 1000 and 200000; check f_nT or --field");
    }
    for (std::size_t i = 0; i < pose.y_nT.size(); ++i) out.y_nT[i].col(k) = pose.y_nT[i];
    out.standard.push_back(pose.set == "standard");
    out.number.push_back(pose.number);
    out.angles.push_back(pose.angles());
    // A table with one axis reports no tilt: the standard set is level by definition.
    if (out.standard.back() && pose.azimuth_rad && !out.angles.back())
      out.angles.back() =
          TableAngles{*pose.azimuth_rad, pose.pitch_rad.value_or(0), pose.roll_rad.value_or(0)};
  }
  out.pose_noise_nT =
      pooled(table, [](const Pose& p) { return std::max(1.0, p.n_eff.value_or(p.n.value_or(1.0))); });
  return out;
}

}  // namespace mgtd::calib::fit
