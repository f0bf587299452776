// SPDX-License-Identifier: Apache-2.0
#include "proto/flags.h"

#include <array>
#include <utility>

namespace mgtd {

std::vector<std::string_view> names(Flags flags) {
  static constexpr std::array<std::pair<Flag, std::string_view>, 6> kNames{{
      {Flag::saturated, "saturated"},
      {Flag::interpolated, "interpolated"},
      {Flag::calibrating, "calibrating"},
      {Flag::uncalibrated, "uncalibrated"},
      {Flag::suspect, "suspect"},
      {Flag::clock_unsettled, "clock_unsettled"},
  }};
  std::vector<std::string_view> out;
  for (const auto& [flag, name] : kNames) {
    if (flags.has(flag)) out.push_back(name);
  }
  return out;
}

}  // namespace mgtd
