// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/in_range.h"

#include <fmt/format.h>

#include "proto/number.h"

namespace mgtd::daemon::cli {
namespace {

template <typename Allowed>
CLI::Validator range(std::string words, Allowed allowed) {
  return {[words, allowed](std::string& given) -> std::string {
            const auto value = parse_number(given);
            if (!value) return fmt::format("'{}' is not a number", given);
            return allowed(*value) ? "" : fmt::format("{} is not possible: it must be {}", given, words);
          },
          words, "range"};
}

}  // namespace

CLI::Validator in_range(double low, double high, const std::string& unit) {
  return range(fmt::format("{} to {} {}", low, high, unit),
               [low, high](double x) { return x >= low && x <= high; });
}

CLI::Validator seed_number() {
  return {[](std::string& given) -> std::string {
            const bool digits = !given.empty() && given.find_first_not_of("0123456789") == std::string::npos;
            return digits ? ""
                          : fmt::format("{} is not possible: it must be a whole number from 0 on", given);
          },
          "a whole number from 0 on", "seed"};
}

CLI::Validator above_zero(double high, const std::string& unit) {
  return range(fmt::format("above 0 and up to {} {}", high, unit),
               [high](double x) { return x > 0 && x <= high; });
}

}  // namespace mgtd::daemon::cli
