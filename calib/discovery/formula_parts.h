// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <string>
#include <vector>

#include "calib/discovery/grammar.h"

/// These functions give the pieces of formulas that several families of the grammar have in common, and the
/// grids of the numbers in them.
namespace mgtd::calib::discovery {

/// Names of the sensor's own reading: along the axis that reads, and along its three axes.
inline const std::array<std::string, 4> kReadings{"u", "ux", "uy", "uz"};
inline const std::array<std::string, 3> kAxes{"ux", "uy", "uz"};

[[nodiscard]] std::string over_field(const std::string& reading);  ///< "(u/50000)"

[[nodiscard]] std::string decay(double tau_s);  ///< "exp(-3600*t_h/600)"
[[nodiscard]] std::vector<double> decays_s();

/// A quantity behind a low-pass: "lag600_T_degC".
[[nodiscard]] std::string lag(double tau_s, const std::string& of);
[[nodiscard]] std::vector<double> lags_s();

/// Of the inner number of an oscillation, and of no other.
inline constexpr const char* kPeriodUnit = "h";
/// Sine and cosine of time; `times` stands before each: "", "(u/50000)*".
[[nodiscard]] Columns period(double hours, const std::string& times);
/// Twice the length of the run divided by 1, 2, 3 and so on, shortest first.
[[nodiscard]] std::vector<double> periods_h(const LawInputs& inputs);

/// `n` numbers from `first` to `last` in equal ratios.
[[nodiscard]] std::vector<double> ratios(double first, double last, int n);

}  // namespace mgtd::calib::discovery
