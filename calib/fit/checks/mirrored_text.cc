// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/checks/mirrored_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace mgtd::calib::fit::checks {

bool handedness_is_open(std::size_t mirrored, std::size_t sensors) { return 2 * mirrored == sensors; }

std::string mirrored_text(const std::vector<std::size_t>& mirrored, std::size_t sensors) {
  const std::string which = mirrored.size() == 1 ? fmt::format("sensor {} is", mirrored.front())
                                                 : fmt::format("sensors {} are", fmt::join(mirrored, ", "));
  if (handedness_is_open(mirrored.size(), sensors))
    return which +
           " mirrored against the other half of the array: which of the two has left-handed axes, two leads "
           "swapped or one inverted, cannot be told from the field";
  return which + " mirrored: left-handed axes, two leads are swapped or one is inverted";
}

}  // namespace mgtd::calib::fit::checks
