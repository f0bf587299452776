// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/work_progress.h"

#include <gtest/gtest.h>

namespace mgtd::daemon::cli {
namespace {

TEST(WorkProgress, ABarWithTheTimeLeftWhereTheShareIsKnown) {
  const WorkState work{"replay", 4, 4, 0.25};
  EXPECT_EQ(work_line(work, 200), "[######..................]  replay  25 % done, 12 s left");
}

TEST(WorkProgress, AHundredthSaysNothingOfTheTimeLeft) {
  EXPECT_EQ(work_line({"replay", 4, 4, 0.004}, 200), "[........................]  replay  0 % done");
}

TEST(WorkProgress, WithoutAShareTheTimeSoFar) {
  EXPECT_EQ(work_line({"explain", 75, 70, std::nullopt}, 200), "explain: working for 1 min 15 s");
}

TEST(WorkProgress, ABusyComputerIsNamed) {
  EXPECT_EQ(work_line({"explain", 100, 8, std::nullopt}, 200),
            "explain: working for 1 min 40 s; other programs leave it 8 % of a processor");
}

TEST(WorkProgress, AFitSaysItsRoundAndTheResidualSoFar) {
  WorkState work{"explain", 14, 14, std::nullopt};
  work.fits = 23;
  work.round = calib::fit::FitRound{2, 0.04123};
  EXPECT_EQ(work_line(work, 200), "explain: working for 14 s, fit 23, round 2: residual 0.0412 nT");
}

TEST(WorkProgress, TheListenerMayOutliveWhatShowsIt) {
  calib::fit::RoundListener kept;
  EXPECT_EQ(with_progress("fit", {},
                          [&](const calib::fit::FitOptions& told) {
                            kept = told.on_round;
                            return 1;
                          }),
            1);
  kept({.round = 1, .residual_nT = 0.5});
}

TEST(WorkProgress, NeverWiderThanTheTerminal) {
  for (const int width : {0, 1, 20, 40})
    EXPECT_LE(work_line({"replay", 4, 1, 0.25}, width).size(), static_cast<std::size_t>(width));
}

TEST(WorkProgress, TheResultOfTheWorkIsHandedOn) {
  EXPECT_EQ(with_progress("sum", [] { return 2 + 3; }), 5);
}

}  // namespace
}  // namespace mgtd::daemon::cli
