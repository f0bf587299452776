// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/joint_solver.h"

#include <gtest/gtest.h>

#include "calib/fit/joint/joint_setup.h"
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

}  // namespace
}  // namespace mgtd::calib::fit::joint
