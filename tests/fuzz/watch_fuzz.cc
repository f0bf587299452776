// SPDX-License-Identifier: Apache-2.0
// Whatever a client of the stream sends: lines are bounded, a watch that is accepted survives its encoding,
// and a refusal can be sent back.
#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "proto/line_framer.h"
#include "proto/stream_codec.h"
#include "proto/watch_request.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mgtd::LineFramer framer(mgtd::kWatchLineLimit);
  const auto on_line = [](std::string_view line) {
    if (line.size() > mgtd::kWatchLineLimit) std::abort();
    const auto request = mgtd::parse_watch(line);
    if (request) {
      const auto back = mgtd::parse_watch(mgtd::encode(*request));
      if (!back || *back != *request) std::abort();
    } else if (mgtd::encode(request.error()).find('\n') != std::string::npos) {
      std::abort();
    }
  };
  std::string_view bytes(reinterpret_cast<const char*>(data), size);
  while (!bytes.empty()) {  // in pieces of 1 to 16 bytes, as their first byte says
    const std::size_t piece =
        std::min<std::size_t>(bytes.size(), 1 + (static_cast<unsigned char>(bytes[0]) & 15U));
    framer.feed(bytes.substr(0, piece), on_line, [] {});
    bytes.remove_prefix(piece);
  }
  return 0;
}
