// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/simulated_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

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

/// One reading a pose: a length of zero is no measurement, and readers of the table refuse it.
TEST(SimulatedTable, APoseOfASingleReadingHasNoDwell) {
  const PoseTable table = simulated_table(table6(), grid_of_5832(), 1);
  ASSERT_EQ(table.poses.size(), 5832U);
  EXPECT_EQ(table.poses.front().dwell_s, std::nullopt);
  EXPECT_EQ(table.poses.front().n, 1);
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

GrossReading gross(Gross kind, const char* where, double nT = 0) {
  return {kind, 11, 2, *Where::parse(where), nT};
}

TEST(SimulatedTable, WrongReadingsAreThoseThatWereTold) {
  Scenario scenario = table6();
  const Design design = run_of_157({.random = 0, .revisits = 0}, 1);
  const PoseTable right = simulated_table(scenario, design, 1);
  scenario.gross = {gross(Gross::off, "s1.x", 1000), gross(Gross::stuck, "s2"),
                    gross(Gross::saturated, "s3.z")};
  const PoseTable wrong = simulated_table(scenario, design, 1);
  for (std::size_t k = 0; k < wrong.poses.size(); ++k) {
    const Pose &is = wrong.poses[k], &was = right.poses[k];
    const bool spoilt = k == 10 || k == 11;  // poses 11 and 12
    EXPECT_EQ(is.y_nT[0][0], was.y_nT[0][0] + (spoilt ? 1000 : 0));
    EXPECT_EQ(is.y_nT[0][1], was.y_nT[0][1]);
    EXPECT_EQ(is.y_nT[1], spoilt ? right.poses[9].y_nT[1] : was.y_nT[1]);
    EXPECT_EQ(is.y_nT[2][2], spoilt ? std::copysign(100'000.0, was.y_nT[2][2]) : was.y_nT[2][2]);
    EXPECT_EQ(*is.sd_nT[1][0] == 0, spoilt);
  }
}

TEST(SimulatedTable, MeansAreWrittenDownInSteps) {
  Scenario scenario = table6();
  scenario.noise.mean_step_nT = 0.25;
  const PoseTable table = simulated_table(scenario, run_of_157({.random = 5, .revisits = 0}, 1), 1);
  for (const Pose& pose : table.poses)
    for (const Eigen::Vector3d& y_nT : pose.y_nT) EXPECT_EQ(4 * y_nT, (4 * y_nT).array().round().matrix());
}

TEST(SimulatedTable, TheEffectiveNumberCanBeKeptBack) {
  Scenario scenario = table6();
  scenario.noise.ar1_rho = 0.5;
  const Design design = run_of_157({.random = 0, .revisits = 0}, 1);
  EXPECT_NEAR(*simulated_table(scenario, design, 1).poses[0].n_eff, 200.0 / 3, 1e-9);
  scenario.noise.tells_n_eff = false;
  EXPECT_FALSE(simulated_table(scenario, design, 1).poses[0].n_eff.has_value());
}

TEST(SimulatedTable, OneSensorOnEveryConnectorReadsTheSame) {
  Scenario scenario = table6();
  const Design design = run_of_157({.random = 3, .revisits = 0}, 1);
  const PoseTable own = simulated_table(scenario, design, 1);
  scenario.copied = 3;
  const PoseTable table = simulated_table(scenario, design, 1);
  for (std::size_t k = 0; k < table.poses.size(); ++k) {
    EXPECT_EQ(table.poses[k].y_nT[0], own.poses[k].y_nT[2]);
    for (const Eigen::Vector3d& y_nT : table.poses[k].y_nT) EXPECT_EQ(y_nT, table.poses[k].y_nT[0]);
  }
}

TEST(SimulatedTable, SensorsTurnedApartHaveRowsOfOtherPoses) {
  Scenario scenario = table6();
  const Design design = run_of_157({}, 1);
  const PoseTable together = simulated_table(scenario, design, 1);
  scenario.apart = true;
  const PoseTable apart = simulated_table(scenario, design, 1);
  std::vector<double> a, b;
  int stayed = 0;
  for (std::size_t k = 0; k < apart.poses.size(); ++k) {
    EXPECT_EQ(apart.poses[k].y_nT[0], together.poses[k].y_nT[0]);
    stayed += apart.poses[k].y_nT[3] == together.poses[k].y_nT[3] ? 1 : 0;
    a.push_back(apart.poses[k].y_nT[3][0]);
    b.push_back(together.poses[k].y_nT[3][0]);
  }
  std::sort(a.begin(), a.end());
  std::sort(b.begin(), b.end());
  EXPECT_EQ(a, b);
  EXPECT_LT(stayed, 10);
}

TEST(SimulatedTable, OneOctantIsOneOctant) {
  Scenario scenario;  // ideal axes
  scenario.table_accuracy_deg = 0;
  const Design design =
      run_of_157({.standard = false, .random = 157, .octant = scenario.field_direction()}, 1);
  for (const Pose& pose : simulated_table(scenario, design, 1).poses) EXPECT_GT(pose.y_nT[1].minCoeff(), -1);
}

/// By hand: m/d^3 sqrt(1 + 3 cos^2) times 100 nT. Above the centre it is as far from the arm at each azimuth.
TEST(SimulatedTable, AMagnetIsThereFromItsMomentOn) {
  Scenario scenario;
  scenario.noise.noise_nT = 0;
  scenario.table_accuracy_deg = 0;
  const Design design = run_of_157({.random = 0, .revisits = 0}, 1);
  const PoseTable without = simulated_table(scenario, design, 1);
  scenario.magnets = {{.at_s = *without.poses[4].t_s - 3,
                       .until_s = *without.poses[20].t_s + 3,
                       .moment_Am2 = {0, 0, 2},
                       .at_m = {0, 0, -1}}};
  const PoseTable with = simulated_table(scenario, design, 1);
  const double d2 = 1 + 0.2 * 0.2, expected_nT = 200 / std::pow(d2, 1.5) * std::sqrt(1 + 3 / d2);
  for (std::size_t k = 0; k < with.poses.size(); ++k) {
    const double changed_nT = (with.poses[k].y_nT[0] - without.poses[k].y_nT[0]).norm();
    EXPECT_NEAR(changed_nT, k < 4 || k > 20 ? 0 : expected_nT, 1e-6) << k;
  }
}

}  // namespace
}  // namespace mgtd::rig
