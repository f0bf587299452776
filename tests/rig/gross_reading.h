// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>

#include "tests/rig/effect.h"

namespace mgtd::rig {

enum class Gross {
  off,       ///< `nT` is added
  stuck,     ///< the mean of the pose before comes again, without any scatter
  saturated  ///< the rail that is nearer, without any scatter
};

/// A GrossReading says what went wrong with the readings of some poses of a table, on top of everything else.
/// For a rig on ports see Fault.
struct GrossReading {
  Gross kind{Gross::off};
  std::uint64_t pose{1}, poses{1};  ///< from this number on, so many
  Where where{};
  double nT{0};
};

}  // namespace mgtd::rig
