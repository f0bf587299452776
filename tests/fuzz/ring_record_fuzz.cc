// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <string>

#include "proto/raw_log.h"
#include "proto/ring_record.h"

/// A file of the stream's ring, whatever it holds: no crash, what is a line has its numbers in order and is
/// written as it was read, and the numbers of a next life come after all that were read.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  mgtd::RawLogDecoder decoder;
  decoder.feed({reinterpret_cast<const char*>(data), size});
  mgtd::RingHistory history;
  std::uint64_t last = 0;
  bool any = false;
  while (const auto raw = decoder.next()) {
    const auto record = mgtd::ring_record(*raw);
    if (!record) continue;
    if (record->from_seq > record->to_seq) std::abort();
    std::string bytes;
    mgtd::encode_ring_bytes(*record, bytes);
    if (bytes != raw->bytes || mgtd::frame(*record, bytes).device != raw->device) std::abort();
    history.add(*record);
    if (record->kind == mgtd::RingRecord::Kind::promise || record->kind == mgtd::RingRecord::Kind::closed)
      continue;
    last = std::max(last, record->to_seq);
    any = true;
  }
  if (any && history.next_seq(mgtd::WallTime{0}, 50) <= last) std::abort();
  return 0;
}
