// SPDX-License-Identifier: Apache-2.0
// The experiment of the paper with what it could not explain: a gradient, four temperature laws, hysteresis,
// two curved axes, all at once. Nobody tells improve.
#include <gtest/gtest.h>

#include "tests/blind/unseen.h"

namespace mgtd::calib::criticism::search {
namespace {

/// This run once ended at sixty times the oracle's error.
TEST(PaperExperiment, IsExplainedToNearlyTheNoiseOnUnseenPoses) {
  const auto run =
      testing::unseen(testing::rig_run(testing::paper_experiment(), 100, 1002), testing::paper_effects());
  EXPECT_GT(run.nothing_nT, 10);
  EXPECT_LT(run.oracle_nT, 0.04);
  EXPECT_LT(run.improved_nT, 1.1 * run.oracle_nT);
}

}  // namespace
}  // namespace mgtd::calib::criticism::search
