// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/deed.h"

namespace mgtd::rig {

std::optional<Deed> deed_of(const std::string& text) {
  // The poses are measured about the peak, where a dwell sees little of the change.
  const auto asks_for = [&](const char* what) { return text.find(what) != std::string::npos; };
  if (asks_for("a heat pulse: warm the heads by 5 degC")) return Deed{{"warm 5 300"}, 210};
  // Twelve minutes are 24 poses: a quarter for each head, and a step from the fifth of them on.
  if (asks_for("one head after another is warmed by 5 degC"))
    return Deed{{"warm 5 90 1 0", "warm 5 90 2 180", "warm 5 90 3 360", "warm 5 90 4 540"}};
  if (asks_for("a heat step: all heads 6 degC warmer")) return Deed{{"heat 6 180 0 150"}};
  if (asks_for("the field a fifth weaker (coil)")) return Deed{{"coil 0.8"}};
  return std::nullopt;
}

}  // namespace mgtd::rig
