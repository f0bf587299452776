// SPDX-License-Identifier: Apache-2.0
// An offset that steps once looks like one that wanders, or like a stretch of poses that contradict the rest.
// It must be found wherever in the run it comes.
#include <gtest/gtest.h>

#include "calib/criticism/search/explain.h"
#include "calib/report/verdict_text.h"
#include "tests/blind/hidden_run.h"

namespace mgtd::calib::criticism::search {
namespace {

constexpr double kNoise_nT = 0.02;

/// The offsets of s2 step by `nT` after pose `last`, of which the step takes `within` of the dwell.
PoseTable stepping(double nT, int last, double within, std::uint64_t seed) {
  testing::HiddenRun run{.noise_nT = kNoise_nT};
  run.hidden = [=](const Pose& pose, int sensor, int, const Eigen::Vector3d&) {
    if (sensor != 1 || pose.number < last) return 0.0;
    return pose.number == last ? within * nT : nT;
  };
  return hidden_run(run, seed);
}

ExplainReport explained_step(const PoseTable& table) {
  auto report = explain(table, {});
  if (!report) throw std::runtime_error(report.error().text());
  return *std::move(report);
}

/// Forty times are asked about first, in 157 poses: beside a memory of the noise a step shows in none but its
/// own. Four poses one after the other.
TEST(StepTime, ALargeStepOfASensorIsNoWalk) {
  for (int last = 70; last < 74; ++last) {
    const ExplainReport r = explained_step(stepping(20, last, 0, 4));
    EXPECT_EQ(r.finding, Finding::explained) << last << ": " << report::sentence(r);
    EXPECT_EQ(r.named, std::vector<std::string>{"axis.offset.step"}) << last;
    EXPECT_LT(r.rounds.back().rms_after_nT, 1.1 * kNoise_nT) << last;
  }
}

/// Seven poses share its evidence: without one of them the others are enough.
TEST(StepTime, AStepBeforeTheLastSevenPosesIsNamed) {
  const ExplainReport r = explained_step(stepping(0.12, 150, 0, 4));
  EXPECT_EQ(r.finding, Finding::explained) << report::sentence(r);
  EXPECT_EQ(r.named, std::vector<std::string>{"axis.offset.step"});
}

/// More than a quarter of the poses come after the step. The one in whose dwell it came fits neither side.
TEST(StepTime, AStepWithinADwellIsNotBadData) {
  for (const std::uint64_t seed : {1U, 2U}) {
    const ExplainReport r = explained_step(stepping(2, 115, 0.4, seed));
    EXPECT_EQ(r.finding, Finding::explained) << report::sentence(r);
    EXPECT_EQ(r.named, std::vector<std::string>{"axis.offset.step"});
    EXPECT_LT(r.rounds.back().rms_after_nT, 1.1 * kNoise_nT);
    ASSERT_FALSE(r.outliers.empty());
    for (const fit::OutlierNode& left_out : r.outliers) EXPECT_EQ(left_out.pose, 115);
  }
}

}  // namespace
}  // namespace mgtd::calib::criticism::search
