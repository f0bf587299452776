// SPDX-License-Identifier: Apache-2.0
#include "drivers/serial_port.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <libserialport.h>
#include <linux/serial.h>
#include <sys/file.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <optional>
#include <utility>

#include "drivers/port_list.h"

namespace mgtd::drivers {

struct PortHandle {
  int fd{-1};
  sp_port* port{nullptr};  ///< set when libserialport opened the descriptor
  bool owned{true};        ///< false when the lock was refused: then another program's claim must stay
  std::string latency;

  PortHandle() = default;
  PortHandle(const PortHandle&) = delete;
  PortHandle& operator=(const PortHandle&) = delete;
  ~PortHandle() {
    if (fd >= 0 && owned) ::ioctl(fd, TIOCNXCL);
    if (port != nullptr) {
      if (fd >= 0) sp_close(port);
      sp_free_port(port);
    } else if (fd >= 0) {
      ::close(fd);
    }
  }
};

namespace {

Error os_error(const std::string& path, std::string_view doing, int number) {
  const std::string what = fmt::format("{}: {}: {}", path, doing, std::strerror(number));
  switch (number) {
    case EBUSY:
    case EWOULDBLOCK:
      return {ErrorCode::io, fmt::format("{}: the port is in use by another program", path),
              fmt::format("'fuser -v {}' names it; stop it, or configure another port", path)};
    case ENOENT:
    case ENXIO:
    case ENODEV:
      return {ErrorCode::unreachable, fmt::format("{}: there is no such port", path),
              "plug the device in, or correct 'port'; 'mgt ports' lists what is there"};
    case EACCES:
    case EPERM:
      return {ErrorCode::io, what, "add the daemon's user to the group that owns the port (dialout)"};
    default:
      return {ErrorCode::io, what, "unplug the converter and plug it in again"};
  }
}

speed_t speed_of(int baud) {
  constexpr std::array<std::pair<int, speed_t>, 16> kSpeeds{{{1200, B1200},
                                                             {2400, B2400},
                                                             {4800, B4800},
                                                             {9600, B9600},
                                                             {19200, B19200},
                                                             {38400, B38400},
                                                             {57600, B57600},
                                                             {115200, B115200},
                                                             {230400, B230400},
                                                             {460800, B460800},
                                                             {500000, B500000},
                                                             {576000, B576000},
                                                             {921600, B921600},
                                                             {1000000, B1000000},
                                                             {2000000, B2000000},
                                                             {4000000, B4000000}}};
  for (const auto& [rate, speed] : kSpeeds) {
    if (rate == baud) return speed;
  }
  return B0;
}

Result<void> open_pty(PortHandle& handle, const std::string& path, int baud) {
  const speed_t speed = speed_of(baud);
  if (speed == B0)
    return fail(ErrorCode::bad_input, fmt::format("{}: no such line speed: {} Bd", path, baud));
  handle.fd = ::open(path.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
  if (handle.fd < 0) return tl::unexpected(os_error(path, "opening", errno));
  termios line{};
  if (::tcgetattr(handle.fd, &line) != 0)
    return tl::unexpected(os_error(path, "reading the line settings", errno));
  ::cfmakeraw(&line);
  line.c_cflag |= static_cast<tcflag_t>(CS8 | CLOCAL | CREAD);
  ::cfsetspeed(&line, speed);
  if (::tcsetattr(handle.fd, TCSANOW, &line) != 0)
    return tl::unexpected(os_error(path, "setting the line", errno));
  return {};
}

Error port_error(const std::string& path, std::string_view doing, sp_return code) {
  if (code == SP_ERR_ARG) return os_error(path, doing, ENODEV);
  if (code == SP_ERR_SUPP)
    return {ErrorCode::bad_input, fmt::format("{}: {}: not supported by this port", path, doing),
            "choose another baud"};
  const int number = sp_last_error_code();
  return os_error(path, doing, number == 0 ? EIO : number);
}

Result<void> open_real(PortHandle& handle, const std::string& path, int baud) {
  sp_return code = sp_get_port_by_name(path.c_str(), &handle.port);
  if (code != SP_OK) return tl::unexpected(port_error(path, "finding the port", code));
  if (code = sp_open(handle.port, SP_MODE_READ_WRITE); code != SP_OK)
    return tl::unexpected(port_error(path, "opening", code));
  if (code = sp_get_port_handle(handle.port, &handle.fd); code != SP_OK)
    return tl::unexpected(port_error(path, "opening", code));
  if (code = sp_set_baudrate(handle.port, baud); code != SP_OK)
    return tl::unexpected(port_error(path, fmt::format("setting {} Bd", baud), code));
  if (sp_set_bits(handle.port, 8) != SP_OK || sp_set_parity(handle.port, SP_PARITY_NONE) != SP_OK ||
      sp_set_stopbits(handle.port, 1) != SP_OK ||
      sp_set_flowcontrol(handle.port, SP_FLOWCONTROL_NONE) != SP_OK)
    return tl::unexpected(port_error(path, "setting 8N1 without flow control", SP_ERR_FAIL));
  return {};
}

/// What neither way of opening does: a read waits for a byte, nobody else gets in, children do not inherit.
/// Not TIOCEXCL on a pty: it stays there when its owner is killed, as long as the other end is open, and then
/// nobody but root gets in again.
Result<void> claim(int fd, const std::string& path, bool pty) {
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0) return tl::unexpected(os_error(path, "locking", errno));
  if (!pty && ::ioctl(fd, TIOCEXCL) != 0) return tl::unexpected(os_error(path, "claiming", errno));
  termios line{};
  if (::tcgetattr(fd, &line) != 0) return tl::unexpected(os_error(path, "reading the line settings", errno));
  line.c_cc[VMIN] = 1;  // with 0, an idle read looks like a hang-up
  line.c_cc[VTIME] = 0;
  if (::tcsetattr(fd, TCSANOW, &line) != 0) return tl::unexpected(os_error(path, "setting the line", errno));
  const int flags = ::fcntl(fd, F_GETFD);
  if (flags < 0 || ::fcntl(fd, F_SETFD, flags | FD_CLOEXEC) != 0)
    return tl::unexpected(os_error(path, "setting close-on-exec", errno));
  ::tcflush(fd, TCIFLUSH);
  return {};
}

/// Asks the driver to deliver at once and says what is in force.
std::string lower_latency(int fd, const std::string& path) {
  serial_struct serial{};
  std::string report = "low latency not offered by the driver";
  if (::ioctl(fd, TIOCGSERIAL, &serial) == 0) {
    serial.flags |= static_cast<int>(ASYNC_LOW_LATENCY);
    report = ::ioctl(fd, TIOCSSERIAL, &serial) == 0
                 ? std::string("low latency set")
                 : fmt::format("low latency refused ({})", std::strerror(errno));
  }
  const std::string name = path.substr(path.find_last_of('/') + 1);
  std::ifstream timer(fmt::format("/sys/bus/usb-serial/devices/{}/latency_timer", name));
  if (int ms = 0; timer >> ms) report += fmt::format(", USB latency timer {} ms", ms);
  return report;
}

}  // namespace

Result<SerialPort> SerialPort::open(const std::string& path, int baud, Way way) {
  const std::optional<std::string> found = port_path(path);
  if (!found)
    return fail(ErrorCode::unreachable,
                fmt::format("{}: no USB converter with this serial number is plugged in", path),
                "plug it in, or correct 'port'; 'mgt ports' lists what is there");
  const std::string& real = *found;
  auto handle = std::make_unique<PortHandle>();
  const bool pty = way == Way::automatic && real.starts_with("/dev/pts/");
  if (auto opened = pty ? open_pty(*handle, real, baud) : open_real(*handle, real, baud); !opened)
    return tl::unexpected(std::move(opened.error()));
  if (auto claimed = claim(handle->fd, path, pty); !claimed) {
    handle->owned = false;
    return tl::unexpected(std::move(claimed.error()));
  }
  handle->latency = lower_latency(handle->fd, real);
  return SerialPort(std::move(handle));
}

SerialPort::SerialPort(std::unique_ptr<PortHandle> handle) : handle_(std::move(handle)) {}
SerialPort::SerialPort(SerialPort&&) noexcept = default;
SerialPort& SerialPort::operator=(SerialPort&&) noexcept = default;
SerialPort::~SerialPort() = default;

int SerialPort::fd() const { return handle_->fd; }
const std::string& SerialPort::latency() const { return handle_->latency; }

}  // namespace mgtd::drivers
