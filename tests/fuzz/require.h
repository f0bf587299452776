// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdlib>

namespace mgtd::testing {

/// Every input must have the property that is required; where one does not, the program ends, which a fuzzer
/// counts as a find.
inline void require(bool condition) {
  if (!condition) std::abort();
}

}  // namespace mgtd::testing
