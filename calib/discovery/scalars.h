// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "calib/discovery/law_inputs.h"

/// Scalars lists the quantities beside the readings that a law may be a function of: time, temperatures,
/// recorded columns, angles of the table, sense of rotation. Only those that vary in the run are in it.
namespace mgtd::calib::discovery {

struct Scalar {
  std::string text;       ///< its expression
  std::string covariate;  ///< its name
  int symbols{1};
  int foreign_sensor{-1};   ///< 0-based, where it is of one sensor and may act on the others
  bool common{true};        ///< the same for every channel
  double mean{0}, zero{0};  ///< zero: of its scale, 20 for a temperature
  std::vector<double> deciles{};
  bool curve{true};  ///< takes more than two values
  /// "(T_degC-21.3)"
  [[nodiscard]] std::string about(double centre) const;
};

struct Scalars {
  std::vector<Scalar> all;
  std::vector<std::string> angles;  ///< those of the table that vary

  /// The first of a name; nullptr where it does not vary.
  [[nodiscard]] const Scalar* find(std::string_view covariate) const;
};

[[nodiscard]] Scalars scalars_of(const LawInputs& inputs);

/// As formulas write numbers: six digits.
[[nodiscard]] std::string number_text(double x);
/// "T_degC-21.3", "T_degC+3.1"
[[nodiscard]] std::string less_text(const std::string& of, double c);

}  // namespace mgtd::calib::discovery
