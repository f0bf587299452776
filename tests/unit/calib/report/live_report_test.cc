// SPDX-License-Identifier: Apache-2.0
#include "calib/report/live_report.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

namespace mgtd::calib::report {
namespace {

criticism::live::LiveFinding following(criticism::live::Follows what, int component) {
  criticism::live::FollowedQuantity followed{.what = what, .evidence = {}, .minutes = 60};
  followed.evidence.log10_p = -12;
  followed.evidence.share = 0.734;
  followed.evidence.component = component;
  followed.evidence.slope = 0.1512;
  followed.evidence.slope_sd = 0.0213;
  followed.evidence.swing = 1.21;
  followed.evidence.stated_sd = 0.25;
  return {.state = criticism::live::LiveState::suspect, .followed = followed};
}

TEST(LiveReport, ASuspectCalibrationIsReportedWithWhatTheClosureFollows) {
  criticism::live::LiveFinding found = following(criticism::live::Follows::temperature, 3);
  found.followed->also = {criticism::live::Follows::time};
  const LiveReport report = live_report(found);
  EXPECT_EQ(report.state, criticism::live::LiveState::suspect);
  EXPECT_EQ(
      report.measured,
      "the centre's z follows temperature with 0.151 +- 0.02 nT/degC: 1.21 nT in the last 60 min (73 % of "
      "what the closure does beyond its noise, p = 1e-12); or it follows time: they went together");
  EXPECT_EQ(report.limit, "0.25 nT, the standard deviation that the calibration states");
  EXPECT_EQ(report.remedy, "measure a dozen poses and run: mgt check CAL.json RUN");
}

TEST(LiveReport, TheAttitudeHasNoSlope) {
  const LiveReport report = live_report(following(criticism::live::Follows::attitude, 0));
  EXPECT_EQ(report.measured,
            "the curl follows the attitude: it moves by 1.21 nT/m over the turns of the last 60 min (73 % of "
            "what the closure does beyond its noise, p = 1e-12)");
  EXPECT_EQ(report.limit, "0.25 nT/m, the standard deviation that the calibration states");
}

TEST(LiveReport, ANearSourceIsReportedWithWhatItWasTestedAgainst) {
  criticism::live::LargeClosure large{.closure = Eigen::Vector4d(3, 1, -2, 4), .samples = 500, .log10_p = -6};
  const criticism::live::LiveFinding untested{.state = criticism::live::LiveState::near_source,
                                              .large = large};
  EXPECT_EQ(
      live_report(untested).measured,
      "the closure is 3 nT/m (curl) and 1, -2, 4 nT (centre), mean of 500 samples: p = 1e-6; whether it "
      "follows temperature, time or attitude is not known yet");
  large.tested = {criticism::live::Follows::temperature, criticism::live::Follows::attitude};
  const LiveReport report = live_report({.state = criticism::live::LiveState::near_source, .large = large});
  EXPECT_TRUE(report.measured.ends_with("; it does not follow temperature or attitude")) << report.measured;
  EXPECT_EQ(report.limit,
            "a chance of 1e-5 in 10 s, twice running, in an intact calibration and a smooth field");
}

TEST(LiveReport, ASensorInAnotherPlaceComesBeforeAllElse) {
  criticism::tests::Rearrangement plugs;
  plugs.sensor = {0, 3, 2, 1};
  const LiveReport report = live_report(following(criticism::live::Follows::time, 1),
                                        criticism::tests::RearrangementFinding{{plugs}, 123'456});
  EXPECT_EQ(report.state, criticism::live::LiveState::exchanged);
  EXPECT_EQ(
      report.measured,
      "s2 and s4 are exchanged: the closure has a chi-square of 1.2e+05 (4 degrees of freedom), and below "
      "30 when their readings are taken so");
  EXPECT_EQ(report.limit, "100, ten standard deviations");
}

TEST(LiveReport, ATurnedSensorIsNamedWithItsTurn) {
  criticism::tests::Rearrangement turn;
  turn.turned = 2;
  turn.turn_P = Eigen::AngleAxisd(std::numbers::pi / 2, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  turn.turn_P = turn.turn_P.array().round();
  const LiveReport report = live_report({}, criticism::tests::RearrangementFinding{{turn}, 500});
  EXPECT_EQ(report.state, criticism::live::LiveState::turned);
  EXPECT_EQ(
      report.measured,
      "s3 is turned by 90 deg about Z: the closure has a chi-square of 5e+02 (4 degrees of freedom), and "
      "turned so the sensor reads the field of the other three to 5 %");
}

/// The limit of a trouble that is over is not shown any more.
TEST(LiveReport, SaysNothingOfAClosureThatIsWell) {
  criticism::live::LiveFinding found = following(criticism::live::Follows::time, 1);
  found.state = criticism::live::LiveState::ok;
  found.followed.reset();
  const LiveReport report = live_report(found);
  EXPECT_EQ(report.state, criticism::live::LiveState::ok);
  EXPECT_EQ(report.measured + report.limit + report.remedy, "");
}

}  // namespace
}  // namespace mgtd::calib::report
