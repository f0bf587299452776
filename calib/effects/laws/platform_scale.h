// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "calib/effects/effect.h"
#include "calib/effects/where.h"

/// A PlatformScale lists the coefficients of an effect that has a vector or a matrix for each sensor. The
/// list is the same for every sensor, "s3.x", and is made for one sensor or for all.
namespace mgtd::calib::effects::laws {

class PlatformScale {
 public:
  PlatformScale(const std::vector<std::string>& names, const char* unit, double typical, const Where& where,
                double prior_sd = 0);
  [[nodiscard]] const std::vector<Coefficient>& coefficients() const { return coefficients_; }
  [[nodiscard]] std::span<const int> at(int sensor) const { return at_[static_cast<std::size_t>(sensor)]; }
  /// "NAME", or "NAME@s3"
  [[nodiscard]] std::string spec(std::string_view name) const;
  [[nodiscard]] const Where& where() const { return where_; }

 private:
  Where where_;
  std::vector<Coefficient> coefficients_;
  PerSensor<std::vector<int>> at_;
};

}  // namespace mgtd::calib::effects::laws
