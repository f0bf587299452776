// SPDX-License-Identifier: Apache-2.0
#include "drivers/port_list.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

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

/// As the kernel shows a converter, a modem-like device and a port on the board.
class Sysfs {
 public:
  Sysfs() {
    device("usb1/1-1", "1-1:1.0/ttyUSB0", "A1", "ttyUSB0");
    device("usb1/1-2", "1-2:1.0", "M7 mark II", "ttyACM0");
    device("usb1/1-4", "1-4:1.1/ttyUSB4", "Q4", "ttyUSB4");
    device("usb1/1-4", "1-4:1.0/ttyUSB3", "Q4", "ttyUSB3");
    port("platform/serial8250", "ttyS0");
    std::filesystem::create_directories(root() + "/class/tty/console");
  }
  [[nodiscard]] std::string root() const { return scratch_ / "sys"; }
  void unplug(const std::string& tty) { std::filesystem::remove_all(root() + "/class/tty/" + tty); }

 private:
  void device(const std::string& at, const std::string& below, const std::string& serial,
              const std::string& tty) {
    port(at + "/" + below, tty);
    std::ofstream(root() + "/devices/" + at + "/idVendor") << "0403\n";
    std::ofstream(root() + "/devices/" + at + "/serial") << serial << "\n";
  }
  void port(const std::string& at, const std::string& tty) {
    std::filesystem::create_directories(root() + "/devices/" + at);
    std::filesystem::create_directories(root() + "/class/tty/" + tty);
    std::filesystem::create_symlink(root() + "/devices/" + at, root() + "/class/tty/" + tty + "/device");
  }
  mgtd::testing::TemporaryDirectory scratch_;
};

TEST(PortList, AConverterIsFoundByItsSerialNumberWithoutOpeningAnything) {
  Sysfs sysfs;
  EXPECT_EQ(port_of_usb_serial("A1", sysfs.root()), "/dev/ttyUSB0");
  EXPECT_EQ(port_of_usb_serial("M7 mark II", sysfs.root()), "/dev/ttyACM0");
  EXPECT_EQ(port_of_usb_serial("Q4", sysfs.root()), "/dev/ttyUSB3") << "the first of its ports";
  EXPECT_EQ(port_of_usb_serial("A", sysfs.root()), std::nullopt);
  EXPECT_EQ(port_of_usb_serial("", sysfs.root()), std::nullopt) << "a port without a number is nobody's";
  sysfs.unplug("ttyUSB0");
  EXPECT_EQ(port_of_usb_serial("A1", sysfs.root()), std::nullopt);
  EXPECT_EQ(port_of_usb_serial("A1", sysfs.root() + "/nowhere"), std::nullopt);
}

TEST(PortList, UdevRulesTellIdenticalConvertersApart) {
  std::vector<PortInfo> all{usb("/dev/ttyUSB0", "A1", "/dev/serial/by-path/pci-0-usb-0:1:1.0-port0"),
                            usb("/dev/ttyUSB1", "", "/dev/serial/by-path/pci-0-usb-0:2:1.0-port0"),
                            usb("/dev/ttyUSB2", "", "/dev/serial/by-path/pci-0-usb-0:3:1.0-port0"),
                            usb("/dev/ttyUSB3", "Q4", "/dev/serial/by-path/pci-0-usb-0:4:1.0-port0"),
                            usb("/dev/ttyUSB4", "Q4", "/dev/serial/by-path/pci-0-usb-0:4:1.1-port0"),
                            usb("/dev/ttyS0", "", "")};
  all[3].usb_interface = "00";
  all[4].usb_interface = "01";
  EXPECT_EQ(udev_rule(all[0], all, "s1"),
            R"(ENV{ID_SERIAL_SHORT}=="A1", SYMLINK+="mgt/s1", ENV{MGTD_PORT}="1")");
  EXPECT_EQ(udev_rule(all[1], all, "s2"),
            R"(ENV{ID_PATH}=="pci-0-usb-0:2:1.0", SYMLINK+="mgt/s2", ENV{MGTD_PORT}="1")");
  EXPECT_EQ(
      udev_rule(all[4], all, "s4"),
      R"(ENV{ID_SERIAL_SHORT}=="Q4", ENV{ID_USB_INTERFACE_NUM}=="01", SYMLINK+="mgt/s4", ENV{MGTD_PORT}="1")");
  EXPECT_EQ(udev_rule(all[5], all, "table"), "") << "only its number";
  std::set<std::string> rules;
  for (const PortInfo& port : all) rules.insert(udev_rule(port, all, "x"));
  EXPECT_EQ(rules.size(), all.size());
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
