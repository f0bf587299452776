// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/simulated_table.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/rig/effect_list.h"
#include "tests/rig/pose_writer.h"
#include "tests/rig/rotations.h"

namespace mgtd::rig {
namespace {

Scenario table6() {
  Scenario scenario;
  scenario.truth = *rig_named("table6", 1);
  return scenario;
}

TEST(SimulatedTable, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const Design design = run_of_157({}, 1);
  EXPECT_EQ(design.poses.size(), 157U);
  const std::string a = pose_table_csv(simulated_table(table6(), design, 1));
  EXPECT_EQ(a, pose_table_csv(simulated_table(table6(), design, 1)));
  EXPECT_NE(a, pose_table_csv(simulated_table(table6(), design, 2)));
}

/// The drawn means are those that samples would have given: same truth, and the same scatter about it.
TEST(SimulatedTable, MeansScatterAsSamplesDo) {
  Scenario scenario = table6();
  scenario.table_accuracy_deg = 0;
  scenario.noise.slow_nT = 0.2;
  scenario.noise.slow_tau_s = 3;
  Scenario quiet = scenario;
  quiet.noise = {.noise_nT = 0};
  const Design design = run_of_157({.dwells_s = {4}}, 1);
  const PoseTable truth = simulated_table(quiet, design, 1);
  std::array<double, 2> squares{}, spread{};
  constexpr int kRuns = 4;
  for (int run = 0; run < kRuns; ++run) {
    for (const Sampling sampling : {Sampling::means, Sampling::samples}) {
      const auto which = static_cast<std::size_t>(sampling);
      const PoseTable table = simulated_table(scenario, design, static_cast<std::uint64_t>(run), sampling);
      for (std::size_t k = 0; k < 157; ++k) {
        for (std::size_t i = 0; i < 4; ++i) {
          squares.at(which) += (table.poses[k].y_nT.at(i) - truth.poses[k].y_nT.at(i)).squaredNorm();
          spread.at(which) += *table.poses[k].sd_nT.at(i)[0] * *table.poses[k].sd_nT.at(i)[0];
        }
      }
    }
  }
  // 7536 numbers each, the slow part correlated: 2.5 % one sigma of the ratio of variances.
  EXPECT_NEAR(squares[0] / squares[1], 1, 0.1);
  EXPECT_NEAR(spread[0] / spread[1], 1, 0.02);
}

TEST(SimulatedTable, ADwellThatDriftsIsAveraged) {
  Scenario scenario = table6();
  scenario.noise.noise_nT = 0;
  scenario.table_accuracy_deg = 0;
  scenario.effects.push_back(*effect_of("name = 'axis.offset.drift'\nwhere = 's1.x'\nnT_per_h = 3600"));
  Scenario still = scenario;
  still.effects.clear();
  const Design design = run_of_157({.random = 0, .revisits = 0}, 1);
  const PoseTable a = simulated_table(scenario, design, 1), b = simulated_table(still, design, 1);
  for (std::size_t k = 0; k < a.poses.size(); ++k)
    EXPECT_NEAR(a.poses[k].y_nT[0][0] - b.poses[k].y_nT[0][0], *a.poses[k].t_s, 1e-6);  // 1 nT a second
}

TEST(SimulatedTable, TheTableComesFromTheSideItWasTold) {
  const Design design = run_of_157({.standard = false, .senses = true}, 3);
  const PoseTable table = simulated_table(table6(), design, 1);
  for (std::size_t k = 0; k < table.poses.size(); ++k) EXPECT_EQ(table.poses[k].sense, design.poses[k].sense);
}

/// What is recorded of a remounted array is where the platform points.
TEST(SimulatedTable, RemountedAnglesAreThePlatforms) {
  Scenario scenario;
  scenario.noise.noise_nT = 0;
  scenario.table_accuracy_deg = 0;
  const Design design =
      remounted_turns({Eigen::Matrix3d::Identity(), about_x(90), about_x(30) * about_y(40)}, 6, 1);
  const PoseTable table = simulated_table(scenario, design, 1);
  const double I = scenario.inclination_deg * kDeg, D = scenario.declination_deg * kDeg;
  const Eigen::Vector3d B =
      scenario.f_nT * Eigen::Vector3d(std::cos(I) * std::cos(D), std::cos(I) * std::sin(D), std::sin(I));
  ASSERT_EQ(table.poses.size(), 18U);
  for (const Pose& pose : table.poses) {
    const Eigen::Vector3d b = about_z(*pose.azimuth_rad / kDeg) * about_y(*pose.pitch_rad / kDeg) *
                              about_x(*pose.roll_rad / kDeg) * B;
    EXPECT_LT((pose.y_nT[2] - b).norm(), 1e-6);
    EXPECT_TRUE(pose.mount.has_value());
  }
}

TEST(SimulatedTable, SwappedConnectorsSwapReadings) {
  Scenario scenario = table6();
  scenario.noise.noise_nT = 0;
  const Design design = run_of_157({.random = 0, .revisits = 0}, 1);
  const PoseTable right = simulated_table(scenario, design, 1);
  scenario.wiring = {2, 1, 3, 4};
  const PoseTable wrong = simulated_table(scenario, design, 1);
  EXPECT_EQ(right.poses[5].y_nT[0], wrong.poses[5].y_nT[1]);
  EXPECT_EQ(right.poses[5].y_nT[3], wrong.poses[5].y_nT[3]);
}

}  // namespace
}  // namespace mgtd::rig
