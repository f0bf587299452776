// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdlib>

namespace mgtd::testing {

/// A property that every input must have. Ends the program where it does not: what a fuzzer counts as found.
inline void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace mgtd::testing
