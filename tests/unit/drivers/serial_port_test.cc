// SPDX-License-Identifier: Apache-2.0
#include "drivers/serial_port.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <utility>

#include "tests/support/checkout.h"
#include "tests/support/child_process.h"
#include "tests/support/pty.h"

namespace mgtd::drivers {
namespace {

using ::testing::HasSubstr;

class SerialPortTest : public ::testing::Test {
 protected:
  mgtd::testing::TemporaryDirectory directory_;
  std::string path_{directory_ / "port"};

  /// What a port must be, whichever way it was opened.
  void expect_set_up(SerialPort::Way way) {
    mgtd::testing::PtyMaster master(path_);
    auto port = SerialPort::open(path_, 57600, way);
    ASSERT_TRUE(port) << port.error().text();
    termios line{};
    ASSERT_EQ(::tcgetattr(port->fd(), &line), 0);
    EXPECT_EQ(line.c_cc[VMIN], 1) << "an idle read must wait, not look like a hang-up";
    EXPECT_EQ(line.c_cc[VTIME], 0);
    EXPECT_EQ(line.c_cflag & CSIZE, static_cast<tcflag_t>(CS8));
    EXPECT_EQ(line.c_cflag & (PARENB | CSTOPB | CRTSCTS), 0U);
    EXPECT_EQ(line.c_iflag & (IXON | IXOFF | ICRNL | INLCR | ISTRIP), 0U);
    EXPECT_EQ(line.c_oflag & OPOST, 0U);
    EXPECT_EQ(line.c_lflag & (ICANON | ECHO | ISIG), 0U);
    EXPECT_EQ(::cfgetospeed(&line), static_cast<speed_t>(B57600));
    EXPECT_NE(::fcntl(port->fd(), F_GETFD) & FD_CLOEXEC, 0);
    EXPECT_NE(::fcntl(port->fd(), F_GETFL) & O_NONBLOCK, 0);
    EXPECT_FALSE(port->latency().empty());

    std::array<char, 8> bytes{};
    EXPECT_EQ(::read(port->fd(), bytes.data(), bytes.size()), -1);
    EXPECT_EQ(errno, EAGAIN);
    master.write("\r\n\x11\x13");
    pollfd ready{port->fd(), POLLIN, 0};
    ASSERT_EQ(::poll(&ready, 1, 10'000), 1);
    EXPECT_EQ(::read(port->fd(), bytes.data(), bytes.size()), 4);
    EXPECT_EQ(std::string_view(bytes.data(), 4), "\r\n\x11\x13") << "no byte is special";

    auto second = SerialPort::open(path_, 57600, way);
    ASSERT_FALSE(second);
    EXPECT_THAT(second.error().message, HasSubstr("in use by another program"));
    EXPECT_THAT(second.error().remedy, HasSubstr("fuser -v"));
    const SerialPort moved = std::move(*port);
    EXPECT_GE(moved.fd(), 0);
  }
};

TEST_F(SerialPortTest, APtyIsSetUp) {
  expect_set_up(SerialPort::Way::automatic);
  expect_set_up(SerialPort::Way::automatic);  // and was given back
}

/// Runs itself again in a process where libserialport accepts a pty.
TEST_F(SerialPortTest, ThePathOfARealPortIsSetUpToo) {
  if (std::getenv("MGTD_UNDER_SHIM") != nullptr) {
    expect_set_up(SerialPort::Way::libserialport);
    expect_set_up(SerialPort::Way::libserialport);
    return;
  }
  const auto result = mgtd::testing::run_program(
      {"env", "MGTD_UNDER_SHIM=1", "LD_PRELOAD=" + mgtd::testing::pty_shim(),
       "ASAN_OPTIONS=verify_asan_link_order=0", mgtd::testing::program("drivers_test"),
       "--gtest_filter=SerialPortTest.ThePathOfARealPortIsSetUpToo"},
      directory_.path());
  EXPECT_EQ(result.exit_code, 0) << result.out << result.err;
  EXPECT_THAT(result.out, HasSubstr("[  PASSED  ] 1 test"));
}

TEST_F(SerialPortTest, WithoutTheShimLibserialportRefusesAPty) {
  mgtd::testing::PtyMaster master(path_);
  EXPECT_FALSE(SerialPort::open(path_, 57600, SerialPort::Way::libserialport));
}

TEST_F(SerialPortTest, EveryRefusalSaysWhatToDo) {
  const auto absent = SerialPort::open(path_, 57600);
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, ErrorCode::unreachable);
  EXPECT_THAT(absent.error().message, HasSubstr(path_));
  EXPECT_THAT(absent.error().remedy, HasSubstr("mgt ports"));
  const auto unplugged = SerialPort::open("usb:NO-SUCH-SERIAL", 57600);
  ASSERT_FALSE(unplugged);
  EXPECT_THAT(unplugged.error().message, HasSubstr("NO-SUCH-SERIAL"));
  mgtd::testing::PtyMaster master(path_);
  const auto speed = SerialPort::open(path_, 12345);
  ASSERT_FALSE(speed);
  EXPECT_THAT(speed.error().message, HasSubstr("12345"));
  EXPECT_FALSE(SerialPort::open("/dev/null", 9600));
}

}  // namespace
}  // namespace mgtd::drivers
