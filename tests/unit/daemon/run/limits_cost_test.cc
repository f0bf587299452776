// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/limits_cost.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "daemon/run/planned_poses.h"
#include "proto/units.h"

namespace mgtd::daemon::run {
namespace {

using drivers::TableLimits;
using ::testing::HasSubstr;

TableLimits limits(double azimuth_deg, double pitch_deg, double roll_deg) {
  return {{to_rad(-azimuth_deg), to_rad(azimuth_deg)},
          {to_rad(-pitch_deg), to_rad(pitch_deg)},
          {to_rad(-roll_deg), to_rad(roll_deg)}};
}

TEST(LimitsCost, TheShareOfAttitudesIsThatOfRotations) {
  EXPECT_NEAR(attitudes_left_out(limits(180, 90, 180)), 0, 1e-12);
  EXPECT_NEAR(attitudes_left_out(limits(360, 180, 200)), 0, 1e-12) << "further turns bring no new attitude";
  EXPECT_NEAR(attitudes_left_out(limits(180, 90, 90)), 0.5, 1e-12);
  EXPECT_NEAR(attitudes_left_out(limits(180, 30, 180)), 0.5, 1e-12) << "sin 30 deg";
  EXPECT_NEAR(attitudes_left_out(limits(135, 30, 90)), 1 - 0.75 * 0.5 * 0.5, 1e-12);
  EXPECT_NEAR(attitudes_left_out(limits(180, 90, 0)), 0, 1e-12) << "an axis that is not there is no limit";
}

TEST(LimitsCost, ATableThatReachesEverythingCostsNothing) {
  const auto cost = limits_cost({.step_deg = 20, .random = 30, .revisits = 4}, limits(180, 90, 180), {});
  ASSERT_TRUE(cost) << cost.error().text();
  EXPECT_FALSE(*cost);
}

/// The standard errors are those that the plan of either list gives by itself.
TEST(LimitsCost, SaysHowMuchLargerEveryErrorIsAndWhatToDo) {
  const plan::PlanOptions options{.step_deg = 20, .random = 40, .revisits = 4};
  const auto cost = limits_cost(options, limits(180, 90, 60), {});
  ASSERT_TRUE(cost) << cost.error().text();
  ASSERT_TRUE(*cost);
  const LimitsCost& c = **cost;
  ASSERT_EQ(c.axes.size(), 1U);
  EXPECT_EQ(c.axes[0].name, "roll");
  EXPECT_NEAR(c.left_out, 2 / 3.0, 1e-12);
  ASSERT_EQ(c.groups.size(), 5U);
  const auto offsets_nT = [&](const TableLimits& table) {
    calib::design::DesignRequest request;
    request.power = false;
    request.poses = *planned_poses(options, table);
    const auto report = calib::design::evaluate_design(request);
    double sum = 0;
    for (const calib::design::Expected& e : report->parameters)
      if (e.unit == "nT") sum += e.sd * e.sd;
    return std::sqrt(sum / 12);
  };
  EXPECT_EQ(c.groups[3].name, "offsets");
  EXPECT_NEAR(c.groups[3].within, offsets_nT(limits(180, 90, 60)), 1e-9);
  EXPECT_NEAR(c.groups[3].without, offsets_nT(limits(180, 90, 180)), 1e-9);
  EXPECT_GT(c.groups[0].times(), 1.05) << "fewer directions of the field";
  const std::string text = to_text(c);
  EXPECT_THAT(text, HasSubstr("limits of the table: roll -60 to 60 deg; 67 % of all attitudes are left out"));
  EXPECT_THAT(text, HasSubstr("what to do: widen limits.roll in [table]"));
  const nlohmann::json json = to_json(c);
  EXPECT_EQ(json["axes"][0]["axis"], "roll");
  EXPECT_EQ(json["groups"][0]["name"], "tensor");
  EXPECT_NEAR(json["groups"][0]["times"].get<double>(), c.groups[0].times(), 1e-12);
}

}  // namespace
}  // namespace mgtd::daemon::run
