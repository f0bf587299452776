// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/live/live_finding.h"

#include <array>
#include <cstddef>

namespace mgtd::calib::criticism::live {

std::string_view to_string(LiveState state) {
  static constexpr std::array<std::string_view, 7> kNames{"none",        "learning",  "ok",    "suspect",
                                                          "near source", "exchanged", "turned"};
  return kNames.at(static_cast<std::size_t>(state));
}

}  // namespace mgtd::calib::criticism::live
