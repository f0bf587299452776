// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/deed.h"

namespace mgtd::rig {

std::optional<Deed> deed_of(const std::string& text) {
  // The poses are measured about the peak, where a dwell sees little of the change.
  if (text.find("a heat pulse: warm the heads by 5 degC") != std::string::npos)
    return Deed{"warm 5 300", 210};
  if (text.find("the field a fifth weaker (coil)") != std::string::npos) return Deed{"coil 0.8"};
  return std::nullopt;
}

}  // namespace mgtd::rig
