// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/two_step/agreeing_readings.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "calib/fit/consensus.h"
#include "calib/fit/error_summary.h"

namespace mgtd::calib::fit::two_step {
namespace {

using Distances = Eigen::Array<double, kSensors, Eigen::Dynamic>;

/// Of each sensor's field from the middle two of the four, by component, nT.
Distances distances(const FieldTable& b_nT) {
  Distances out = Distances::Zero(kSensors, b_nT.cols());
  for (Eigen::Index k = 0; k < b_nT.cols(); ++k) {
    for (int a = 0; a < 3; ++a) {
      std::array<double, kSensors> values{};
      for (int i = 0; i < kSensors; ++i) values.at(static_cast<std::size_t>(i)) = b_nT(3 * i + a, k);
      std::sort(values.begin(), values.end());
      const double middle = 0.5 * (values[1] + values[2]);
      for (int i = 0; i < kSensors; ++i) out(i, k) += std::pow(b_nT(3 * i + a, k) - middle, 2);
    }
  }
  return out.sqrt();
}

}  // namespace

AgreeingReadings agreeing_readings(const Readings& readings) {
  AgreeingReadings out{readings, {}};
  ReadingTable y(sensor::kChannels, readings.poses());
  for (int i = 0; i < kSensors; ++i) y.middleRows<3>(3 * i) = readings.y_nT[static_cast<std::size_t>(i)];
  if (!looks_spoilt(y)) return out;
  const auto agreeing = agreeing_poses(y, readings.f_nT);
  if (!agreeing) return out;
  std::vector<Eigen::Index> all(static_cast<std::size_t>(readings.poses()));
  std::iota(all.begin(), all.end(), 0);
  std::set_difference(all.begin(), all.end(), agreeing->begin(), agreeing->end(),
                      std::back_inserter(out.left_out));
  if (!out.left_out.empty()) out.kept = readings.subset(*agreeing);
  return out;
}

std::vector<OutlierNode> left_out_nodes(const Readings& readings, const AgreeingReadings& agreeing,
                                        const TwoStep& fitted) {
  constexpr double kFar = 10;  // times what the poses kept show
  const Distances kept = distances(corrected_fields(agreeing.kept, fitted.sensors));
  const Distances all = distances(corrected_fields(readings, fitted.sensors));
  const Eigen::Array<double, kSensors, 1> usual = kept.square().rowwise().mean().sqrt();
  std::vector<OutlierNode> out;
  for (const Eigen::Index k : agreeing.left_out) {
    const Eigen::Array<double, kSensors, 1> ratio = all.col(k) / usual;
    Eigen::Index worst = 0;
    const double sigmas = ratio.maxCoeff(&worst);
    const bool one = (ratio > kFar).count() == 1;
    out.push_back({.pose = readings.number.at(static_cast<std::size_t>(k)),
                   .where = one ? fmt::format("s{}", worst + 1) : std::string("pose"),
                   .shift = all.col(k).maxCoeff() / std::sqrt(3.0),
                   .unit = "nT",
                   .sigmas = sigmas,
                   .place = static_cast<std::size_t>(k)});
  }
  return out;
}

}  // namespace mgtd::calib::fit::two_step
