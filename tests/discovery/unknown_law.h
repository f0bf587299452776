// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "tests/blind/hidden_run.h"

/// Laws that stand in no library, written without the code that looks for them.
namespace mgtd::calib::testing {

/// nT on one axis of one sensor, for a size of one.
using AxisLaw = std::function<double(const Pose& pose, const Eigen::Vector3d& v_nT)>;

struct UnknownLaw {
  std::string name;
  std::string truth;      ///< regular expression that the right formula matches, on s3.z
  std::string covariate;  ///< "s3_T_degC", ...
  /// A law with numbers drawn anew; of the axis z of sensor s3.
  std::function<AxisLaw(std::mt19937_64& rng)> draw;
};

/// Those that a grammar may hold.
[[nodiscard]] const std::vector<UnknownLaw>& unknown_laws();
/// Those that nothing recorded goes with, or that are more than a formula: no law may be named.
[[nodiscard]] const std::vector<UnknownLaw>& lawless();

/// Run of hidden_run.h with motor current and battery beside it, and a law on s3.z of a length of `d`
/// standard deviations (before the calibration takes its part of it); the law may be null.
struct LawRun {
  HiddenRun noise{};
  AxisLaw law{};
  double d{0};
};
[[nodiscard]] PoseTable law_run(const LawRun& run, std::uint64_t seed);

}  // namespace mgtd::calib::testing
