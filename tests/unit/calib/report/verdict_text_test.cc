// SPDX-License-Identifier: Apache-2.0
#include "calib/report/verdict_text.h"

#include <gmock/gmock.h>

#include "calib/criticism/tests/candidate.h"
#include "calib/effects/library/library.h"
#include "calib/report/size_text.h"
#include "proto/units.h"

namespace mgtd::calib::report {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Sentence, NotesBeginWithACapitalUnlessWithAName) {
  criticism::search::ExplainReport report;
  report.notes = {criticism::search::StepsFollowCurve{}, criticism::search::ExcessRemains{"axis.cubic", 0.3},
                  criticism::search::NoiseOverstated{"s3.z", 0.5},
                  criticism::search::ExcessRemains{"lamp", 0.2}};
  report.candidates.push_back({.effect = "lamp"});
  EXPECT_THAT(
      sentence(report),
      HasSubstr(". Several steps or thresholds on one axis follow a smooth curve: they are not evidence of "
                "steps. axis.cubic accounts for 30 % of the excess only. s3.z scatters only 0.50 of what its "
                "noise says: spreads or counts in the table are wrong, or poses are copies. lamp accounts "
                "for"));
}

TEST(Sentence, SizesHaveTheDigitsThatTheirUncertaintyAllows) {
  const auto text = [](double value, double sd) {
    return size_text({.coefficients = {{"s1.x", value, sd, "nT"}}});
  };
  EXPECT_EQ(text(1090, 512), "+1090 +- 512 nT");
  EXPECT_EQ(text(50.008, 1.96), "+50.0 +- 2.0 nT");
  EXPECT_EQ(text(-0.04031, 0.02), "-0.040 +- 0.020 nT");
  EXPECT_EQ(text(9.996, 0.0951), "+9.996 +- 0.095 nT");
  EXPECT_EQ(text(3.1e-7, 2e-8), "+3.1e-07 +- 2e-08 nT");
}

TEST(Sentence, AnEffectThatWouldBeSeenAtNoSizeIsToldSo) {
  EXPECT_EQ(detectable_text({"axis.cubic", "s3.x", 0.0841, "nT"}), "0.0841 nT (s3.x)");
  EXPECT_EQ(detectable_text({"site.dipole", "site", 3.3e13, "A m^2"}),
            "at no size: what is in the model takes it up");
}

TEST(NamesText, TellsWhichNameIsOpen) {
  criticism::search::ExplainReport report;
  report.finding = criticism::search::Finding::ambiguous;
  report.rounds.resize(1);
  report.rounds[0].added.effect = "axis.cubic";
  report.rounds[0].possible = {"axis.transverse"};
  EXPECT_EQ(names_text(report), "axis.cubic or axis.transverse");
  report.rounds.resize(3);
  report.rounds[1].added.effect = "site.gradient";
  report.rounds[2].added.effect = "axis.quadratic";
  EXPECT_EQ(names_text(report), "site.gradient, axis.quadratic; axis.cubic or axis.transverse");
  report.rounds[1].added.effect = "axis.cubic";  // on another axis, and sure there
  EXPECT_EQ(names_text(report), "axis.quadratic; axis.cubic or axis.transverse");
  report.finding = criticism::search::Finding::partial;
  report.named = {"axis.cubic", "site.gradient"};
  EXPECT_EQ(names_text(report), "axis.cubic, site.gradient");
}

TEST(Sentence, SaysWhatWasLeftOut) {
  criticism::search::ExplainReport report;
  EXPECT_THAT(sentence(report), Not(HasSubstr("left out")));
  report.outliers = {{5, "s4.z", -49.98, "nT", 107}};
  EXPECT_THAT(sentence(report),
              HasSubstr("One observation that the others contradict is left out, in pose 5"));
  report.outliers.push_back({9, "scalar", 3, "nT", 20});
  report.outliers.push_back({9, "s1.x", 30, "nT", 20});
  EXPECT_THAT(sentence(report),
              HasSubstr("3 observations that the others contradict are left out, in pose 5,9"));
  report.outliers.clear();
  for (int pose = 20; pose < 50; ++pose) report.outliers.push_back({pose, "pose", 30, "nT", 20});
  EXPECT_THAT(sentence(report), HasSubstr("are left out, in pose 20-49 (listed at the end)"));
}

/// The readings tell each pose its own attitude: what is gained are the angles.
TEST(Sentence, OfAnEffectOfTheTableTheAnglesAreTold) {
  const auto with_table_sd_deg = [](double sd_deg) {
    auto fit = std::make_shared<fit::joint::JointFit>();
    fit->table_sd_rad = to_rad(sd_deg);
    return fit;
  };
  criticism::search::ExplainReport report;
  report.fit = with_table_sd_deg(0.35);
  criticism::search::Round round{.added = {.effect = "table.wobble", .where = "table"}};
  round.fit = with_table_sd_deg(0.1);
  report.rounds = {round};
  EXPECT_THAT(sentence(report),
              HasSubstr("With it in the model the angles of the table scatter by 0.1 instead of 0.35 deg"));
}

TEST(Sentence, SaysWhatTheResidualDidAndWhatWasSearchedFor) {
  const auto told = [](double before_nT, double after_nT) {
    criticism::search::Round round{.added = {.effect = "site.step", .where = "site"}};
    round.rms_before_nT = before_nT, round.rms_after_nT = after_nT;
    round.model = {*effects::library::make_effect("axis.offset.step@s1.y,ts=0.5"),
                   *effects::library::make_effect("site.step,ts=0.25")};
    criticism::search::ExplainReport report;
    report.rounds = {round};
    return sentence(report);
  };
  EXPECT_THAT(told(9.5, 0.31),
              HasSubstr("With it in the model (ts = 0.25 h) the residual falls from 9.5 to 0.31 nT"));
  EXPECT_THAT(told(0.5071, 0.5069), HasSubstr("the residual stays at 0.507 nT"));
  EXPECT_THAT(told(9.46, 9.51), HasSubstr("the residual goes from 9.46 to 9.51 nT"));
}

/// A moment and a place are not in the name.
TEST(Sentence, TellsTheWholeCommandOfWhatWasSearchedFor) {
  criticism::search::ExplainReport report;
  report.finding = criticism::search::Finding::explained;
  report.model = {*effects::library::make_effect("axis.cubic@s1.y"),
                  *effects::library::make_effect("site.step,ts=0.25,x=2,y=1,z=-0.5")};
  EXPECT_THAT(sentence(report),
              HasSubstr("As it was found it is added by mgt add site.step,ts=0.25,x=2,y=1,z=-0.5 RUN."));
  report.model.pop_back();
  EXPECT_THAT(sentence(report), Not(HasSubstr("mgt add")));
}

TEST(Sentence, TellsFromWhichPoseOn) {
  const Pose before{.number = 53}, after{.number = 54};
  auto fit = std::make_shared<fit::joint::JointFit>();
  fit->problem.poses.resize(2);
  fit->problem.poses[0].pose = &before, fit->problem.poses[0].t_h = 0.2;
  fit->problem.poses[1].pose = &after, fit->problem.poses[1].t_h = 0.3;
  criticism::search::Round round{.added = {.effect = "site.step", .where = "site"}};
  round.model = {*effects::library::make_effect("site.step,ts=0.25")};
  round.fit = fit;
  criticism::search::ExplainReport report;
  report.rounds = {round};
  EXPECT_THAT(sentence(report), HasSubstr("(ts = 0.25 h, from pose 54 on)"));
}

/// Maps beside effects that stand in for a law show nothing of it, and a formula leaves nothing to look for.
TEST(Sentence, GivesNoAdviceBesideALaw) {
  criticism::search::ExplainReport report;
  report.finding = report.left = criticism::search::Finding::partial;
  report.named = {"axis.cubic"};
  report.maps_left = {{.map = "battery_V", .where = "s3.y", .log10_p = -1.1}};
  EXPECT_THAT(sentence(report), HasSubstr("nothing that was recorded orders this residual"));
  report.notes = {criticism::search::LawOfNoLibrary{"s3.z", {"axis.cubic"}},
                  criticism::search::TablePathUnknown{}};
  EXPECT_THAT(sentence(report),
              AllOf(Not(HasSubstr("nothing that was recorded")), Not(HasSubstr("battery_V")),
                    HasSubstr("mgt discover RUN"), HasSubstr("axis.hysteresis")));
  report.formulas_account = true;
  EXPECT_THAT(sentence(report), AllOf(HasSubstr("A formula accounts for the rest."),
                                      Not(HasSubstr("What to do next")), Not(HasSubstr("axis.hysteresis"))));
}

/// A law of no library: names that take away a tenth of it are no causes.
TEST(Sentence, SaysWhenWhatWasFoundIsTheLesserPart) {
  criticism::search::ExplainReport report;
  report.finding = criticism::search::Finding::partial;
  report.noise.known = true;
  report.noise_nT = 0.02;
  criticism::search::Round round{.added = {.effect = "axis.offset.step", .where = "s1.y"}};
  round.rms_before_nT = 0.0911, round.rms_after_nT = 0.0809;
  report.rounds = {round};
  EXPECT_THAT(sentence(report), HasSubstr("takes away only 22 % of what is beyond the noise"));
  EXPECT_THAT(sentence(report), Not(HasSubstr("Nothing else in the library looks like it")));
  report.rounds.front().rms_after_nT = 0.03;
  EXPECT_THAT(sentence(report), Not(HasSubstr("takes away only")));
  EXPECT_THAT(sentence(report), HasSubstr("Nothing else in the library looks like it"));
}

}  // namespace
}  // namespace mgtd::calib::report
