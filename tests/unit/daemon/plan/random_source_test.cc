// SPDX-License-Identifier: Apache-2.0
#include "daemon/plan/random_source.h"

#include <gmock/gmock.h>

namespace mgtd::daemon::plan {
namespace {

/// A seed that stands in a run file gives that run's plan, with every standard library and in every version.
TEST(RandomSource, MakesTheseChoicesFromThisSeed) {
  RandomSource random(121);
  EXPECT_EQ(random.uniform(), 0x1.8a92798a6e4d4p-3);
  EXPECT_EQ(random.uniform(), 0x1.25b51468063b8p-2);
  std::vector<int> items{0, 1, 2, 3, 4, 5, 6, 7};
  random.shuffle(items);
  EXPECT_THAT(items, ::testing::ElementsAre(6, 2, 3, 0, 1, 5, 7, 4));
  EXPECT_EQ(random.below(1000), 460U);
}

}  // namespace
}  // namespace mgtd::daemon::plan
