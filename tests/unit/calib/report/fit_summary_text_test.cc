// SPDX-License-Identifier: Apache-2.0
#include "calib/report/fit_summary_text.h"

#include <gmock/gmock.h>

namespace mgtd::calib::report {
namespace {

using ::testing::HasSubstr;

fit::FitSummary ended(fit::Termination how) {
  return {.termination = how, .rounds = 3, .iterations = 17, .initial_cost = 8.2e6, .final_cost = 612};
}

TEST(FitSummaryText, SaysRoundsStepsAndChiSquare) {
  EXPECT_EQ(to_text(ended(fit::Termination::converged)),
            "converged in 3 rounds, 17 steps: chi-square fell from 8.2e+06 to 612");
}

TEST(FitSummaryText, OneRoundAndOneStepAreSingular) {
  fit::FitSummary once = ended(fit::Termination::converged);
  once.rounds = once.iterations = 1;
  EXPECT_THAT(to_text(once), HasSubstr("converged in 1 round, 1 step:"));
}

TEST(FitSummaryText, NamesTheLimitAtWhichAFitStopped) {
  EXPECT_THAT(to_text(ended(fit::Termination::slow_progress)), HasSubstr("limit of 200 steps"));
  EXPECT_THAT(to_text(ended(fit::Termination::round_limit)), HasSubstr("limit of 30 rounds"));
  EXPECT_FALSE(ended(fit::Termination::slow_progress).converged());
  EXPECT_FALSE(ended(fit::Termination::round_limit).converged());
}

TEST(FitSummaryText, EveryEndHasANameOfItsOwn) {
  EXPECT_EQ(to_string(fit::Termination::closed_form), "closed-form");
  EXPECT_EQ(to_string(fit::Termination::converged), "converged");
  EXPECT_EQ(to_string(fit::Termination::slow_progress), "slow-progress");
  EXPECT_EQ(to_string(fit::Termination::round_limit), "round-limit");
}

}  // namespace
}  // namespace mgtd::calib::report
