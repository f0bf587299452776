// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "tests/scenario/judged_run.h"

namespace mgtd {
namespace {

using test::JudgedRun;
using ::testing::HasSubstr;

/// Of one field strength an own square and the transverse squares read alike: a weaker field tells them
/// apart.
TEST(UntilExplained, AWeakerFieldTellsAnOwnSquareFromTheTransverseOnes) {
  JudgedRun run(test::scenario_of("[rig]\nparameters = \"random\"\nseed = 17\n"
                                  "[temperature]\nramp_degC_per_h = 2\n[sensors]\nnoise_nT = 0.3\n"
                                  "[[effect]]\nname = \"axis.quadratic\"\nwhere = \"s2.y\"\n"
                                  "nT_at_F0 = 0.6\n"),
                40);
  ASSERT_TRUE(run.run());
  ASSERT_EQ(run.deeds.size(), 1U);
  EXPECT_THAT(run.deeds.front(), HasSubstr("the field a fifth weaker (coil)"));
  ASSERT_EQ(run.judgements.size(), 2U);
  EXPECT_EQ(run.judgements[0].found, "AMBIGUOUS: axis.quadratic or axis.transverse");
  EXPECT_EQ(run.judgements[1].found, "EXPLAINED: axis.quadratic");
  EXPECT_THAT(run.daemon.status->judged, HasSubstr("EXPLAINED: axis.quadratic"));
  EXPECT_EQ(run.daemon.poses.poses.size(), 181U);
  EXPECT_EQ(name(run.daemon.finished->state), "done");
}

/// Nothing hidden: the first look ends it.
TEST(UntilExplained, ACleanRunMeasuresNothingMore) {
  JudgedRun run(test::scenario_of("[rig]\nparameters = \"random\"\nseed = 18\n"), 40);
  ASSERT_TRUE(run.run());
  ASSERT_EQ(run.judgements.size(), 1U);
  EXPECT_EQ(run.judgements[0].found, "PASS");
  EXPECT_TRUE(run.deeds.empty());
  EXPECT_EQ(run.daemon.poses.poses.size(), 157U);
}

}  // namespace
}  // namespace mgtd
