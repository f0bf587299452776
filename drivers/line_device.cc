// SPDX-License-Identifier: Apache-2.0
#include "drivers/line_device.h"

namespace mgtd::drivers {

Stamp LineDevice::line_stamp(Stamp chunk, std::size_t bytes_after) const {
  const Duration behind = from_seconds(static_cast<double>(bytes_after) * 10.0 / baud_);
  return {chunk.mono - behind, WallTime{chunk.wall.ns - behind.count()}};
}

void LineDevice::on_open(Stamp /*now*/) {
  ++health_.opens;
  framer_.drop(health_);
  set_state(LinkState::probing, "asking the device who it is");
}

void LineDevice::on_bytes(std::span<const std::byte> bytes, Stamp arrival) {
  framer_.feed(bytes, health_, [&](const Frame& frame) {
    const Stamp at = line_stamp(arrival, frame.bytes_after);
    const Verdict verdict = on_line(frame.text, at);
    if (verdict.kind == Verdict::Kind::accepted) health_.last_frame = at.mono;
    return verdict;
  });
}

void LineDevice::on_close(Stamp /*now*/) {
  ++health_.closes;
  framer_.drop(health_);
  set_state(LinkState::absent, "the port is closed");
}

}  // namespace mgtd::drivers
