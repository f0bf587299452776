// SPDX-License-Identifier: Apache-2.0
#include "proto/nearest_word.h"

#include <gtest/gtest.h>

#include <vector>

namespace mgtd {
namespace {

TEST(NearestWord, IsTheOneWithTheFewestSlipsOrNone) {
  const std::vector<std::string> words{"status", "watch", "calibrations"};
  EXPECT_EQ(nearest_word("statsu", words), "status");
  EXPECT_EQ(nearest_word("calibration", words), "calibrations");
  EXPECT_EQ(nearest_word("frobnicate", words), std::nullopt);
  EXPECT_EQ(nearest_word("watch", {}), std::nullopt);
}

}  // namespace
}  // namespace mgtd
