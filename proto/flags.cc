// SPDX-License-Identifier: Apache-2.0
#include "proto/flags.h"

namespace mgtd {

std::vector<std::string_view> names(Flags flags) {
  std::vector<std::string_view> out;
  for_each_name(flags, [&](std::string_view name) { out.push_back(name); });
  return out;
}

}  // namespace mgtd
