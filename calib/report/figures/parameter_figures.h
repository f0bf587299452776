// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/report/figures/figure.h"

/// These figures show how parameters move from calibration to calibration, and what effects in the model cost
/// and bring.
namespace mgtd::calib::report::figures {

/// A year of a rig: for each sensor, the shift of each parameter from one calibration to the next, in
/// standard errors of the difference.
struct HistoryPoint {
  std::string when{};                         ///< "2026-05-11"
  double day{0};                              ///< of any origin
  std::vector<std::vector<double>> shifts{};  ///< by sensor, by parameter; against the one before
};
struct HistoryValues {
  std::vector<std::string> sensors{}, parameters{};
  std::vector<HistoryPoint> points{};  ///< in order of time
};
[[nodiscard]] Figure history_figure(const HistoryValues& values);

/// Price: standard error of each parameter with the effects in the model over that without them.
struct PriceValues {
  std::vector<std::string> sensors{}, parameters{};
  std::vector<std::vector<double>> sd_ratio{};                 ///< by sensor, by parameter
  double tensor_before_nT_per_m{0}, tensor_after_nT_per_m{0};  ///< standard error of the worst component
};
[[nodiscard]] Figure price_figure(const PriceValues& values);

/// Impact: what a model without the effect does to the tensor, of the component that moves most.
struct ImpactValues {
  struct Row {
    std::string effect{}, component{};
    double shift_nT_per_m{0};
  };
  std::vector<Row> rows{};
  double known_nT_per_m{0};  ///< standard error of the worst component by the calibration
};
[[nodiscard]] Figure impact_figure(const ImpactValues& values);

}  // namespace mgtd::calib::report::figures
