// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "drivers/deadline.h"
#include "drivers/device.h"
#include "drivers/framer.h"

/// A LineBased device speaks in lines. The base holds what such devices share: framing, the count of bytes,
/// the time of a line, its state, and the request for a fresh port when nothing at all has come for a while.
///
/// A line that shares a chunk with later bytes arrived at least (bytes behind it) * 10 bit / baud before the
/// chunk's last byte; its stamp is moved back by that, which tightens the upper bound the stamp is.
namespace mgtd::drivers {

struct LineTraits {
  Ending ending{Ending::cr};
  std::size_t longest_line{128};
  int baud{9600};
  double reopen_after_s{10};  ///< without a single byte
};

template <class Base>
class LineBased : public Base {
 public:
  void on_open(Stamp now) override {
    ++this->health_.opens;
    framer_.drop(this->health_);
    wants_reopen_ = false;
    dead_.set(now.mono, traits_.reopen_after_s);
    set_state(LinkState::probing, "asking the device who it is");
  }
  void on_bytes(std::span<const std::byte> bytes, Stamp arrival) final {
    dead_.set(arrival.mono, traits_.reopen_after_s);
    framer_.feed(bytes, this->health_, [&](const Frame& frame) {
      const Duration behind = from_seconds(static_cast<double>(frame.bytes_after) * 10.0 / traits_.baud);
      const Stamp at{arrival.mono - behind, WallTime{arrival.wall.ns - behind.count()}};
      if (frame.damage) {
        on_damaged_line(frame.text);
        return FrameResult::rejected(*frame.damage);
      }
      const FrameResult result = on_line(frame.text, at);
      if (result.kind == FrameResult::Kind::accepted) this->health_.last_frame = at.mono;
      return result;
    });
  }
  void on_tick(Stamp now) override {
    if (dead_.passed(now.mono)) wants_reopen_ = true;
  }
  void on_close(Stamp /*now*/) override {
    ++this->health_.closes;
    framer_.drop(this->health_);
    wants_reopen_ = false;
    dead_.clear();
    set_state(LinkState::absent, "the port is closed");
  }
  [[nodiscard]] bool wants_reopen() const final { return wants_reopen_; }
  [[nodiscard]] int baud() const final { return traits_.baud; }

 protected:
  explicit LineBased(LineTraits traits) : traits_(traits), framer_(traits.ending, traits.longest_line) {}

  /// One line without its ending. What it returns goes to the books.
  virtual FrameResult on_line(std::string_view line, Stamp arrival) = 0;

  /// A line that holds what no line may; already rejected. `text` may contain any byte.
  virtual void on_damaged_line(std::string_view /*text*/) {}

  void set_state(LinkState state, std::string_view detail) {
    this->health_.state = state;
    this->health_.detail = detail;
  }

 private:
  LineTraits traits_;
  Framer framer_;
  Deadline dead_;
  bool wants_reopen_{false};
};

using LineDevice = LineBased<Device>;

}  // namespace mgtd::drivers
