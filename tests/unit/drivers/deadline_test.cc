// SPDX-License-Identifier: Apache-2.0
#include "drivers/deadline.h"

#include <gtest/gtest.h>

namespace mgtd::drivers {
namespace {

Instant at(double s) { return Instant(from_seconds(s)); }

TEST(Deadline, NeedsBothTheTimeAndTheTicks) {
  Deadline deadline;
  deadline.set(at(0), 1.0, 3);
  EXPECT_FALSE(deadline.passed(at(60))) << "one late tick: nothing has been read yet";
  EXPECT_FALSE(deadline.passed(at(60)));
  EXPECT_TRUE(deadline.passed(at(60)));
  deadline.set(at(0), 1.0, 2);
  EXPECT_FALSE(deadline.passed(at(0.1)));
  EXPECT_FALSE(deadline.passed(at(0.2)));
  EXPECT_FALSE(deadline.passed(at(0.9)));
  EXPECT_TRUE(deadline.passed(at(1.0)));
}

TEST(Deadline, NeverPassesUnset) {
  Deadline deadline;
  EXPECT_FALSE(deadline.passed(at(1e6)));
  deadline.set(at(0), 0.0, 0);
  EXPECT_TRUE(deadline.armed());
  deadline.clear();
  EXPECT_FALSE(deadline.passed(at(1e6)));
}

}  // namespace
}  // namespace mgtd::drivers
