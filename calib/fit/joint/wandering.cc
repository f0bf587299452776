// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/wandering.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace mgtd::calib::fit::joint {

Eigen::Matrix<double, kWanderingTerms, 1> WanderingTerms::at(double t_h) const {
  const double turn = std::numbers::pi * (t_h - from_h_) / length_h_;
  return Eigen::Matrix<double, kWanderingTerms, 1>::NullaryExpr([&](Eigen::Index i) {
    const double j = static_cast<double>(i + 1);
    const double sd =
        spectrum_ == SlowSpectrum::walk ? std::sqrt(length_h_) / (j * std::numbers::pi) : 1 / std::sqrt(j);
    return sd * std::numbers::sqrt2 * std::cos(j * turn);
  });
}

double WanderingTerms::variance_at_end() const {
  if (spectrum_ == SlowSpectrum::walk) return length_h_ / 3;
  double sum = 0;
  for (std::size_t j = std::max<std::size_t>(poses_, kWanderingTerms); j > 0; --j)
    sum += 2 / static_cast<double>(j);
  return sum;
}

double WanderingTerms::variance_beyond() const {
  // cos^2 is one at the ends and a half on average.
  return (variance_at_end() - at(to_h()).squaredNorm()) / 2;
}

}  // namespace mgtd::calib::fit::joint
