// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>

#include "proto/error.h"

/// A SerialPort is a serial line that is open: 8N1, without flow control; a read waits for at least one byte,
/// and the descriptor is non-blocking and not inherited. Exclusive: TIOCEXCL (but on a pty), and flock
/// against root, whom TIOCEXCL does not stop.
///
/// Real ports are opened and set up by libserialport. It refuses ptys (they have no entry in /sys/class/tty),
/// so these are opened by plain termios. Names are those of port_list.h: a path, a link to one (as udev makes
/// them), or "usb:SERIAL".
///
/// Does not read, write or wait: lend `fd()` to whoever does, and take it back before the port is destroyed.
namespace mgtd::drivers {

struct PortHandle;

class SerialPort {
 public:
  enum class Way { automatic, libserialport };

  /// unreachable: there is no such port. io: it is there but refuses; an occupied port says so.
  [[nodiscard]] static Result<SerialPort> open(const std::string& path, int baud, Way way = Way::automatic);

  SerialPort(SerialPort&&) noexcept;
  SerialPort& operator=(SerialPort&&) noexcept;
  ~SerialPort();

  [[nodiscard]] int fd() const;
  /// What is in force against the 16 ms delivery delay of USB converters, in words for the operator.
  [[nodiscard]] const std::string& latency() const;

 private:
  explicit SerialPort(std::unique_ptr<PortHandle> handle);
  std::unique_ptr<PortHandle> handle_;
};

}  // namespace mgtd::drivers
