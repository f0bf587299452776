// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

namespace mgtd::rig {

/// A Deed says what a hand does to the surroundings of a rig (BenchRig::surroundings), and how long it then
/// waits for the effect, on the rig's clock.
struct Deed {
  std::vector<std::string> lines;
  double wait_s{0};
};
/// The deed that a run asks for in these words; empty: not on this rig.
[[nodiscard]] std::optional<Deed> deed_of(const std::string& text);

}  // namespace mgtd::rig
