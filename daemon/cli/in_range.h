// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <CLI/CLI.hpp>
#include <string>

/// These validators check numbers of the command line that have a physical range. The error names the number
/// that was given, the range and its unit; nan and inf are outside of every range.
namespace mgtd::daemon::cli {

/// From `low` to `high`, both included.
[[nodiscard]] CLI::Validator in_range(double low, double high, const std::string& unit);

/// A whole number of 64 bits, from 0.
[[nodiscard]] CLI::Validator seed_number();

/// Above zero, up to `high`.
[[nodiscard]] CLI::Validator above_zero(double high, const std::string& unit);

}  // namespace mgtd::daemon::cli
