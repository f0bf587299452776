// SPDX-License-Identifier: Apache-2.0
// Any bytes, cut anywhere: the same frames, the books in balance.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <vector>

#include "drivers/framer.h"

namespace {

using namespace mgtd;
using namespace mgtd::drivers;

std::vector<std::string> run(Ending ending, std::span<const std::byte> bytes, std::size_t piece) {
  Framer framer(ending, 48);
  LinkHealth health;
  std::vector<std::string> frames;
  while (!bytes.empty()) {
    const std::size_t size = std::min(piece, bytes.size());
    framer.feed(bytes.first(size), health, [&](const Frame& frame) {
      frames.emplace_back(frame.damage ? "damaged" : frame.text);
      return frame.text.size() % 3 == 0 ? FrameResult::rejected(Reject::number) : FrameResult::accepted();
    });
    if (!health.balanced()) std::abort();
    bytes = bytes.subspan(size);
  }
  framer.drop(health);
  if (!health.balanced() || health.bytes_pending != 0) std::abort();
  return frames;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 2) return 0;
  const auto ending = static_cast<Ending>(data[0] % 3);
  const std::size_t piece = data[1] % 16 + 1U;
  const std::span<const std::byte> bytes = std::as_bytes(std::span(data + 2, size - 2));
  if (run(ending, bytes, piece) != run(ending, bytes, bytes.size() + 1)) std::abort();
  return 0;
}
