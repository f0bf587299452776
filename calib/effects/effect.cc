// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/effect.h"

namespace mgtd::calib {

std::string_view to_string(Level level) {
  switch (level) {
    case Level::site:
      return "site";
    case Level::table:
      return "table";
    case Level::platform:
      return "platform";
    case Level::axis:
      return "axis";
  }
  return "";
}

}  // namespace mgtd::calib
