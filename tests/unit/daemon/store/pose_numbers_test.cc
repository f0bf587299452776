// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/pose_numbers.h"

#include <gmock/gmock.h>
#include <rapidcheck.h>

#include "proto/pose_numbers_text.h"

namespace mgtd::daemon::store {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(PoseNumbers, AreReadAsAnOperatorWritesThem) {
  EXPECT_THAT(parse_pose_numbers("3").value(), ElementsAre(3));
  EXPECT_THAT(parse_pose_numbers("3,7-9, 8").value(), ElementsAre(3, 7, 8, 9));
  for (const char* bad : {"", ",", "x", "3-", "-", "9-7", "3;4", "1-999999999"})
    EXPECT_FALSE(parse_pose_numbers(bad)) << bad;
}

TEST(PoseNumbers, TheirTextIsReadBack) {
  EXPECT_EQ(pose_numbers_text({3, 7, 8, 9}), "3,7-9");
  rc::check("numbers survive their text", [] {
    const auto numbers = *rc::gen::container<std::set<int>>(rc::gen::inRange(0, 500));
    RC_PRE(!numbers.empty());
    const auto back = parse_pose_numbers(pose_numbers_text(numbers));
    RC_ASSERT(back.has_value());
    RC_ASSERT(*back == numbers);
  });
}

TEST(PoseNumbers, AreTakenOutOfATableOrRefused) {
  PoseTable table;
  for (int number = 1; number <= 4; ++number) {
    table.poses.emplace_back();
    table.poses.back().number = number;
  }
  const auto left = without_poses(table, {2, 3});
  ASSERT_TRUE(left);
  EXPECT_EQ(left->poses.size(), 2U);
  EXPECT_EQ(left->poses[1].number, 4);
  const auto refused = without_poses(table, {2, 9});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("9"));
}

}  // namespace
}  // namespace mgtd::daemon::store
