// SPDX-License-Identifier: Apache-2.0
#include "drivers/gsm_driver.h"
#include "tests/fuzz/device_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static_cast<void>(mgtd::drivers::gsm::parse_line({reinterpret_cast<const char*>(data), size}));
  mgtd::drivers::gsm::GsmSettings settings;
  settings.init = {"S", "{utc}"};
  mgtd::drivers::gsm::GsmDriver driver(settings);
  mgtd::testing::live_through(driver, data, size);
  return 0;
}
