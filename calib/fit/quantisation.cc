// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/quantisation.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "calib/fit/readings.h"

namespace mgtd::calib::fit {
namespace {

constexpr std::size_t kFewestStuck = 12;  ///< different stuck readings of all axes together: a rail is one
constexpr int kMostSteps = 5000;          ///< between the two stuck readings that are nearest to each other
constexpr double kLeastOfNoise =
    0.5;                          ///< step of the means over their noise: below it adds 2 % to the variance
constexpr double kOnGrid = 0.02;  ///< of a step: what a table's own digits may be off
constexpr double kShareOnGrid = 0.95;  ///< of the stuck readings; a grid that does not exist gets 0.04

bool stuck(const Pose& pose, std::size_t sensor, std::size_t axis) {
  const auto& sd = pose.sd_nT[sensor][axis];
  return sd && *sd == 0 && pose.n.value_or(0) > 1;
}

double share_on_grid(const std::vector<double>& values, double step) {
  const auto on = std::count_if(values.begin(), values.end(), [&](double y) {
    return std::abs(y / step - std::round(y / step)) < kOnGrid;
  });
  return static_cast<double>(on) / static_cast<double>(values.size());
}

/// The largest step, `least` or more, that the values are multiples of; 0 for none, or for too few different
/// ones.
double step_of(std::vector<double> values, double least) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.size() < kFewestStuck) return 0;
  double nearest = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double gap = values[i] - values[i - 1];
    if (nearest == 0 || gap < nearest) nearest = gap;
  }
  for (int m = 1; nearest / m > least && m <= kMostSteps; ++m)
    if (share_on_grid(values, nearest / m) >= kShareOnGrid) return nearest / m;
  return 0;
}

/// The largest noise of a pose mean, of all axes; 0 where the table does not say how many samples there were.
double noise_of_means_nT(const PoseTable& table) {
  double fewest = 0;
  for (const Pose& pose : table.poses) {
    const double n = pose.n_eff ? *pose.n_eff : pose.n.value_or(0);
    if (!(n > 0)) return 0;
    fewest = fewest == 0 ? n : std::min(fewest, n);
  }
  return fewest == 0 ? 0 : pooled_sample_noise(table).maxCoeff() / std::sqrt(fewest);
}

/// The step that the means were rounded to, where that is more than their noise hides; 0 for none.
double step_of_means(const PoseTable& table) {
  const double least = kLeastOfNoise * noise_of_means_nT(table);
  if (!(least > 0)) return 0;
  std::vector<double> values;
  for (const Pose& pose : table.poses) {
    for (const Eigen::Vector3d& y_nT : pose.y_nT)
      if (y_nT.allFinite()) values.insert(values.end(), y_nT.begin(), y_nT.end());
  }
  return step_of(std::move(values), least);
}

}  // namespace

Quantisation quantisation_of(const PoseTable& table) {
  Quantisation out;
  if (!table.poses.empty())
    out.variance_nT2.setZero(static_cast<Eigen::Index>(table.poses.front().y_nT.size()), 3);
  out.step_nT = step_of_means(table);
  if (out.seen()) {
    out.variance_nT2.setConstant(out.step_nT * out.step_nT / 12);
    return out;
  }
  std::vector<double> values;
  calibration::AxisNoise count = out.variance_nT2;
  for (const Pose& pose : table.poses) {
    for (std::size_t i = 0; i < pose.y_nT.size(); ++i) {
      for (std::size_t a = 0; a < 3; ++a) {
        if (!stuck(pose, i, a)) continue;
        const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(a);
        values.push_back(pose.y_nT[i][column]);
        count(row, column) += 1;
      }
    }
  }
  out.step_nT = step_of(std::move(values), 0);
  out.variance_nT2 = count * (out.step_nT * out.step_nT / 12 / static_cast<double>(table.poses.size()));
  return out;
}

}  // namespace mgtd::calib::fit
