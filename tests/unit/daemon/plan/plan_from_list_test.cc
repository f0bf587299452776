// SPDX-License-Identifier: Apache-2.0
#include "daemon/plan/plan_from_list.h"
#include "calib/report/next_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "calib/criticism/search/next_pair.h"
#include "daemon/plan/run_duration.h"
#include "daemon/plan/run_plan_json.h"
#include "proto/units.h"

namespace mgtd::daemon::plan {
namespace {

using ::testing::HasSubstr;

drivers::TableLimits limits() {
  return {{to_rad(-180), to_rad(180)}, {to_rad(-90), to_rad(90)}, {to_rad(-90), to_rad(90)}};
}

/// As mgt run start --poses does it: read, sent as JSON, read by the daemon, planned.
Result<RunPlan> plan_of(const std::string& text, const PlanOptions& options = {}) {
  const auto list = calib::poses::read_pose_list(text, "poses.csv");
  if (!list) return tl::unexpected(list.error());
  RunRequest request;
  request.list = "poses.csv";
  request.poses = requested_poses(*list);
  const auto received = parse_run_request(to_json(request));
  if (!received) return tl::unexpected(received.error());
  EXPECT_EQ(*received, request);
  return plan_from_list(*received, options, limits());
}

Pose pose(double azimuth_deg, double pitch_deg, double roll_deg) {
  Pose out;
  out.set = "random";
  out.azimuth_rad = to_rad(azimuth_deg);
  out.pitch_rad = to_rad(pitch_deg);
  out.roll_rad = to_rad(roll_deg);
  return out;
}

TEST(ListedPlan, WhatMgtNextWritesIsARun) {
  Pose first = pose(12.34, -45, 80), second = pose(270, 0, 0);
  first.sense = -1;
  first.dwell_s = 6;
  first.since_stop_s = 30;
  const auto plan =
      plan_of(calib::report::pose_list({.measurement = {}, .by_the_rig = true, .poses = {first, second}}));
  ASSERT_TRUE(plan) << plan.error().text();
  ASSERT_EQ(plan->poses.size(), 2U);
  EXPECT_EQ(plan->poses[0].number, 1);
  EXPECT_NEAR(to_deg(plan->poses[0].target.azimuth_rad), 12.34, 1e-6);
  EXPECT_EQ(plan->poses[0].sense, -1);
  EXPECT_EQ(plan->poses[0].dwell_s, 6);
  EXPECT_EQ(plan->poses[0].since_stop_s, 30);
  EXPECT_NEAR(to_deg(plan->poses[1].target.azimuth_rad), -90, 1e-6) << "270 degrees, within the travel";
  EXPECT_EQ(plan->poses[1].dwell_s, PlanOptions{}.dwell_short_s) << "the configuration's";
  const auto kept = plan_from_json(to_json(*plan).dump());
  ASSERT_TRUE(kept) << kept.error().text();
  EXPECT_EQ(*kept, *plan) << "a killed daemon goes on with the list";
  EXPECT_THAT(describe(*plan, Pace{}), HasSubstr("2 poses of poses.csv, in its order"));
}

TEST(ListedPlan, WhatAHandHasToDoComesWithThePose) {
  const std::string action = "a heat pulse, slow: warm the heads by 5 degC and let them cool again";
  const auto plan = plan_of(calib::report::pose_list(
      {.measurement = {.action = action}, .by_the_rig = false, .poses = {pose(0, 0, 0), pose(10, 0, 0)}}));
  ASSERT_TRUE(plan) << plan.error().text();
  EXPECT_EQ(plan->poses[0].note, "a heat pulse; slow: warm the heads by 5 degC and let them cool again");
  EXPECT_EQ(plan->poses[1].note, "");
  const auto kept = plan_from_json(to_json(*plan).dump());
  ASSERT_TRUE(kept) << kept.error().text();
  EXPECT_EQ(*kept, *plan);
}

TEST(ListedPlan, WhatCannotBeMeasuredIsRefusedWithItsPlace) {
  const std::string header = "# made by hand\npose,azimuth_deg,pitch_deg,roll_deg,dwell_s\n1,0,0,0,4\n";
  const auto message = [&](const std::string& rows) {
    const auto plan = plan_of(header + rows);
    return plan ? std::string("accepted") : plan.error().text();
  };
  EXPECT_THAT(message("7,0,95,0,4\n"),
              HasSubstr("poses.csv:4: column pitch_deg: 95 deg is outside the table's "
                        "limits, -90 to 90 deg"));
  EXPECT_THAT(message("7,0,x,0,4\n"), HasSubstr("poses.csv:4:5: 'x' in column pitch_deg is not a number"));
  EXPECT_THAT(message("1,0,5,0,4\n"), HasSubstr("poses.csv:4:1: pose 1 was already given in line 3"));
  EXPECT_THAT(message("7,0,,0,4\n"), HasSubstr("poses.csv:4:5: pitch_deg is empty"));
  EXPECT_THAT(message("7,0,0,0,0.1\n"),
              HasSubstr("line 4 of the list of poses: dwell_s = 0.1 is not possible"));
  EXPECT_THAT(message("7,0,0,0\n"), HasSubstr("poses.csv:4:1: 4 cells"));
  EXPECT_EQ(message("7,0,0,0,5\n"), "accepted");
}

TEST(ListedPlan, AListThatBypassedTheFileIsCheckedToo) {
  RunRequest request;
  request.poses = {{.number = 3}, {.number = 3}};
  const auto twice = plan_from_list(request, {}, limits());
  ASSERT_FALSE(twice);
  EXPECT_THAT(twice.error().message, HasSubstr("3 was already given"));
  PlanOptions mounted;
  mounted.mounts = {{}};
  request.poses = {{.number = 3}};
  EXPECT_FALSE(plan_from_list(request, mounted, limits()));
  EXPECT_TRUE(plan_from_list(request, {}, limits()));
}

TEST(ListedPlan, PosesAndSetsExcludeOneAnother) {
  RunRequest request;
  request.poses = {{.number = 1}};
  request.random = 30;
  const auto both = parse_run_request(to_json(request));
  ASSERT_FALSE(both);
  EXPECT_THAT(both.error().message, HasSubstr("the poses are given"));
}

}  // namespace
}  // namespace mgtd::daemon::plan
