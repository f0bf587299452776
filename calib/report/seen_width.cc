// SPDX-License-Identifier: Apache-2.0
#include "calib/report/seen_width.h"

#include <algorithm>

namespace mgtd::calib::report {

std::size_t seen_width(std::string_view text) {
  return static_cast<std::size_t>(std::count_if(
      text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) != 0x80U; }));
}

}  // namespace mgtd::calib::report
