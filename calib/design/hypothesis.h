// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace mgtd::calib::design {

/// A Hypothesis is one of several descriptions of the same residual: effects of the library or formulas that
/// act together.
struct Hypothesis {
  std::string name{};                ///< for a person
  std::vector<std::string> specs{};  ///< as --with reads them
  std::optional<double> P{};         ///< its probability on the run, where somebody computed one
};

}  // namespace mgtd::calib::design
