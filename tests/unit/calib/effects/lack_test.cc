// SPDX-License-Identifier: Apache-2.0
// What poses lack for an effect, and which effect can do without it in some of them.
#include <gmock/gmock.h>

#include "calib/criticism/tests/candidate_effect.h"
#include "calib/effects/library/library.h"
#include "calib/fit/method_choice/fit.h"
#include "tests/blind/hidden_run.h"

namespace mgtd::calib::effects {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

PoseTable with_sense(std::size_t lacking) {
  PoseTable table = testing::hidden_run({}, 4);
  for (std::size_t k = 0; k < table.poses.size(); ++k)
    if (k >= lacking) table.poses[k].sense = k % 3 == 0 ? 1 : -1;
  return table;
}

const criticism::tests::Untestable* find(const std::vector<criticism::tests::Untestable>& all,
                                         std::string_view name) {
  for (const criticism::tests::Untestable& u : all)
    if (u.effect == name) return &u;
  return nullptr;
}

TEST(Backlash, TheFirstPoseOfARunNeedNotHaveASense) {
  for (const std::size_t lacking : {0U, 1U, 15U}) {
    const PoseTable table = with_sense(lacking);
    EXPECT_TRUE((*library::make_effect("table.backlash"))->applicable(table)) << lacking;
    EXPECT_EQ(find(criticism::tests::library_candidates(table).untestable, "table.backlash"), nullptr)
        << lacking;
    fit::FitOptions options;
    options.effects = {*library::make_effect("table.backlash")};
    EXPECT_TRUE(fit::method_choice::fit(table, options)) << lacking;
  }
}

TEST(Lack, SaysHowManyPosesAndWhatToDo) {
  const PoseTable table = with_sense(16);
  const auto refused = (*library::make_effect("table.backlash"))->applicable(table);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message,
            "table.backlash needs sense, which 16 of 157 poses have not (the first: pose 1)");
  EXPECT_THAT(refused.error().remedy, HasSubstr("leave the poses without it out of the table"));
  const criticism::tests::CandidateEffects candidates = criticism::tests::library_candidates(table);
  const criticism::tests::Untestable* listed = find(candidates.untestable, "table.backlash");
  ASSERT_NE(listed, nullptr);
  EXPECT_THAT(listed->why, StartsWith("needs sense, which 16 of 157"));
}

TEST(Lack, AnAngleIsNeededOfEveryPose) {
  PoseTable table = with_sense(1);
  table.poses[7].pitch_rad.reset();
  EXPECT_THAT((*library::make_effect("table.backlash"))->applicable(table).error().message,
              HasSubstr("table.backlash needs"));
}

TEST(Lack, ATemperatureThatNeverChangesTestsNothing) {
  PoseTable table = with_sense(0);
  for (Pose& pose : table.poses) pose.T_degC = {20, 20, 21, 20};
  const criticism::tests::CandidateEffects candidates = criticism::tests::library_candidates(table);
  const criticism::tests::Untestable* listed = find(candidates.untestable, "axis.offset.temperature");
  ASSERT_NE(listed, nullptr);
  EXPECT_THAT(listed->why, HasSubstr("never change"));
  EXPECT_EQ(find(candidates.untestable, "axis.offset.drift"), nullptr);
}

TEST(Lack, NoReasonBeginsWithTheNameItStandsBeside) {
  for (const criticism::tests::Untestable& u :
       criticism::tests::library_candidates(with_sense(157)).untestable)
    EXPECT_THAT(u.why, ::testing::Not(StartsWith(u.effect))) << u.effect;
}

}  // namespace
}  // namespace mgtd::calib::effects
