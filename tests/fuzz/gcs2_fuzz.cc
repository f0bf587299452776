// SPDX-License-Identifier: Apache-2.0
#include "drivers/gcs2_driver.h"
#include "tests/fuzz/device_fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mgtd::drivers::Settings text("table", 1);
  mgtd::drivers::gcs2::Gcs2Driver driver(mgtd::drivers::gcs2::read_gcs2_settings(text));
  mgtd::testing::live_through(driver, data, size, [&](std::uint8_t what) {
    if (what % 3 == 0) driver.home();
    if (what % 3 == 1) driver.move_to({0.1 * what, 0, 0});
    if (what % 3 == 2) driver.stop();
  });
  return 0;
}
