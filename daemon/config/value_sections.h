// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string_view>

#include "daemon/config/config.h"
#include "drivers/settings.h"

namespace mgtd::daemon::config {

/// A ValueSection is a section of the configuration that holds values and no device: `read` puts them into
/// the configuration and leaves what is wrong with them in the settings.
struct ValueSection {
  std::string_view name;
  void (*read)(drivers::Settings& settings, Config& config);
};

/// [rig], [site], [calibration], [run], [store], [stream], [control], [console] and [daemon].
[[nodiscard]] std::span<const ValueSection> value_sections();

/// Whether a rig may be so long.
[[nodiscard]] bool is_baseline(double baseline_m);

}  // namespace mgtd::daemon::config
