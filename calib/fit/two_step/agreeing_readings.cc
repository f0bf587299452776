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

using Distances = Eigen::ArrayXXd;

/// Of each sensor's field from the middle of all, by component, nT.
Distances distances(const FieldTable& b_nT) {
  Distances out = Distances::Zero(b_nT.rows() / 3, b_nT.cols());
  PerSensor<double> values(static_cast<std::size_t>(out.rows()));
  for (Eigen::Index k = 0; k < b_nT.cols(); ++k) {
    for (int a = 0; a < 3; ++a) {
      for (Eigen::Index i = 0; i < out.rows(); ++i)
        values.at(static_cast<std::size_t>(i)) = b_nT(3 * i + a, k);
      std::sort(values.begin(), values.end());
      const double middle = 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
      for (Eigen::Index i = 0; i < out.rows(); ++i) out(i, k) += std::pow(b_nT(3 * i + a, k) - middle, 2);
    }
  }
  return out.sqrt();
}

}  // namespace

AgreeingReadings agreeing_readings(const Readings& readings) {
  AgreeingReadings out{readings, {}};
  ReadingTable y(3 * static_cast<Eigen::Index>(readings.y_nT.size()), readings.poses());
  for (std::size_t i = 0; i < readings.y_nT.size(); ++i)
    y.middleRows<3>(3 * static_cast<Eigen::Index>(i)) = readings.y_nT[i];
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
  if (agreeing.left_out.empty()) return {};
  constexpr double kFar = 10;  // times what the poses kept show
  const Distances kept = distances(corrected_fields(agreeing.kept, fitted.sensors));
  const Distances all = distances(corrected_fields(readings, fitted.sensors));
  const Eigen::ArrayXd usual = kept.square().rowwise().mean().sqrt();
  std::vector<OutlierNode> out;
  for (const Eigen::Index k : agreeing.left_out) {
    const Eigen::ArrayXd ratio = all.col(k) / usual;
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
