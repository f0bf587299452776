// SPDX-License-Identifier: Apache-2.0
#include "daemon/plan/run_plan.h"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "daemon/plan/run_duration.h"
#include "daemon/plan/run_plan_json.h"
#include "proto/units.h"

namespace mgtd::daemon::plan {
namespace {

using drivers::TableLimits;

TableLimits::Range range(double min_deg, double max_deg) { return {to_rad(min_deg), to_rad(max_deg)}; }
TableLimits full_table() { return {range(-180, 180), range(-90, 90), range(-180, 180)}; }

RunPlan plan_of(const PlanOptions& options, const TableLimits& limits = full_table()) {
  const auto plan = make_plan(options, limits);
  EXPECT_TRUE(plan) << (plan ? "" : plan.error().text());
  return plan ? *plan : RunPlan{};
}

std::vector<PlannedPose> of_set(const RunPlan& plan, const std::string& set) {
  std::vector<PlannedPose> poses;
  for (const auto& p : plan.poses) {
    if (p.set == set) poses.push_back(p);
  }
  return poses;
}

int deg(double a_rad) { return static_cast<int>(std::lround(to_deg(a_rad))); }

TEST(RunPlan, TenDegreeSetGoesOutInTwentiesAndComesBackBetween) {
  const auto poses = of_set(plan_of({}), "standard");
  ASSERT_EQ(poses.size(), 36u);
  std::set<int> seen;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_EQ(poses[i].number, static_cast<int>(i) + 1);
    EXPECT_EQ(poses[i].sense, i < 18 ? 1 : -1);
    EXPECT_EQ(poses[i].target.pitch_rad, 0);
    EXPECT_EQ(poses[i].target.roll_rad, 0);
    const int here = deg(poses[i].target.azimuth_rad);
    EXPECT_EQ(here, i < 18 ? -180 + 20 * static_cast<int>(i) : 170 - 20 * static_cast<int>(i - 18));
    seen.insert(here);
  }
  EXPECT_EQ(seen.size(), 36u);
}

TEST(RunPlan, TwentyDegreeSetHasEighteenPoses) {
  PlanOptions options;
  options.step_deg = 20;
  const auto poses = of_set(plan_of(options), "standard");
  ASSERT_EQ(poses.size(), 18u);
  EXPECT_EQ(deg(poses[1].target.azimuth_rad - poses[0].target.azimuth_rad), 40);
  EXPECT_EQ(deg(poses[9].target.azimuth_rad - poses[8].target.azimuth_rad), 20);
}

TEST(RunPlan, TravelThatIsNotAWholeTurnCostsPosesAndSaysSo) {
  TableLimits limits = full_table();
  limits.azimuth = range(-100, 95);
  const auto plan = plan_of({}, limits);
  const auto poses = of_set(plan, "standard");
  EXPECT_EQ(poses.size(), 20u);
  EXPECT_EQ(deg(poses.front().target.azimuth_rad), -100);
  ASSERT_FALSE(plan.notes.empty());
  EXPECT_NE(plan.notes[0].find("20 of 36"), std::string::npos) << plan.notes[0];
}

TEST(RunPlan, RevisitsAreOfEarlierAttitudesAndNeverOfTheOneBefore) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    PlanOptions options;
    options.seed = seed;
    const auto poses = of_set(plan_of(options), "random");
    ASSERT_EQ(poses.size(), 121u);
    int revisits = 0, longs = 0;
    std::set<int> visited_twice;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      longs += poses[i].dwell_s == options.dwell_long_s ? 1 : 0;
      if (!poses[i].revisit_of) continue;
      ++revisits;
      const auto earlier = static_cast<std::size_t>(*poses[i].revisit_of - poses[0].number);
      ASSERT_LT(earlier + 1, i);
      EXPECT_EQ(poses[i].target, poses[earlier].target);
      EXPECT_FALSE(poses[earlier].revisit_of);
      EXPECT_TRUE(visited_twice.insert(*poses[i].revisit_of).second);
    }
    EXPECT_EQ(revisits, 24);
    EXPECT_GT(longs, 30);  // binomial(121, 1/2): below 30 has a probability of 1e-8
    EXPECT_LT(longs, 91);
  }
}

TEST(RunPlan, EvenTheLargestShareOfRevisitsIsKept) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    PlanOptions options;
    options.random = 6;
    options.revisits = 2;
    options.seed = seed;
    int revisits = 0;
    for (const auto& p : plan_of(options).poses) revisits += p.revisit_of ? 1 : 0;
    EXPECT_EQ(revisits, 2) << "seed " << seed;
  }
}

TEST(RunPlan, AttitudesAreUniformOverTheRotations) {
  PlanOptions options;
  options.step_deg = 0;
  options.random = 20'000;
  options.revisits = 0;
  // Under the Haar measure the image of a fixed vector is uniform on the sphere: each coordinate of mean 0
  // and variance 1/3, each coordinate uniform in [-1, 1]. Standard error of a mean 0.577/sqrt(20000) =
  // 0.0041.
  Eigen::Vector3d mean = Eigen::Vector3d::Zero(), square = mean, tail = mean;
  const Eigen::Vector3d b_S = Eigen::Vector3d(0.3, -0.5, 0.8).normalized();
  for (const auto& p : plan_of(options).poses) {
    const auto [az, pitch, roll] = p.target;
    const Eigen::Vector3d x(b_S.x(), std::cos(roll) * b_S.y() + std::sin(roll) * b_S.z(),
                            -std::sin(roll) * b_S.y() + std::cos(roll) * b_S.z());
    const Eigen::Vector3d y(std::cos(pitch) * x.x() - std::sin(pitch) * x.z(), x.y(),
                            std::sin(pitch) * x.x() + std::cos(pitch) * x.z());
    const Eigen::Vector3d b_P(std::cos(az) * y.x() + std::sin(az) * y.y(),
                              -std::sin(az) * y.x() + std::cos(az) * y.y(), y.z());
    mean += b_P / options.random;
    square += b_P.cwiseAbs2() / options.random;
    tail += (b_P.array() > 0.9).cast<double>().matrix() / options.random;
  }
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(mean[i], 0, 4.5 * 0.0041);
    EXPECT_NEAR(square[i], 1.0 / 3, 4.5 * 0.0021);  // sd of u^2, u uniform in [-1,1], is 0.298
    EXPECT_NEAR(tail[i], 0.05, 4.5 * 0.0016);
  }
}

TEST(RunPlan, TheSameSeedGivesTheSamePlanEverywhere) {
  const auto plan = plan_of({});
  EXPECT_EQ(plan, plan_of({}));
  // First random attitude of seed 1, from the definition of mt19937_64 and not from a library's distribution.
  const auto first = of_set(plan, "random")[0].target;
  std::mt19937_64 engine(1);
  for (int i = 0; i < 118; ++i) engine();  // the shuffle of 119 places takes 118 draws
  const auto unit = [&] { return static_cast<double>(engine() >> 11U) / 9007199254740992.0; };
  EXPECT_NEAR(to_deg(first.azimuth_rad), -180 + 360 * unit(), 0.006);
  EXPECT_NEAR(to_deg(first.pitch_rad), to_deg(std::asin(2 * unit() - 1)), 0.006);
  EXPECT_NEAR(to_deg(first.roll_rad), -180 + 360 * unit(), 0.006);
  PlanOptions other;
  other.seed = 2;
  EXPECT_NE(plan.poses, plan_of(other).poses);
}

TEST(RunPlan, NoPoseLeavesTheTableOnAnyTable) {
  std::mt19937_64 engine(20261121);
  const auto draw = [&](double low, double high) {
    return low + (high - low) * static_cast<double>(engine() >> 11U) * 0x1p-53;
  };
  const auto some_range = [&](double most) {
    const double a = draw(-most, most), b = draw(-most, most);
    return range(std::min(a, b), std::max(a, b) + 2);
  };
  for (int trial = 0; trial < 400; ++trial) {
    TableLimits limits{some_range(400), {}, {}};
    if (engine() % 4 != 0) limits.pitch = some_range(200);
    if (engine() % 4 != 0) limits.roll = some_range(400);
    PlanOptions options;
    options.seed = static_cast<std::uint64_t>(trial);
    options.step_deg = engine() % 2 == 0 ? 10 : 20;
    const auto plan = plan_of(options, limits);
    const double eps = 1e-9;  // rad: 400 deg at double precision is 1e-15
    for (const auto& p : plan.poses) {
      ASSERT_GE(p.target.azimuth_rad, limits.azimuth.min_rad - eps);
      ASSERT_LE(p.target.azimuth_rad, limits.azimuth.max_rad + eps);
      ASSERT_GE(p.target.pitch_rad, limits.pitch.min_rad - eps);
      ASSERT_LE(p.target.pitch_rad, limits.pitch.max_rad + eps);
      ASSERT_GE(p.target.roll_rad, limits.roll.min_rad - eps);
      ASSERT_LE(p.target.roll_rad, limits.roll.max_rad + eps);
    }
    const auto again = plan_from_json(to_json(plan).dump());
    ASSERT_TRUE(again) << again.error().text();
    ASSERT_EQ(*again, plan);
  }
}

TEST(RunPlan, AnAzimuthTableGetsAPlanAndTheWordsWhatItLacks) {
  const auto plan = plan_of({}, {range(-180, 180), {}, {}});
  EXPECT_EQ(plan.poses.size(), 157u);
  ASSERT_EQ(plan.notes.size(), 1u);
  EXPECT_NE(plan.notes[0].find("one axis only"), std::string::npos);
  EXPECT_NE(describe(plan, {}).find("one axis only"), std::string::npos);
}

TEST(RunPlan, ASetThatIsLeftOutIsMissedInWords) {
  EXPECT_TRUE(plan_of({}).notes.empty());
  EXPECT_NE(describe(plan_of({.step_deg = 0}), {}).find("no standard set"), std::string::npos);
  EXPECT_NE(describe(plan_of({.random = 0, .revisits = 0}), {}).find("0 random poses"), std::string::npos);
}

TEST(RunPlan, OptionsThatMakeNoPlanAreRefusedWithTheReason) {
  const auto refused = [](PlanOptions options, const std::string& word) {
    const auto plan = make_plan(options, full_table());
    ASSERT_FALSE(plan);
    EXPECT_NE(plan.error().message.find(word), std::string::npos) << plan.error().message;
    EXPECT_FALSE(plan.error().remedy.empty());
  };
  refused({.step_deg = 7}, "step");
  refused({.step_deg = 24}, "step");  // 15 poses: the halves would differ in number
  refused({.step_deg = std::nan("")}, "step");
  refused({.random = -1}, "random");
  refused({.random = 20, .revisits = 10}, "revisits");
  refused({.dwell_short_s = 0}, "dwells");
  refused({.dwell_short_s = 9}, "dwells");
  EXPECT_FALSE(make_plan({}, {{}, range(-90, 90), range(-180, 180)}));
}

TEST(RunPlan, DurationCountsTravelSettlingAndDwell) {
  RunPlan plan;
  plan.poses = {{1, "random", {0, 0, 0}, 4, 0, {}}, {2, "random", {to_rad(10), to_rad(-30), 0}, 8, 0, {}}};
  const Pace pace{
      .velocity_rad_per_s = to_rad(10), .per_move_s = 1, .settle_s = 2, .home_s = 20, .solve_s = 1};
  EXPECT_NEAR(total_s(pace, plan), 20 + (1 + 2 + 4) + (1 + 3 + 2 + 8) + 1, 1e-9);
}

TEST(RunPlan, TextThatIsNoPlanIsRefused) {
  for (const char* text : {"", "{}", "[1]", R"({"schema":"mgtd.plan/1"})", R"({"schema":"mgtd.plan/2"})"}) {
    const auto plan = plan_from_json(text);
    ASSERT_FALSE(plan);
    EXPECT_EQ(plan.error().code, ErrorCode::bad_input);
  }
}

}  // namespace
}  // namespace mgtd::daemon::plan
