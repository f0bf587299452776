// SPDX-License-Identifier: Apache-2.0
// Whatever stands in mgtd.toml: accepted, or refused with every mistake on a line of its own that names file
// and line.
#include <cstdint>
#include <string>

#include "daemon/config/config.h"
#include "tests/fuzz/require.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using mgtd::testing::require;
  const auto config =
      mgtd::daemon::config::parse_config(std::string(reinterpret_cast<const char*>(data), size), "mgtd.toml");
  if (config) {
    for (const auto& sensor : config->sensors) require(sensor.device != nullptr);
    require(config->rate_hz > 0 && config->baseline_m > 0);
    return 0;
  }
  require(!config.error().lines.empty());
  for (const std::string& line : config.error().lines) require(line.rfind("mgtd.toml", 0) == 0);
  return 0;
}
