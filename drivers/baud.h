// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>

#include "drivers/settings.h"

/// Every device on a serial line has the key `baud`: its speed in Bd, 300 to 4 000 000.
namespace mgtd::drivers {

/// `usual` when the key is absent or objected to.
[[nodiscard]] inline int read_baud(Settings& settings, int usual) {
  constexpr int kLeast = 300, kMost = 4'000'000;
  const auto baud = settings.integer("baud", usual);
  if (baud >= kLeast && baud <= kMost) return static_cast<int>(baud);
  settings.object("baud", fmt::format("must be a line speed like {}", usual));
  return usual;
}

}  // namespace mgtd::drivers
