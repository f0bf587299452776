// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/discovery/grammar.h"
#include "calib/discovery/scalars.h"

/// A Factor is one of the two expressions that a formula multiplies; it is written once about its mean and
/// once about the zero of its scale.
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
