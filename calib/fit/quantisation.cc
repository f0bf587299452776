// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/quantisation.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace mgtd::calib {
namespace {

constexpr std::size_t kFewestStuck = 12;  ///< different stuck readings of all axes together: a rail is one
constexpr int kMostSteps = 5000;          ///< between the two stuck readings that are nearest to each other
constexpr double kOnGrid = 0.02;          ///< of a step: what a table's own digits may be off
constexpr double kShareOnGrid = 0.95;     ///< of the stuck readings; a grid that does not exist gets 0.04

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

/// The largest step that the values are multiples of; 0 for none, or for too few different ones.
double step_of(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  if (values.size() < kFewestStuck) return 0;
  double nearest = 0;
  for (std::size_t i = 1; i < values.size(); ++i) {
    const double gap = values[i] - values[i - 1];
    if (nearest == 0 || gap < nearest) nearest = gap;
  }
  for (int m = 1; nearest > 0 && m <= kMostSteps; ++m)
    if (share_on_grid(values, nearest / m) >= kShareOnGrid) return nearest / m;
  return 0;
}

}  // namespace

Quantisation quantisation_of(const PoseTable& table) {
  Quantisation out;
  std::vector<double> values;
  AxisNoise count = AxisNoise::Zero();
  for (const Pose& pose : table.poses) {
    for (std::size_t i = 0; i < kSensors; ++i) {
      for (std::size_t a = 0; a < 3; ++a) {
        if (!stuck(pose, i, a)) continue;
        const auto row = static_cast<Eigen::Index>(i), column = static_cast<Eigen::Index>(a);
        values.push_back(pose.y_nT[i][column]);
        count(row, column) += 1;
      }
    }
  }
  out.step_nT = step_of(std::move(values));
  out.variance_nT2 = count * (out.step_nT * out.step_nT / 12 / static_cast<double>(table.poses.size()));
  return out;
}

}  // namespace mgtd::calib
