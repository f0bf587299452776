// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "calib/report/figures/figure.h"

/// accuracy_figure() shows how the tensor became known during a run: the standard error of its worst
/// component by the calibration alone, against the time or the poses measured, on log axes, with the error
/// that was wanted and the guide 1/sqrt(n) through the last point.
namespace mgtd::calib::report::figures {

struct AccuracyValues {
  std::vector<double> x{};  ///< minutes, or poses
  std::string x_label{"poses"};
  std::vector<int> poses{};  ///< as many
  std::vector<double> worst_nT_per_m{};
  std::optional<double> wanted_nT_per_m{};
};
[[nodiscard]] Figure accuracy_figure(const AccuracyValues& values);
/// What a good one looks like, and what this one is: the last value, and from so many poses.
[[nodiscard]] std::string good_accuracy(double last_nT_per_m, int poses,
                                        const std::optional<double>& wanted_nT_per_m);

}  // namespace mgtd::calib::report::figures
