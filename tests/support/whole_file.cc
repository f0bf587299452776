// SPDX-License-Identifier: Apache-2.0
#include "tests/support/whole_file.h"

#include <fstream>
#include <sstream>

namespace mgtd::testing {

std::string whole_file(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

}  // namespace mgtd::testing
