// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/course_recorder.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "calib/sensor/sensor_equations.h"
#include "tests/unit/daemon/run/run_bench.h"

namespace mgtd::daemon::run {
namespace {

using ::testing::HasSubstr;

const Eigen::Vector3d kSite = Eigen::Vector3d(1, 0.1, 1.2).normalized();

Eigen::Vector3d at(const TableAngles& a) {
  return calib::sensor::table_rotation(a.azimuth_rad, a.pitch_rad, a.roll_rad, 0.0, 0.0) * kSite;
}

/// A pose of a plan as it would be measured without errors.
Pose measured(const plan::PlannedPose& planned) {
  Pose pose;
  pose.number = planned.number;
  pose.azimuth_rad = planned.target.azimuth_rad;
  pose.pitch_rad = planned.target.pitch_rad;
  pose.roll_rad = planned.target.roll_rad;
  for (Eigen::Vector3d& y_nT : pose.y_nT) y_nT = 50'000 * at(planned.target);
  return pose;
}

Stamp second(double t_s) { return {Instant{from_seconds(t_s)}, WallTime{from_seconds(t_s).count()}}; }

RunStatus showing(RunState state, bool goes_on = false) {
  RunStatus status;
  status.state = state;
  status.goes_on = goes_on;
  return status;
}

struct Recorded {
  plan::RunPlan plan{mgtd::test::bench_plan(4)};
  CourseRecorder recorder{"monday", plan, std::nullopt, 2.0};
};

TEST(CourseRecorder, TheFirstPoseTellsWhereTheOthersLie) {
  Recorded r;
  for (const CoursePose& pose : r.recorder.course().poses) EXPECT_FALSE(pose.direction_P);
  EXPECT_FALSE(r.recorder.course().hole);
  r.recorder.shows(showing(RunState::moving), second(0));
  r.recorder.measured(measured(r.plan.poses[0]));
  const RunCourse course = r.recorder.course();
  EXPECT_EQ(course.run_id, "monday");
  EXPECT_EQ(course.poses[0].state, CourseState::measured);
  EXPECT_EQ(course.poses[1].state, CourseState::next);
  EXPECT_EQ(course.poses[2].state, CourseState::planned);
  for (std::size_t i = 0; i < 4; ++i)
    EXPECT_LT((*course.poses[i].direction_P - at(r.plan.poses[i].target)).norm(), 1e-9) << i;
}

TEST(CourseRecorder, WithoutAMeasuredPoseTheConfigurationTells) {
  const plan::RunPlan plan = mgtd::test::bench_plan(2);
  const CourseRecorder recorder("monday", plan, kSite, std::nullopt);
  EXPECT_LT((*recorder.course().poses[1].direction_P - at(plan.poses[1].target)).norm(), 1e-9);
}

TEST(CourseRecorder, AMountingTurnsThePlannedDirection) {
  plan::RunPlan plan = mgtd::test::bench_plan(2);
  plan.poses[1].mount = 1;
  plan.poses[1].mounting = {.azimuth_rad = 0.5, .pitch_rad = 0, .roll_rad = std::numbers::pi / 2};
  const CourseRecorder recorder("monday", plan, kSite, std::nullopt);
  const TableAngles& m = plan.poses[1].mounting;
  const Eigen::Vector3d turned =
      calib::sensor::table_rotation(m.azimuth_rad, m.pitch_rad, m.roll_rad, 0.0, 0.0) *
      at(plan.poses[1].target);
  EXPECT_LT((*recorder.course().poses[1].direction_P - turned).norm(), 1e-9);
}

TEST(CourseRecorder, TheHoleShrinksAndGrowsWithThePoses) {
  Recorded r;
  r.recorder.measured(measured(r.plan.poses[0]));
  const double one = r.recorder.course().hole->radius_rad;
  r.recorder.measured(measured(r.plan.poses[2]));
  const double two = r.recorder.course().hole->radius_rad;
  EXPECT_LT(two, one);
  EXPECT_THAT(r.recorder.course().good_coverage, HasSubstr("with 2 directions"));
  r.recorder.dropped({3});
  EXPECT_EQ(r.recorder.course().hole->radius_rad, one);
  EXPECT_EQ(r.recorder.course().poses[2].state, CourseState::planned);
}

TEST(CourseRecorder, AccuracyIsThatOfEveryFit) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  Recorded r;
  r.recorder.not_known("all about one axis");
  EXPECT_EQ(r.recorder.course().why_unknown, "all about one axis");
  r.recorder.known(2, {kNone, kNone, kNone, kNone, kNone, kNone});
  EXPECT_TRUE(r.recorder.course().accuracy.empty());
  EXPECT_EQ(r.recorder.course().why_unknown, "the array tells no component of the gradient");
  r.recorder.shows(showing(RunState::moving), second(0));
  r.recorder.known(1, {4, 1, 1, 1, kNone, 1});
  const RunCourse course = r.recorder.course();
  ASSERT_EQ(course.accuracy.size(), 1u);
  EXPECT_EQ(course.accuracy[0].worst_nT_per_m, 4);
  EXPECT_TRUE(course.why_unknown.empty());
  EXPECT_THAT(course.good_accuracy, HasSubstr("what was wanted, 2.00 nT/m"));
  EXPECT_EQ(course.good_accuracy.find("the plan"), std::string::npos);
  r.recorder.expects({{2, {}, 5}, {4, {}, 1.5}});
  EXPECT_THAT(r.recorder.course().good_accuracy,
              HasSubstr("The 4 poses of the plan lead one to expect 1.50 nT/m"));
  r.recorder.known(3, {2, 1, 1, 1, kNone, 1});
  r.recorder.known(2, {3, 1, 1, 1, kNone, 1});
  ASSERT_EQ(r.recorder.course().accuracy.size(), 2u) << "one of the three was dropped";
  r.recorder.shows(showing(RunState::done), second(1));
  EXPECT_EQ(r.recorder.course().good_accuracy.find("the plan"), std::string::npos);
}

TEST(CourseRecorder, ParametersHaveTheNamesAndUnitsThatTheyHaveElsewhere) {
  Recorded r;
  r.recorder.known(1, {4, 1, 1, 1, 1, 1});
  EXPECT_TRUE(r.recorder.course().parameters.empty()) << "none are known";
  r.recorder.known(2, {3, 1, 1, 1, 1, 1}, {.parameter_sd = std::vector<double>(48, 0.01)});
  const RunCourse course = r.recorder.course();
  ASSERT_EQ(course.parameters.size(), 48U);
  EXPECT_EQ(course.parameters.front().name, "s1 theta");
  EXPECT_EQ(course.parameters.front().unit, "deg");
  EXPECT_NEAR(course.parameters.front().factor, 180 / std::numbers::pi, 1e-12);
  EXPECT_EQ(course.parameters[3].name, "s1 cx");
  EXPECT_EQ(course.parameters[3].factor, 1);
  EXPECT_EQ(course.parameters.back().name, "s4 gamma");
}

TEST(CourseRecorder, ADisturbanceLastsUntilTheRunGoesOn) {
  Recorded r;
  r.recorder.disturbed(2, {.change_nT = 12, .limit_nT = 0.5}, second(10));
  r.recorder.shows(showing(RunState::suspended), second(10));
  r.recorder.shows(showing(RunState::suspended), second(11));
  RunCourse course = r.recorder.course();
  ASSERT_EQ(course.disturbances.size(), 1u);
  EXPECT_EQ(course.disturbances[0].pose, 2);
  EXPECT_EQ(course.disturbances[0].seen_by, "array");
  EXPECT_FALSE(course.disturbances[0].lasted_s);
  r.recorder.shows(showing(RunState::moving), second(17));
  course = r.recorder.course();
  EXPECT_EQ(course.disturbances[0].lasted_s, 7);
  EXPECT_EQ(course.disturbances[0].then, "pose 2 is measured again");
  r.recorder.shows(showing(RunState::paused), second(30));
  EXPECT_EQ(r.recorder.course().disturbances[0].lasted_s, 7) << "what comes later is not of it";
}

TEST(CourseRecorder, WhatTheRunDidIsToldOfEveryEnd) {
  const auto then = [](RunState state, bool goes_on) {
    Recorded r;
    r.recorder.disturbed(1, {.change_nT = -8, .limit_nT = 5, .seen_by = FieldDisturbance::SeenBy::level},
                         second(0));
    r.recorder.shows(showing(state, goes_on), second(1));
    return r.recorder.course().disturbances[0].then;
  };
  EXPECT_EQ(then(RunState::paused, false), "the run paused");
  EXPECT_EQ(then(RunState::paused, true), "the run waited for a device");
  EXPECT_EQ(then(RunState::aborting, false), "the run was ended");
  EXPECT_EQ(then(RunState::failed, false), "the run was ended");
}

TEST(CourseRecorder, PosesOfALongerPlanAreAdded) {
  Recorded r;
  r.recorder.measured(measured(r.plan.poses[0]));
  r.recorder.extend(mgtd::test::bench_plan(6));
  EXPECT_EQ(r.recorder.course().poses.size(), 6u);
  EXPECT_TRUE(r.recorder.course().poses[5].direction_P);
}

/// Through the text of the run file and back, in another recorder of the same run.
TEST(CourseRecorder, WhatIsKeptIsThereAgain) {
  Recorded r;
  for (std::size_t i = 0; i < 3; ++i) r.recorder.measured(measured(r.plan.poses[i]));
  EXPECT_FALSE(r.recorder.take_unkept()) << "the poses are in the file anyway";
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  r.recorder.known(2, {4, 3, 2, 1, unknown, 6});
  const std::vector<double> parameter_sd(48, 1.23456e-4);
  r.recorder.known(3, {2, 1.5, 1, 0.5, unknown, 3},
                   {.residual_nT = 0.7, .scale_sd = 1e-4, .parameter_sd = parameter_sd});
  r.recorder.disturbed(3, {.change_nT = 7, .limit_nT = 2}, second(10));
  r.recorder.shows(showing(RunState::moving), second(14));
  r.recorder.disturbed(4, {.change_nT = 9, .limit_nT = 2}, second(20));
  const auto kept = r.recorder.take_unkept();
  ASSERT_TRUE(kept);
  EXPECT_FALSE(r.recorder.take_unkept()) << "once";
  const auto read = kept_course_from_json(to_json(*kept).dump());
  ASSERT_TRUE(read) << read.error().text();

  Recorded later;
  for (std::size_t i = 0; i < 3; ++i) later.recorder.measured(measured(later.plan.poses[i]));
  later.recorder.restore(*read);
  const RunCourse course = later.recorder.course();
  ASSERT_EQ(course.accuracy.size(), 2U);
  EXPECT_EQ(course.accuracy[1].poses, 3);
  EXPECT_EQ(course.accuracy[1].worst_nT_per_m, 3);
  EXPECT_TRUE(std::isnan(course.accuracy[1].tensor_sd_nT_per_m.xz));
  EXPECT_EQ(course.accuracy[1].fit.residual_nT, 0.7);
  EXPECT_EQ(course.accuracy[1].fit.scale_sd, 1e-4);
  EXPECT_TRUE(std::isnan(course.accuracy[1].fit.offset_sd_nT));
  EXPECT_EQ(course.accuracy[1].fit.parameter_sd, std::vector<double>(48, 1.235e-4)) << "to four digits";
  EXPECT_TRUE(course.accuracy[0].fit.parameter_sd.empty());
  ASSERT_EQ(course.disturbances.size(), 2U);
  EXPECT_EQ(course.disturbances[0].t, second(10).wall);
  EXPECT_EQ(course.disturbances[0].lasted_s, 4);
  EXPECT_EQ(course.disturbances[0].then, "pose 3 is measured again");
  EXPECT_FALSE(course.disturbances[1].lasted_s);
  EXPECT_THAT(course.disturbances[1].then, HasSubstr("the daemon ended"));
}

/// A pose that was dropped before the daemon ended takes its accuracy along.
TEST(CourseRecorder, AnAccuracyByMorePosesThanThereAreIsNotRestored) {
  Recorded r;
  r.recorder.measured(measured(r.plan.poses[0]));
  r.recorder.restore(
      {.accuracy = {{1, {1, 1, 1, 1, 1, 1}, 1}, {2, {1, 1, 1, 1, 1, 1}, 1}}, .disturbances = {}});
  ASSERT_EQ(r.recorder.course().accuracy.size(), 1U);
  EXPECT_EQ(r.recorder.course().accuracy[0].poses, 1);
}

TEST(CourseRecorder, AKeptCourseOfAnotherKindIsRefused) {
  EXPECT_TRUE(kept_course_from_json(""));
  EXPECT_THAT(kept_course_from_json("{}").error().message, HasSubstr("accuracy"));
  EXPECT_FALSE(kept_course_from_json(R"({"accuracy":[{"poses":1,"sd_nT_per_m":[1]}],"disturbances":[]})"));
  EXPECT_FALSE(kept_course_from_json("[1,"));
}

}  // namespace
}  // namespace mgtd::daemon::run
