// SPDX-License-Identifier: Apache-2.0
#include <cstdlib>
#include <string>

#include "proto/raw_log.h"

namespace {

using mgtd::RawLogDecoder;

/// The good part of a log, said again.
std::string again(std::string_view log, RawLogDecoder& decoder, std::size_t& records) {
  std::string out;
  mgtd::RawLogEncoder encoder;
  decoder.feed(log);
  while (const auto record = decoder.next()) {
    if (out.empty()) out = mgtd::encode_header(decoder.header());
    encoder.encode(*record, out);
    ++records;
  }
  return out;
}

}  // namespace

/// Whatever the file holds: no crash, the same records however it is cut, and what was read is written so
/// that it reads the same.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const std::string_view log(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::size_t piece = data[0] + 1U;
  RawLogDecoder whole, second, cut;
  std::size_t records = 0, found = 0;
  const std::string once = again(log, whole, records);
  if (whole.good_bytes() > log.size()) std::abort();
  if (again(once, second, found) != once || found != records) std::abort();
  for (std::size_t at = 0; at < log.size(); at += piece) {
    cut.feed(log.substr(at, piece));
    while (cut.next()) --records;
  }
  if (records != 0 || cut.good_bytes() != whole.good_bytes()) std::abort();
  return 0;
}
