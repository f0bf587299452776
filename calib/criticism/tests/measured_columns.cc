// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/measured_columns.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "calib/poses/pose_columns.h"
#include "calib/poses/run_time.h"
#include "calib/stats/median.h"

namespace mgtd::calib::criticism::tests {
namespace {

constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

double field_of(const Pose& pose, const fit::FitOptions& options) {
  if (pose.f_nT) return *pose.f_nT;
  if (pose.ref_nT) return pose.ref_nT->norm();
  return options.field_nT.value_or(kNotMeasured);
}

/// Root mean square of the axes that tell one.
double spread_of(const std::array<std::optional<double>, 3>& sd_nT) {
  double sum = 0;
  int axes = 0;
  for (const std::optional<double>& sd : sd_nT) {
    if (!sd) continue;
    sum += *sd * *sd;
    ++axes;
  }
  return axes > 0 ? std::sqrt(sum / axes) : kNotMeasured;
}

double median_of_finite(const Eigen::RowVectorXd& row) {
  std::vector<double> values;
  std::copy_if(row.begin(), row.end(), std::back_inserter(values), [](double v) { return std::isfinite(v); });
  return values.empty() ? kNotMeasured : stats::median(std::move(values));
}

}  // namespace

std::map<std::string, std::vector<double>> extra_columns(std::span<const Pose* const> poses) {
  std::map<std::string, std::vector<double>> out;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    for (const auto& [name, value] : poses[k]->covariates)
      out.try_emplace(name, poses.size(), kNotMeasured).first->second[k] = value;
  }
  return out;
}

MeasuredColumns measured_columns(const PoseTable& table, const fit::FitOptions& options) {
  MeasuredColumns out;
  for (const Pose& pose : table.poses)
    if (pose.set != "check") out.pose.push_back(&pose);
  const poses::RunTime time = poses::RunTime::of(table);
  const auto sensors = static_cast<Eigen::Index>(table.poses.empty() ? 0 : poses::sensors_of(table));
  const auto n = static_cast<Eigen::Index>(out.pose.size());
  out.columns = extra_columns(out.pose);
  out.reading_nT.resize(3 * sensors, n);
  out.spread_nT.resize(sensors, n);
  out.length_nT.resize(sensors, n);
  out.direction_S.resize(3 * sensors, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const Pose& pose = *out.pose[static_cast<std::size_t>(k)];
    out.t_h.push_back(poses::missing_time(pose).empty() ? time.hours(pose) : kNotMeasured);
    out.f_nT.push_back(field_of(pose, options));
    for (Eigen::Index s = 0; s < sensors; ++s) {
      const auto at = static_cast<std::size_t>(s);
      out.reading_nT.block<3, 1>(3 * s, k) = pose.y_nT[at];
      out.spread_nT(s, k) = spread_of(pose.sd_nT[at]);
      out.length_nT(s, k) = pose.y_nT[at].norm();
      out.direction_S.block<3, 1>(3 * s, k) = pose.y_nT[at].normalized();
    }
  }
  out.field_known = std::any_of(out.f_nT.begin(), out.f_nT.end(), [](double f) { return std::isfinite(f); });
  out.raw_nT = out.length_nT;
  for (Eigen::Index s = 0; s < sensors; ++s) {
    if (out.field_known) {
      out.raw_nT.row(s) -= Eigen::Map<const Eigen::RowVectorXd>(out.f_nT.data(), n);
    } else {
      out.raw_nT.row(s).array() -= median_of_finite(out.length_nT.row(s));
    }
  }
  return out;
}

}  // namespace mgtd::calib::criticism::tests
