// SPDX-License-Identifier: Apache-2.0
#include "proto/byte_order.h"

#include <gtest/gtest.h>

namespace mgtd {
namespace {

TEST(ByteOrder, WritesTheLowBytesWithTheLowestFirst) {
  std::string out = "x";
  put_little<1>(out, 0x1234);
  put_little<2>(out, 0x123456);
  put_little<4>(out, 0xFF89ABCDEF);
  put_little<8>(out, 0x8000000000000001U);
  EXPECT_EQ(out, std::string("x\x34\x56\x34\xEF\xCD\xAB\x89\x01\0\0\0\0\0\0\x80", 16));
}

TEST(ByteOrder, ReadsAtAnyPlace) {
  const std::string from("\xFF\x01\x02\x03\x04\x05\x06\x07\x88", 9);
  EXPECT_EQ(get_little<1>(from, 0), 0xFFU);
  EXPECT_EQ(get_little<2>(from, 1), 0x0201U);
  EXPECT_EQ(get_little<4>(from, 5), 0x88070605U);
  EXPECT_EQ(get_little<8>(from, 1), 0x8807060504030201U);
}

}  // namespace
}  // namespace mgtd
