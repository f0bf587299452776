// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/wandering.h"

#include <cmath>
#include <numbers>

namespace mgtd::calib::fit::joint {

Eigen::Matrix<double, kWanderingTerms, 1> WanderingTerms::at(double t_h) const {
  const double turn = std::numbers::pi * (t_h - from_h_) / length_h_;
  return Eigen::Matrix<double, kWanderingTerms, 1>::NullaryExpr([&](Eigen::Index i) {
    const double j = static_cast<double>(i + 1);
    return std::sqrt(2 * length_h_) / (j * std::numbers::pi) * std::cos(j * turn);
  });
}

}  // namespace mgtd::calib::fit::joint
