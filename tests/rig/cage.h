// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

namespace mgtd::rig {

/// A Cage of coils makes one field after the other while the array stands still in it, its platform frame
/// that of the coils. The field of the site itself is compensated; effects of the site remain.
struct Cage {
  /// Directions spread evenly over the sphere, sizes of 1/4, 2/4, 3/4 and 4/4 of the largest in turn; else
  /// directions at random and sizes uniform up to it. The first field is zero.
  bool sphere{true};
  double max_nT{60'000};
  std::uint64_t poses{60};
};

}  // namespace mgtd::rig
