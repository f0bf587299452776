// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/progress.h"

#include <gmock/gmock.h>

namespace mgtd::daemon::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

RunStatus halfway() {
  RunStatus status;
  status.state = RunState::dwelling;
  status.set = "random";
  status.pose = 78;
  status.poses = 156;
  status.remaining_s = 250;
  return status;
}

TEST(Progress, ShowsBarCountsAndTimeLeft) {
  EXPECT_EQ(progress_line(halfway(), 200),
            "[############............]   78/156  random  dwelling  4 min 10 s left");
}

TEST(Progress, AFinishedRunHasNoTimeLeft) {
  RunStatus status = halfway();
  status.state = RunState::done;
  status.pose = status.poses;
  EXPECT_THAT(progress_line(status, 200), StartsWith("[########################]"));
  EXPECT_THAT(progress_line(status, 200), Not(HasSubstr("left")));
}

TEST(Progress, NeverWiderThanTheTerminal) {
  for (int width : {0, 1, 20, 40})
    EXPECT_LE(progress_line(halfway(), width).size(), static_cast<std::size_t>(width));
}

/// "7.60 nT" would be another quantity than "7.60 nT/m".
TEST(Progress, APartThatDoesNotFitIsLeftOutWhole) {
  RunStatus status = halfway();
  status.tensor_sd_nT_per_m = 7.6;
  const std::string whole = progress_line(status, 200);
  EXPECT_THAT(whole, HasSubstr("tensor to 7.60 nT/m"));
  const std::string cut = progress_line(status, static_cast<int>(whole.size()) - 1);
  EXPECT_THAT(cut, Not(HasSubstr("tensor")));
  EXPECT_THAT(cut, HasSubstr("left"));
}

TEST(Progress, AnEmptyPlanDoesNotDivideByZero) {
  EXPECT_THAT(progress_line(RunStatus{}, 200), HasSubstr("0/0"));
}

TEST(Progress, DurationsReadAsAPersonSaysThem) {
  EXPECT_EQ(duration_text(12.4), "12 s");
  EXPECT_EQ(duration_text(250), "4 min 10 s");
  EXPECT_EQ(duration_text(3783), "1 h 03 min");
  EXPECT_EQ(duration_text(-5), "0 s");
}

}  // namespace
}  // namespace mgtd::daemon::cli
