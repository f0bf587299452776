// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/checks/mirrored_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace mgtd::calib::fit::checks {

std::string mirrored_text(const std::vector<std::size_t>& sensors) {
  return fmt::format("sensor {} mirrored: left-handed axes, two leads are swapped or one is inverted",
                     sensors.size() == 1 ? fmt::format("{} is", sensors.front())
                                         : fmt::format("{} are", fmt::join(sensors, ", ")));
}

}  // namespace mgtd::calib::fit::checks
