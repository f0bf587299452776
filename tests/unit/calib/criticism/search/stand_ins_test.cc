// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/stand_ins.h"

#include <gmock/gmock.h>

#include "calib/effects/library/library.h"
#include "calib/report/explain_text.h"

namespace mgtd::calib::criticism::search {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

/// Two effects were found, and something is left.
ExplainReport two_found() {
  ExplainReport out{.finding = Finding::partial, .named = {"axis.cubic", "axis.quadratic"}, .noise = {}};
  out.left = Finding::unknown;
  for (const char* spec : {"axis.cubic@s1.x", "axis.quadratic@s3.z"})
    out.model.push_back(effects::library::make_effect(spec, 4).value());
  out.next.emplace_back();
  return out;
}

TEST(StandIns, AreNotNamed) {
  ExplainReport report = two_found();
  take_back_stand_ins({"axis.quadratic@s3.z"}, report);
  EXPECT_EQ(report.finding, Finding::partial);
  EXPECT_THAT(report.named, ElementsAre("axis.cubic"));
  EXPECT_THAT(report.stand_ins, ElementsAre("axis.quadratic@s3.z"));
  EXPECT_EQ(report.next.size(), 1U) << "it is about the first name, which stays";
  EXPECT_EQ(report.model.size(), 2U);
  EXPECT_THAT(
      report::to_text(report),
      AllOf(StartsWith("PARTIAL: axis.cubic\n"),
            HasSubstr("axis.quadratic@s3.z is not named: formulas account for everything without it.")));
}

TEST(StandIns, WithoutANameTheVerdictIsUnknown) {
  ExplainReport report = two_found();
  take_back_stand_ins({"axis.cubic@s1.x", "axis.quadratic@s3.z"}, report);
  EXPECT_EQ(report.finding, Finding::unknown);
  EXPECT_THAT(report.named, IsEmpty());
  EXPECT_THAT(report.next, IsEmpty());
  EXPECT_THAT(report::to_text(report),
              AllOf(StartsWith("UNKNOWN\n"),
                    HasSubstr("are not named: formulas account for everything without them."),
                    Not(HasSubstr("no effect of the library looks like it"))));
}

/// A name may stand for several axes.
TEST(StandIns, ANameThatActsElsewhereTooStays) {
  ExplainReport report = two_found();
  report.model.push_back(effects::library::make_effect("axis.quadratic@s4.x", 4).value());
  take_back_stand_ins({"axis.quadratic@s3.z"}, report);
  EXPECT_THAT(report.named, ElementsAre("axis.cubic", "axis.quadratic"));
}

/// As after a round whose effect took the place of one that was given.
TEST(StandIns, ANameThatIsNoStandInStaysWhereverItsEffectStands) {
  ExplainReport report = two_found();
  report.named.emplace_back("axis.settling");
  take_back_stand_ins({"axis.cubic@s1.x", "axis.quadratic@s3.z"}, report);
  EXPECT_THAT(report.named, ElementsAre("axis.settling"));
  EXPECT_EQ(report.finding, Finding::partial);
}

TEST(StandIns, NoneChangeNothing) {
  ExplainReport report = two_found();
  take_back_stand_ins({}, report);
  EXPECT_EQ(report.finding, Finding::partial);
  EXPECT_THAT(report.named, ElementsAre("axis.cubic", "axis.quadratic"));
}

}  // namespace
}  // namespace mgtd::calib::criticism::search
