// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

namespace mgtd {

/// A Check has a name, a measured value, a limit, and says what to do when it fails.
struct Check {
  std::string name;
  bool passed{false};
  std::string measured;
  std::string limit;
  std::string remedy;
};

}  // namespace mgtd
