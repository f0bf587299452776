// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/input_channel.h"
#include "proto/health.h"
#include "proto/reading.h"
#include "proto/time.h"

/// A Device is the driver of one instrument: bytes, time and requests come in; bytes to send and events come
/// out. It has no port, no clock and no thread: `port_link` carries the bytes, tests feed them by hand, and
/// both see the same behaviour.
namespace mgtd::drivers {

class Device {
 public:
  Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  virtual ~Device() = default;

  /// The port was opened (again). The device may be in any state, already streaming included: start over.
  virtual void on_open(Stamp now) = 0;
  /// Bytes as they came; a frame may be split anywhere. `arrival` is that of the last byte.
  virtual void on_bytes(std::span<const std::byte> bytes, Stamp arrival) = 0;
  /// Every 20-50 ms: all timeouts are comparisons with `now` in here.
  virtual void on_tick(Stamp now) = 0;
  /// The port is gone. Nothing may be sent until the next on_open.
  virtual void on_close(Stamp now) = 0;
  /// The program ends while the port is still open: the last bytes to send, if any (a table stops).
  virtual void on_shutdown(Stamp /*now*/) {}

  /// Line speed the device's settings ask for.
  [[nodiscard]] virtual int baud() const = 0;

  /// Bytes of its shortest line that carries a reading: what the line needs before a reading can arrive. 0
  /// where that does not matter.
  [[nodiscard]] virtual std::size_t line_bytes() const { return 0; }

  /// Its analogue inputs that are columns of the pose table.
  [[nodiscard]] virtual std::span<const InputChannel> inputs() const { return {}; }

  /// True when the device should be closed and opened again (it stopped answering).
  [[nodiscard]] virtual bool wants_reopen() const { return false; }

  [[nodiscard]] const LinkHealth& health() const { return health_; }
  [[nodiscard]] std::string take_output() { return std::exchange(output_, {}); }
  [[nodiscard]] std::vector<DeviceEvent> take_events() { return std::exchange(events_, {}); }

 protected:
  void send(std::string_view bytes) {
    output_ += bytes;
    health_.bytes_out += bytes.size();
  }
  void emit(DeviceEvent event) { events_.push_back(std::move(event)); }

  LinkHealth health_;

 private:
  std::string output_;
  std::vector<DeviceEvent> events_;
};

/// Travel of each table axis; an axis that does not exist has min = max = 0.
struct TableLimits {
  struct Range {
    double min_rad{0}, max_rad{0};
  };
  Range azimuth, pitch, roll;
};

/// A table of one to three axes. Requests are remembered until they are carried out; progress is read from
/// TableReading events. Every refusal of the hardware is a DeviceFault.
class Turntable : public Device {
 public:
  /// Reference move of every axis. Ends with TableReading.referenced.
  virtual void home() = 0;
  /// Refused with a DeviceFault when a target lies outside limits(); nothing is sent then.
  virtual void move_to(TableAngles target) = 0;
  /// At once, in any state; also sent by on_open so that a table left moving by a dead program stops.
  virtual void stop() = 0;
  void on_shutdown(Stamp /*now*/) override { stop(); }
  [[nodiscard]] virtual const TableLimits& limits() const = 0;
};

}  // namespace mgtd::drivers
