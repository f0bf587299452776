// SPDX-License-Identifier: Apache-2.0
#include "calib/sensor/channels.h"

#include <fmt/format.h>

namespace mgtd::calib::sensor {

std::string channel_name(int channel) { return fmt::format("s{}.{}", channel / 3 + 1, "xyz"[channel % 3]); }

}  // namespace mgtd::calib::sensor
