// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <string>

#include "proto/raw_log.h"

/// Whatever the file holds: no crash, the same records however it is cut, and each re-encodes to the bytes it
/// was read from.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const std::string_view log(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::size_t piece = data[0] + 1U;
  mgtd::RawLogDecoder whole, cut;
  std::string again;
  whole.feed(log);
  std::size_t records = 0;
  while (const auto record = whole.next()) {
    mgtd::encode_record(*record, again);
    ++records;
  }
  if (whole.state() != mgtd::RawLogDecoder::State::header && whole.good_bytes() > 0 &&
      log.substr(0, whole.good_bytes()).substr(whole.good_bytes() - again.size()) != again) {
    std::abort();
  }
  for (std::size_t at = 0; at < log.size(); at += piece) {
    cut.feed(log.substr(at, piece));
    while (cut.next()) --records;
  }
  if (records != 0 || cut.good_bytes() != whole.good_bytes()) std::abort();
  return 0;
}
