// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/joint_solver.h"

#include <gtest/gtest.h>

#include "calib/fit/joint/joint_cost.h"
#include "calib/fit/joint/joint_setup.h"
#include "calib/linear/parts.h"
#include "tests/unit/calib/fit/simulated_poses.h"

namespace mgtd::calib::fit::joint {
namespace {

using testing::Simulation;

TEST(JointSolver, NoiseFreePosesGiveTheTruthBack) {
  const Simulation sim{.rig = testing::table3_rig(), .noise_nT = 0, .f_drift_nT = 30};
  const PoseTable table = simulate(sim, 36, 121, 1);
  const JointOptions options;
  auto problem = joint_problem(table, options);
  ASSERT_TRUE(problem) << problem.error().text();
  fix_gauge(*problem, options);
  auto start = joint_start(*problem, start_field_nT(*problem, options));
  ASSERT_TRUE(start) << start.error().text();
  const auto solution = solve(*problem, *start);
  ASSERT_TRUE(solution) << solution.error().text();
  EXPECT_LT(solution->reduced.cost.total(), 1e-6);
  for (std::size_t i = 0; i < kSensors; ++i) {
    const sensor::ParameterVector error = solution->state.sensors[i].parameters() - sim.rig[i].parameters();
    // Rounding of 5e4 nT readings through a condition of about 1e4.
    EXPECT_LT(error.head<3>().norm() + error.segment<3>(sensor::cx).norm() + error.tail<3>().norm(), 1e-8)
        << "sensor " << i + 1;
    EXPECT_LT(error.segment<3>(sensor::ix).norm(), 1e-4) << "sensor " << i + 1;
  }
  EXPECT_LE(solution->iterations, 6);
}

/// Poses add up, whatever parts the sums are taken over; priors count once.
TEST(JointSolver, ManyPosesAreReducedAsPiecesOfThemAre) {
  const PoseTable table = simulate({.rig = testing::table3_rig(), .noise_nT = 0.1}, 36, 2400, 2);
  const JointOptions options;
  auto problem = joint_problem(table, options);
  ASSERT_TRUE(problem) << problem.error().text();
  fix_gauge(*problem, options);
  const auto state = joint_start(*problem, start_field_nT(*problem, options));
  ASSERT_TRUE(state) << state.error().text();
  const auto reduced = [&](std::size_t from, std::size_t to) {
    JointProblem part = *problem;
    JointState of_part = *state;
    const auto range = [from, to](auto& all) {
      all = {all.begin() + static_cast<std::ptrdiff_t>(from), all.begin() + static_cast<std::ptrdiff_t>(to)};
    };
    range(part.poses), range(of_part.nuisances);
    return reduce(part, of_part, 0);
  };
  const std::size_t n = problem->poses.size(), piece = 700;
  ASSERT_GT(linear::parts_of_poses(n), 2U);
  const Reduced priors = reduced(0, 0), all = reduced(0, n);
  Reduced sum = priors;
  double cost = 0, decrease = 0;
  for (std::size_t from = 0; from < n; from += piece) {
    const Reduced part = reduced(from, std::min(n, from + piece));
    sum.S += part.S - priors.S, sum.g += part.g - priors.g;
    cost += part.cost.readings, decrease += part.predicted_decrease;
  }
  EXPECT_LT((all.S - sum.S).norm(), 1e-12 * all.S.norm());
  EXPECT_LT((all.g - sum.g).norm(), 1e-9 * all.g.norm());
  EXPECT_NEAR(all.cost.readings, cost, 1e-12 * cost);
  EXPECT_NEAR(all.predicted_decrease, decrease, 1e-9 * decrease);
  EXPECT_EQ(all.cost.total(), cost_of(*problem, *state).total());
}

}  // namespace
}  // namespace mgtd::calib::fit::joint
