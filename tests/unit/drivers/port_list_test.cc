// SPDX-License-Identifier: Apache-2.0
#include "drivers/port_list.h"

#include <gtest/gtest.h>

#include "tests/support/child_process.h"
#include "tests/support/pty.h"

namespace mgtd::drivers {
namespace {

PortInfo usb(std::string path, std::string serial, std::string by_path) {
  return {.path = std::move(path),
          .description = "converter",
          .usb_serial = std::move(serial),
          .usb_id = "0403:6001",
          .by_path = std::move(by_path)};
}

TEST(PortList, AConverterIsNamedByItsOwnSerialNumber) {
  const std::vector<PortInfo> all{usb("/dev/ttyUSB0", "A1", "/dev/serial/by-path/x"),
                                  usb("/dev/ttyUSB1", "A2", "/dev/serial/by-path/y")};
  EXPECT_EQ(lasting_name(all[0], all), "usb:A1");
  EXPECT_EQ(lasting_name(all[1], all), "usb:A2");
}

TEST(PortList, PortsThatShareASerialNumberAreNamedByTheirSocket) {
  const std::vector<PortInfo> all{usb("/dev/ttyUSB0", "A1", "/dev/serial/by-path/x-port0"),
                                  usb("/dev/ttyUSB1", "A1", "/dev/serial/by-path/x-port1")};
  EXPECT_EQ(lasting_name(all[0], all), "/dev/serial/by-path/x-port0");
  EXPECT_EQ(lasting_name(all[1], all), "/dev/serial/by-path/x-port1");
}

TEST(PortList, WithoutSerialNumberTheSocketElseThePath) {
  const std::vector<PortInfo> all{usb("/dev/ttyUSB0", "", "/dev/serial/by-path/x"),
                                  usb("/dev/ttyS0", "", "")};
  EXPECT_EQ(lasting_name(all[0], all), "/dev/serial/by-path/x");
  EXPECT_EQ(lasting_name(all[1], all), "/dev/ttyS0");
}

TEST(PortList, LinksAreFollowedAndUnknownPathsKept) {
  const mgtd::testing::TemporaryDirectory directory;
  const mgtd::testing::PtyMaster master(directory / "s1");
  EXPECT_EQ(port_path(directory / "s1"), master.terminal());
  EXPECT_EQ(port_path(directory / "absent"), directory / "absent") << "so that the message names it";
  EXPECT_FALSE(port_path("usb:NO-SUCH-SERIAL"));
}

}  // namespace
}  // namespace mgtd::drivers
