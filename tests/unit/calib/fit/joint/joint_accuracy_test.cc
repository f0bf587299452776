// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "calib/effects/library/library.h"
#include "calib/fit/joint/joint_fit.h"
#include "tests/unit/calib/fit/tensor_error.h"

namespace mgtd::calib::fit::joint {
namespace {

using testing::Components;
using testing::Simulation;

struct Accuracy {
  Components rms, bound;  ///< nT/m: over all runs, and Cramer-Rao
};

/// Information at the truth, with the true weights: what no unbiased estimate can beat.
Eigen::MatrixXd bound(const Simulation& sim, const PoseTable& table, JointOptions options) {
  options.table_sd_rad = sim.table_sd_rad;
  JointProblem problem = *joint_problem(table, options);
  fix_gauge(problem, options);
  const double ci = std::cos(sim.inclination_rad);
  const Eigen::Vector3d n{ci * std::cos(sim.declination_rad), ci * std::sin(sim.declination_rad),
                          std::sin(sim.inclination_rad)};
  const JointState truth = joint_state(problem, sim.rig, n, sim.f_nT);
  return *covariance_of(reduce(problem, truth, 0).S);
}

Accuracy accuracy(Simulation sim, int poses, int runs, bool with_gradient) {
  JointOptions options;
  if (with_gradient) {
    sim.G_nT_per_m = testing::gradient_50();
    options.effects = {*effects::library::make_effect("site.gradient")};
  }
  const auto fields = testing::clean_fields(sim.f_nT, 200, 4242);
  Accuracy out{Components::Zero(), Components::Zero()};
  for (int run = 0; run < runs; ++run) {
    const PoseTable table =
        simulate(sim, poses * 36 / 157, poses - poses * 36 / 157, 1000 + static_cast<std::uint64_t>(run));
    const auto fit = fit_joint(table, options);
    if (!fit) throw std::runtime_error(fit.error().text());
    out.rms += testing::tensor_mean_square(fit->state.sensors, sim.rig, fields) / runs;
    if (run % 10 == 0)
      out.bound += testing::expected_mean_square(bound(sim, table, options), sim.rig, fields) * 10.0 / runs;
  }
  out.rms = out.rms.sqrt();
  out.bound = out.bound.sqrt();
  return out;
}

class TensorAccuracy : public ::testing::TestWithParam<std::tuple<int, bool>> {};

TEST_P(TensorAccuracy, IsWithinTenPercentOfTheCramerRaoBound) {
  const auto [poses, with_gradient] = GetParam();
  const Simulation sim{.table_sd_rad = to_rad(0.1), .f_sd_nT = 0.05};
  // The rms over 100 runs of about 10 independent errors each scatters by 100^-0.5 / sqrt(20) = 2 %.
  const Accuracy a = accuracy(sim, poses, 100, with_gradient);
  RecordProperty("worst_rms_nT_per_m", std::to_string(a.rms.maxCoeff()));
  EXPECT_LT((a.rms / a.bound).maxCoeff(), 1.10);
  EXPECT_GT((a.rms / a.bound).minCoeff(), 0.85);
}

INSTANTIATE_TEST_SUITE_P(Poses, TensorAccuracy,
                         ::testing::Combine(::testing::Values(100, 157), ::testing::Bool()));

}  // namespace
}  // namespace mgtd::calib::fit::joint
