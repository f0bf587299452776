// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <stop_token>
#include <string_view>
#include <vector>

#include "calib/effects/effect.h"
#include "calib/fit/fit_round.h"
#include "calib/sensor/geometry.h"
#include "proto/units.h"

/// FitOptions tells a fit its method, what the operator knows beside the poses, and the effects of the model.
namespace mgtd::calib::fit {

enum class Method { simplified, two_step, joint };
[[nodiscard]] std::string_view name(Method method);
[[nodiscard]] std::optional<Method> method_from(std::string_view name);

inline constexpr int kFolds = 10;  ///< contiguous in time, of every cross-validation

struct FitOptions {
  Method method{Method::joint};
  std::optional<double> field_nT;  ///< total field of every pose that has no f_nT
  double field_sd_nT{0};           ///< its standard uncertainty, common to those poses
  /// Direction of the field in the platform frame when all table angles are zero: inclination positive
  /// towards +Z, declination from X towards Y. Not given: both are estimated (gauge: see Calibration::gauge).
  std::optional<double> inclination_rad, declination_rad;
  sensor::Geometry geometry{};
  double table_sd_rad{to_rad(0.1)};         ///< of each table angle of each pose
  std::uint64_t seed{1};                    ///< of the draws that judge a fit (criticism); no method draws
  std::vector<effects::EffectPtr> effects;  ///< beside the twelve parameters a sensor; joint only
  /// Share of the poses that the joint fit may leave out for contradicting the others. Zero, with every
  /// method: each reading counts, whatever it is.
  double most_left_out{1.0 / 3};
  /// Asked before every step of a solver: a fit that is stopped is refused within that time.
  std::stop_token stop{};
  RoundListener on_round{};  ///< joint only; may be empty
};

}  // namespace mgtd::calib::fit
