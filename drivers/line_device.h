// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>

#include "drivers/device.h"
#include "drivers/framer.h"

/// What every device that speaks in lines shares: framing, the books, the time of a line and its state.
///
/// A line that shares a chunk with later bytes arrived at least (bytes behind it) * 10 bit / baud before the
/// chunk's last byte; its stamp is moved back by that, which tightens the upper bound the stamp is.
namespace mgtd::drivers {

class LineDevice : public Device {
 public:
  void on_open(Stamp now) override;
  void on_bytes(std::span<const std::byte> bytes, Stamp arrival) final;
  void on_close(Stamp now) override;
  [[nodiscard]] int baud() const final { return baud_; }

 protected:
  LineDevice(Ending ending, std::size_t max_line_bytes, int baud)
      : framer_(ending, max_line_bytes), baud_(baud) {}

  /// One line without its ending. What it returns goes to the books.
  virtual Verdict on_line(std::string_view line, Stamp arrival) = 0;

  void set_state(LinkState state, std::string detail) {
    health_.state = state;
    health_.detail = std::move(detail);
  }

 private:
  [[nodiscard]] Stamp line_stamp(Stamp chunk, std::size_t bytes_after) const;

  Framer framer_;
  int baud_;
};

}  // namespace mgtd::drivers
