// SPDX-License-Identifier: Apache-2.0
#include "drivers/dcon_driver.h"
#include "tests/fuzz/device_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view line(reinterpret_cast<const char*>(data), size);
  static_cast<void>(mgtd::drivers::dcon::parse_reply(line, "01", true));
  mgtd::drivers::dcon::DconSettings settings;
  settings.channels = {
      {.index = 0, .input = "0", .key = "inputs.0.name", .column = "motor_A", .unit = "A"},
      {.index = 1, .input = "1", .key = "inputs.1.name", .column = "s1_T_degC", .unit = "degC"}};
  mgtd::drivers::dcon::DconDriver driver(settings);
  mgtd::testing::live_through(driver, data, size);
  return 0;
}
