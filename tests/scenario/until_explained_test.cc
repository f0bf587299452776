// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "calib/design/actions.h"
#include "calib/design/law_actions.h"
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

/// Whatever a run may ask a hand for with heat or a coil, the simulated hand can do.
TEST(UntilExplained, TheHandKnowsEveryDeedOfHeatAndOfACoil) {
  std::vector<std::string> texts;
  for (const calib::design::Action& action : calib::design::actions()) texts.emplace_back(action.text);
  for (const calib::design::LawAction& action : calib::design::law_actions()) texts.emplace_back(action.text);
  int known = 0;
  for (const std::string& text : texts) {
    const bool heat = text.find("warm") != std::string::npos && text.find("another day") == std::string::npos;
    const bool coil = text.find("(coil)") != std::string::npos;
    EXPECT_EQ(rig::deed_of(text).has_value(), heat || coil) << text;
    known += heat || coil ? 1 : 0;
  }
  EXPECT_GE(known, 5);
}

}  // namespace
}  // namespace mgtd
