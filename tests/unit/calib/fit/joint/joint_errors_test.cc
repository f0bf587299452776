// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/joint_errors.h"

#include <gtest/gtest.h>

#include "calib/calibration/array_model.h"
#include "calib/effects/library/library.h"
#include "calib/fit/joint/joint_cost.h"
#include "calib/fit/joint/pose_residuals.h"
#include "calib/fit/joint/single_samples.h"
#include "calib/fit/joint/without_poses.h"
#include "calib/fit/method_choice/fit.h"
#include "tests/unit/calib/fit/arrays_of_any_size.h"
#include "tests/unit/calib/fit/simulated_poses.h"

namespace mgtd::calib::fit::joint {
namespace {

using testing::Simulation;

Simulation with_gradient() {
  Simulation sim{.table_sd_rad = to_rad(0.02), .f_sd_nT = 0.05};
  sim.G_nT_per_m = testing::gradient_50();
  return sim;
}

TEST(JointErrors, NoiseOnlyStaysNoiseOutOfSample) {
  const Simulation sim{.table_sd_rad = to_rad(0.1), .f_sd_nT = 0.05};
  const PoseTable table = simulate(sim, 36, 121, 31);
  const auto fit = fit_joint(table, {});
  ASSERT_TRUE(fit);
  const JointErrors in = joint_errors(fit->problem, fit->state, FixedBlock::fitted);
  const auto out = held_out_errors(*fit, reduce(fit->problem, fit->state, 0));
  ASSERT_TRUE(out);
  // 45 parameters on 1500 degrees of freedom cost some 3 % twice.
  EXPECT_GT(out->residual_nT, in.residual_nT);
  EXPECT_LT(out->residual_nT, 1.1 * in.residual_nT);
  // Noise of one nT on the two sensors of a difference 0.4 m apart, both of scale near one: 3.5 nT/m.
  EXPECT_NEAR(out->summary.tensor_rmse_nT_per_m.xx, 3.6, 0.5);
  EXPECT_NEAR(out->summary.total_field_rmse_nT[0], 1.0, 0.25);
}

/// Of a recording the folds are left out in one step; here each is fitted without its samples.
TEST(JointErrors, OneStepLeavesAFoldOutAsFittingWithoutItDoes) {
  const PoseTable table = testing::recorded("hand", 0, 7);
  JointOptions options;
  options.geometry = testing::geometry_of(testing::one_sensor());
  const auto fit = fit_joint(table, options);
  ASSERT_TRUE(fit) << fit.error().text();
  ASSERT_TRUE(is_recording(fit->problem));
  const auto in_one_step = held_out_errors(*fit, reduce(fit->problem, fit->state, 0));
  ASSERT_TRUE(in_one_step);
  const std::size_t n = fit->problem.poses.size();
  double squares = 0, freedom = 0;
  for (std::size_t fold = 0; fold < kFolds; ++fold) {
    JointProblem others = without_poses(fit->problem), own = others;
    JointState others_state = without_poses(fit->state), own_state = others_state;
    for (std::size_t k = 0; k < n; ++k) {
      const bool inside = k >= fold * n / kFolds && k < (fold + 1) * n / kFolds;
      (inside ? own : others).poses.push_back(fit->problem.poses[k]);
      (inside ? own_state : others_state).nuisances.push_back(fit->state.nuisances[k]);
    }
    auto solved = solve(others, others_state);
    ASSERT_TRUE(solved);
    solved->state.nuisances = own_state.nuisances;
    refit_nuisances(own, solved->state);
    const PoseResiduals residuals = pose_residuals(own, solved->state);
    squares += residuals.squares_nT2, freedom += residuals.freedom;
  }
  const double fitted_each = std::sqrt(squares / freedom);
  EXPECT_NEAR(in_one_step->residual_nT, fitted_each, 1e-5 * fitted_each);
  EXPECT_GT(in_one_step->residual_nT, joint_errors(fit->problem, fit->state, FixedBlock::fitted).residual_nT);
}

TEST(JointErrors, TheCostAloneIsThatOfTheNormalEquations) {
  Simulation sim{.table_sd_rad = to_rad(0.1), .f_sd_nT = 0.05};
  for (const bool with_f : {true, false}) {
    sim.with_f = with_f;
    const auto fit = fit_joint(simulate(sim, 36, 121, 31), {});
    ASSERT_TRUE(fit) << fit.error().text();
    const JointCost alone = cost_of(fit->problem, fit->start), all = reduce(fit->problem, fit->start, 0).cost;
    EXPECT_GT(all.total(), 0);
    EXPECT_EQ(alone.total(), all.total());
    EXPECT_EQ(alone.attitude, all.attitude);
    EXPECT_EQ(alone.priors, all.priors);
  }
}

/// Fifty nanotesla on one reading of 157 poses would be 4 nT rms of that sensor.
TEST(JointErrors, AReadingThatIsLeftOutCountsInNoRow) {
  const Simulation sim{.table_sd_rad = to_rad(0.1), .f_sd_nT = 0.05};
  PoseTable table = simulate(sim, 36, 121, 31);
  table.poses[60].y_nT[3][2] += 50;
  const auto report = method_choice::fit(table, {});
  ASSERT_TRUE(report);
  ASSERT_EQ(report->outliers.size(), 1U);
  for (const auto& row : {report->after, *report->held_out, *report->two_step}) {
    EXPECT_LT(row.total_field_rmse_nT[3], 1.5);
    EXPECT_LT(row.tensor_rmse_nT_per_m.xx, 5);
  }
}

TEST(JointFit, AnAxisThatReadsTheSameInEveryPoseIsCalledDead) {
  PoseTable table = simulate(Simulation{}, 36, 40, 31);
  for (Pose& pose : table.poses) pose.y_nT[1][1] = 123.5;
  const auto refused = method_choice::fit(table, {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message,
            "sensor 2: its axis y reads 123.500 nT in every pose: it is dead or stuck");
}

TEST(JointErrors, MissingGradientShowsOutOfSampleAndItsTermTakesItAway) {
  const PoseTable table = simulate(with_gradient(), 36, 121, 33);
  JointOptions options;
  const auto without = fit_joint(table, options);
  options.effects = {*effects::library::make_effect("site.gradient")};
  const auto with = fit_joint(table, options);
  ASSERT_TRUE(without && with);
  const auto before = held_out_errors(*without, reduce(without->problem, without->state, 0)),
             after = held_out_errors(*with, reduce(with->problem, with->state, 0));
  ASSERT_TRUE(before && after);
  EXPECT_GT(before->residual_nT, 2.5);
  EXPECT_LT(after->residual_nT, 1.1);
  EXPECT_GT(before->summary.tensor_rmse_nT_per_m.xx, 20);
  EXPECT_LT(after->summary.tensor_rmse_nT_per_m.xx, 4.2);
}

/// y += c v^2 / 5e4 on one axis, b += c g on the platform.
class Bend final : public effects::EffectOf<Bend> {
 public:
  explicit Bend(effects::Level level) : level_(level), coefficients_(1, {.name = "c", .unit = "nT"}) {}
  [[nodiscard]] std::string_view name() const override { return "bend"; }
  [[nodiscard]] effects::Level level() const override { return level_; }
  [[nodiscard]] const std::vector<effects::Coefficient>& coefficients() const override {
    return coefficients_;
  }
  [[nodiscard]] std::span<const int> at(int) const override { return at_; }
  [[nodiscard]] std::string_view missing(const Pose&) const override { return {}; }
  template <class S>
  void equation(const effects::Conditions&, int, std::span<const S> in, std::span<const S> c,
                std::span<S> out) const {
    for (std::size_t o = 0; o < out.size(); ++o) out[o] = c[0] * in[o] * in[o] * (1 / 2.5e9);
    if (level_ == effects::Level::platform) out[0] = out[0] + c[0] * in[3];
  }

 private:
  effects::Level level_;
  std::vector<effects::Coefficient> coefficients_;
  std::vector<int> at_{0};
};

TEST(ArrayModel, CorrectUndoesEveryInstrumentEffect) {
  Simulation sim{.noise_nT = 0};
  const PoseTable table = simulate(sim, 12, 20, 35);
  JointOptions options;
  options.effects = {std::make_shared<const Bend>(effects::Level::axis),
                     std::make_shared<const Bend>(effects::Level::platform),
                     *effects::library::make_effect("site.gradient")};
  auto problem = joint_problem(table, options);
  ASSERT_TRUE(problem);
  JointState state = joint_state(*problem, sim.rig, {0, 0.6, 0.8}, sim.f_nT);
  state.coefficients << 40, 25, 30, -45, -20, 50, 10;
  const calibration::ArrayModel array(state.sensors, problem->geometry, problem->effects, state.coefficients);
  const JointPose& pose = problem->poses[20];
  PoseLinear linear;
  PoseModel(*problem, state).linearise(pose, Nuisance(0, 0, 0, 50'000), linear);
  const effects::Conditions at{*pose.pose, 0, nullptr};
  const sensor::FieldVector b = array.correct(at, linear.y_nT, pose.T) - array.site_field(at, pose.T);
  for (int i = 0; i < kSensors; ++i) {
    // Rounding of 5e4 nT, and the fixed point's 1e-9.
    EXPECT_LT((b.segment<3>(3 * i) - pose.T * Eigen::Vector3d(0, 30'000, 40'000)).norm(), 1e-8);
  }
}

}  // namespace
}  // namespace mgtd::calib::fit::joint
