// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/run_notices.h"

#include <gtest/gtest.h>

namespace mgtd::daemon::cli {
namespace {

RunStatus measuring() {
  RunStatus run;
  run.state = RunState::dwelling;
  run.message = "pose 5 of 36: measuring for 4 s";
  return run;
}

TEST(RunNotices, SayWhyTheRunWaitsAndWhenItGoesOn) {
  RunNotices notices;
  RunStatus run = measuring();
  EXPECT_EQ(notices.of(run), "");
  run.state = RunState::paused;
  run.goes_on = true;
  run.message = "s2 is lost (gone)";
  EXPECT_EQ(notices.of(run), "s2 is lost (gone)\n");
  EXPECT_EQ(notices.of(run), "");
  EXPECT_EQ(notices.of(measuring()), "the run goes on\n");
}

/// The poses of a run by hand show what its preflight could not.
TEST(RunNotices, SayThatTheReadingsDoNotFollowTheAngles) {
  RunNotices notices;
  RunStatus run = measuring();
  run.checks = {
      {"rate", true, "50 Hz", "50 Hz", ""},
      {"wiring", false, "the readings do not follow the angles", "as the table turns", "look at it"}};
  const std::string line =
      "  failed: wiring: the readings do not follow the angles; limit as the table turns; look at it\n";
  EXPECT_EQ(failed_lines(run), line);
  EXPECT_EQ(notices.of(run), line);
  EXPECT_EQ(notices.of(run), "") << "once";
  run.checks[1].measured = "s2 is turned";
  EXPECT_NE(notices.of(run), "") << "another one";
}

TEST(RunNotices, LeaveTheEndToItsOwnReport) {
  RunStatus run = measuring();
  run.state = RunState::failed;
  run.checks = {{"noise", false, "9 nT", "1 nT", "look at it"}};
  EXPECT_EQ(RunNotices().of(run), "");
}

}  // namespace
}  // namespace mgtd::daemon::cli
