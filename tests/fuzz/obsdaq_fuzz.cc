// SPDX-License-Identifier: Apache-2.0
#include "drivers/obsdaq_driver.h"
#include "tests/fuzz/device_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  static_cast<void>(mgtd::drivers::obsdaq::parse_data_line({reinterpret_cast<const char*>(data), size}));
  mgtd::drivers::Settings text("sensor", 1);
  text.set("profile", std::string("mag-13-100"), 2);
  text.set("palmacq", (data[0] & 1) != 0, 3);
  mgtd::drivers::obsdaq::ObsdaqDriver driver(0, mgtd::drivers::obsdaq::read_obsdaq_settings(text));
  mgtd::testing::live_through(driver, data + 1, size - 1);
  return 0;
}
