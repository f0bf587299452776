// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/identifiability.h"
#include "calib/fit/checks/identifiability_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "calib/fit/joint/joint_fit.h"
#include "tests/unit/calib/fit/simulated_poses.h"

namespace mgtd::calib::fit::joint {
namespace {

using testing::Simulation;

PoseTable at(const Simulation& sim, const std::vector<TableAngles>& poses, std::uint64_t seed) {
  std::mt19937_64 rng(seed);
  PoseTable table;
  for (const TableAngles& angles : poses)
    table.poses.push_back(measure(sim, angles, static_cast<int>(table.poses.size()) + 1, 0, rng));
  return table;
}

/// All azimuths, tilts up to `tilt_deg`: a rig that never turns over.
std::vector<TableAngles> nearly_level(double tilt_deg, int count) {
  std::mt19937_64 rng(5);
  std::uniform_real_distribution<double> tilt(-to_rad(tilt_deg), to_rad(tilt_deg)), turn(-3.1, 3.1);
  std::vector<TableAngles> out;
  for (int k = 0; k < count; ++k) out.push_back({turn(rng), tilt(rng), tilt(rng)});
  return out;
}

Identifiability of(const JointFit& fit, double f_nT) {
  return identifiability(fit.problem, fit.state, reduce(fit.problem, fit.state, 0).S, f_nT);
}

TEST(Identifiability, PosesOverTheSphereLeaveNothingWeak) {
  const Simulation sim{.table_sd_rad = to_rad(0.1)};
  const PoseTable table = simulate(sim, 36, 121, 1);
  const auto fit = fit_joint(table, {});
  ASSERT_TRUE(fit);
  const Identifiability id = of(*fit, sim.f_nT);
  EXPECT_TRUE(id.weak.empty());
  EXPECT_TRUE(id.add.empty());
}

TEST(Identifiability, LevelPosesLeaveTheVerticalWeakAndTheAdvicePays) {
  const Simulation sim{.noise_nT = 3, .table_sd_rad = to_rad(0.1)};
  auto poses = nearly_level(8, 60);
  const PoseTable table = at(sim, poses, 2);
  const auto fit = fit_joint(table, {});
  ASSERT_TRUE(fit) << fit.error().text();
  const Identifiability before = of(*fit, sim.f_nT);
  ASSERT_FALSE(before.weak.empty());
  EXPECT_EQ(checks::to_text(before.weak.front()).rfind("scale z of all sensors", 0), 0U)
      << checks::to_text(before.weak.front());
  EXPECT_NE(checks::to_text(before.coverage).find("platform +Z"), std::string::npos)
      << checks::to_text(before.coverage);
  ASSERT_FALSE(before.add.empty());
  poses.insert(poses.end(), before.add.begin(), before.add.end());
  const PoseTable more = at(sim, poses, 2);
  const auto again = fit_joint(more, {});
  ASSERT_TRUE(again);
  const Identifiability after = of(*again, sim.f_nT);
  EXPECT_LT(after.worst_nT(), before.worst_nT() / 3);
}

TEST(Identifiability, WithoutATableTheAdviceIsADirectionOfTheField) {
  const Simulation sim{.noise_nT = 3, .table_sd_rad = to_rad(0.1)};
  PoseTable table = at(sim, nearly_level(8, 60), 2);
  for (Pose& pose : table.poses) pose.azimuth_rad = pose.pitch_rad = pose.roll_rad = std::nullopt;
  const auto fit = fit_joint(table, {});
  ASSERT_TRUE(fit) << fit.error().text();
  const Identifiability id = of(*fit, sim.f_nT);
  ASSERT_FALSE(id.add.empty());
  for (std::size_t k = 0; k < id.add.size(); ++k)
    for (std::size_t j = 0; j < k; ++j)
      EXPECT_FALSE(id.add[j].azimuth_rad == id.add[k].azimuth_rad &&
                   id.add[j].pitch_rad == id.add[k].pitch_rad && id.add[j].roll_rad == id.add[k].roll_rad)
          << "twice: " << checks::to_text(id.add[k]);
  EXPECT_THAT(checks::additions_text(id.add, false),
              ::testing::StartsWith("hold the array so that the field points along platform "));
  EXPECT_THAT(checks::additions_text(id.add, true), ::testing::StartsWith("add poses: azimuth "));
}

/// By hand, the frame turns and the field stays: at a pitch of 90 degrees a field along +Z lies along -X of
/// the platform, at a roll of 45 degrees half way to +Y. An azimuth leaves it where it is.
TEST(Identifiability, DirectionsOfTheFieldAreWrittenOnce) {
  const double half = to_rad(45), whole = to_rad(90);
  EXPECT_EQ(checks::field_directions_text({{0, 0, 0}, {half, 0, 0}, {0, whole, 0}, {0, 0, half}}),
            "+Z; -X; (0.00, 0.71, 0.71)");
}

}  // namespace
}  // namespace mgtd::calib::fit::joint
