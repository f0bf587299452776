// SPDX-License-Identifier: Apache-2.0
#include "drivers/framer.h"

#include <algorithm>
#include <utility>

namespace mgtd::drivers {
namespace {

bool printable(char c, Ending ending) {
  const auto code = static_cast<unsigned char>(c);
  return (code >= 0x20 && code < 0x7F) || c == '\t' || (ending == Ending::gcs && c == '\n');
}

bool is_status_byte(char c) { return static_cast<unsigned char>(c) >= 0x80; }

}  // namespace

bool Framer::complete(char last) const {
  if (ending_ == Ending::cr) return last == '\r';
  if (ending_ == Ending::lf) return last == '\n';
  if (pending_.size() == 1 && is_status_byte(last)) return true;
  return last == '\n' && (pending_.size() < 2 || pending_[pending_.size() - 2] != ' ');
}

std::string_view Framer::text() const {
  std::string_view text = pending_;
  if (ending_ == Ending::gcs && text.size() == 1 && is_status_byte(text.front())) return text;
  text.remove_suffix(1);
  if (ending_ == Ending::cr) text.remove_prefix(std::min(text.find_first_not_of('\n'), text.size()));
  if (ending_ != Ending::cr && text.ends_with('\r')) text.remove_suffix(1);
  return text;
}

void Framer::finish(std::size_t bytes_after, LinkHealth& health, const Taker& take) {
  const std::size_t size = pending_.size();
  if (std::exchange(skipping_, false)) {
    health.bytes_resync += size;
    pending_.clear();
    return;
  }
  const std::string_view line = text();
  const bool status = line.size() == 1 && is_status_byte(line.front()) && ending_ == Ending::gcs;
  const bool clean =
      status || std::all_of(line.begin(), line.end(), [&](char c) { return printable(c, ending_); });
  FrameResult result = take({line, bytes_after, clean ? std::nullopt : std::optional(Reject::framing)});
  if (!clean) result = FrameResult::rejected(Reject::framing);
  switch (result.kind) {
    case FrameResult::Kind::accepted:
      health.bytes_in_frames += size;
      ++health.frames;
      break;
    case FrameResult::Kind::resync:
      health.bytes_resync += size;
      break;
    case FrameResult::Kind::rejected:
      health.reject(result.why, size);
      break;
  }
  pending_.clear();
}

void Framer::overlong(std::size_t bytes_after, LinkHealth& health, const Taker& take) {
  if (skipping_) {
    health.bytes_resync += pending_.size();
  } else {
    static_cast<void>(take({pending_, bytes_after, Reject::length}));
    health.reject(Reject::length, pending_.size());
    skipping_ = true;
  }
  pending_.clear();
}

void Framer::feed(std::span<const std::byte> bytes, LinkHealth& health, const Taker& take) {
  health.bytes_in += bytes.size();
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    const char c = static_cast<char>(bytes[i]);
    pending_ += c;
    if (complete(c)) {
      finish(bytes.size() - 1 - i, health, take);
    } else if (pending_.size() >= max_bytes_) {
      overlong(bytes.size() - 1 - i, health, take);
    }
  }
  health.bytes_pending = pending_.size();
}

void Framer::drop(LinkHealth& health) {
  health.bytes_resync += pending_.size();
  health.bytes_pending = 0;
  pending_.clear();
  skipping_ = false;
}

}  // namespace mgtd::drivers
