// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "calib/report/figures/figure.h"

/// These figures are equal-area maps of directions (sky.h).
namespace mgtd::calib::report::figures {

/// What is left, over the direction of the field in one sensor.
struct Sky {
  std::string sensor{};
  std::vector<Eigen::Vector3d> directions{};
  std::vector<double> residual_nT{}, after_nT{};  ///< after: empty where nothing was added
  std::vector<int> poses{};
  std::string p_text{};
};
struct SkiesValues {
  std::vector<Sky> skies{};
  std::string what{};  ///< a sentence: which residual it is
  bool stands_out{false};
};
/// Above 600 directions a sensor: means over cells of equal area in place of marks.
[[nodiscard]] Figure skies_figure(const SkiesValues& values);

/// Directions of the field in the platform: where the sensors were looked at from, and where not.
inline constexpr double kGoodHole_deg = 45;  ///< no direction should be farther from a pose than this
struct CoverageValues {
  std::vector<Eigen::Vector3d> measured{}, planned{};  ///< planned: those still open
  double good_deg{kGoodHole_deg};
  bool ahead{false};  ///< nothing is measured yet: `measured` is what the poses will reach
};
[[nodiscard]] Figure coverage_figure(const CoverageValues& values);
/// What a good one looks like, and what this one is: radius of the largest hole, and so many directions.
[[nodiscard]] std::string good_coverage(double hole_deg, std::size_t measured,
                                        double good_deg = kGoodHole_deg);

}  // namespace mgtd::calib::report::figures
