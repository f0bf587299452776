// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace mgtd {

/// A named check with its measured value, its limit and what to do when it fails.
struct Check {
  std::string name;
  bool passed{false};
  std::string measured;
  std::string limit;
  std::string remedy;
};

}  // namespace mgtd
