// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <boost/endian/conversion.hpp>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

/// Whole numbers in files are little endian and take one to eight bytes. Boost.Endian orders the bytes.
namespace mgtd {

/// Appends the low `Bytes` bytes of `value`.
template <std::size_t Bytes>
void put_little(std::string& out, std::uint64_t value) {
  std::array<unsigned char, Bytes> bytes{};
  boost::endian::endian_store<std::uint64_t, Bytes, boost::endian::order::little>(bytes.data(), value);
  out.append(bytes.begin(), bytes.end());
}

/// `from` holds at least at + Bytes bytes.
template <std::size_t Bytes>
[[nodiscard]] std::uint64_t get_little(std::string_view from, std::size_t at) {
  std::array<unsigned char, Bytes> bytes{};
  from.copy(reinterpret_cast<char*>(bytes.data()), Bytes, at);
  return boost::endian::endian_load<std::uint64_t, Bytes, boost::endian::order::little>(bytes.data());
}

}  // namespace mgtd
