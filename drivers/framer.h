// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "proto/health.h"

/// A framer cuts the bytes of a serial line into candidate frames; it may be fed in pieces of any size, with
/// the same result for any split.
///
/// Every byte is accounted for in the LinkHealth it is given, so that bytes_in = frames + rejected + resync +
/// pending holds after every call: the taker of a frame says what it was (FrameResult), the framer itself
/// rejects what is too long (Reject::length, then skips to the next ending as resync) or holds bytes that no
/// such line contains (Reject::framing), and tells the taker of both.
///
///   Ending::cr   frame ends at CR; an LF in front of a frame is skipped as part of it
///   Ending::lf   frame ends at LF; a CR before it is not part of the text
///   Ending::gcs  frame ends at an LF that no space precedes, so a reply of several lines is one frame;
///                a byte 0x80 or above at the start of a frame is a frame of its own (answer to 0x07)
///
/// Does not know what a frame means.
namespace mgtd::drivers {

enum class Ending { cr, lf, gcs };

/// What the taker makes of a frame.
struct FrameResult {
  enum class Kind { accepted, resync, rejected } kind{Kind::accepted};
  Reject why{Reject::framing};

  [[nodiscard]] static constexpr FrameResult accepted() { return {}; }
  /// Not an error: the rest of a stream that was cut off, or lines of no interest before the start.
  [[nodiscard]] static constexpr FrameResult resync() { return {Kind::resync, Reject::framing}; }
  [[nodiscard]] static constexpr FrameResult rejected(Reject why) { return {Kind::rejected, why}; }
};

struct Frame {
  std::string_view text;       ///< without its ending; valid during the call only
  std::size_t bytes_after{0};  ///< bytes of the same chunk behind it: it arrived that much before the last
  /// The framer itself rejects it; the taker is told so that it can count, its result is ignored.
  std::optional<Reject> damage{};
};

class Framer {
 public:
  using Taker = std::function<FrameResult(const Frame&)>;

  Framer(Ending ending, std::size_t max_bytes) : ending_(ending), max_bytes_(max_bytes) {}

  void feed(std::span<const std::byte> bytes, LinkHealth& health, const Taker& take);
  /// Gives up the unfinished frame (the port was closed): pending becomes resync.
  void drop(LinkHealth& health);

 private:
  [[nodiscard]] bool complete(char last) const;
  [[nodiscard]] std::string_view text() const;
  void overlong(std::size_t bytes_after, LinkHealth& health, const Taker& take);
  void finish(std::size_t bytes_after, LinkHealth& health, const Taker& take);

  Ending ending_;
  std::size_t max_bytes_;
  std::string pending_;
  bool skipping_{false};  ///< after an overlong frame, until its ending
};

}  // namespace mgtd::drivers
