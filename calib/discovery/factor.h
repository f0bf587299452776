// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/discovery/grammar.h"
#include "calib/discovery/scalars.h"

/// A factor is what stands in a product: an expression about its mean, and the same about its zero.
namespace mgtd::calib::discovery {

struct Factor {
  std::string about_mean, about_zero, covariate;
  int symbols{1}, foreign_sensor{-1};
  bool common{true};
};

[[nodiscard]] Factor factor(const Scalar& s);
/// Each factor about its mean and about its zero: the grid of the family says which.
[[nodiscard]] Family product(const Factor& a, const Factor& b, int symbols);

}  // namespace mgtd::calib::discovery
