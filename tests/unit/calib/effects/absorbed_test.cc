// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <Eigen/Dense>

#include "calib/effects/library/effect_family.h"
#include "calib/effects/library/library.h"
#include "calib/fit/joint/joint_fit.h"
#include "tests/unit/calib/effects/effect_scene.h"

namespace mgtd::calib::effects {
namespace {

using ::testing::HasSubstr;

/// Share of the information about an effect that is left when every other unknown is free, best combination
/// of its coefficients.
double information_left(const PoseTable& table, const std::string& spec) {
  fit::joint::JointOptions options;
  options.table_sd_rad = to_rad(0.02);
  auto fit = fit::joint::fit_joint(table, options);
  const EffectContext context{.table = &table, .offset_nT = {}};
  fit->problem.effects = {*library::make_effect(*EffectSpec::parse(spec), context)};
  fit->state.coefficients = Eigen::VectorXd::Zero(fit->problem.coefficients());
  for (fit::joint::LinearPrior& prior : fit->problem.priors)
    prior.row.conservativeResizeLike(Eigen::VectorXd::Zero(fit->problem.fixed()));
  const Eigen::MatrixXd S = fit::joint::reduce(fit->problem, fit->state, 0).S;
  const Eigen::Index m = fit->problem.coefficients(), n = fit::joint::FixedSlots{}.effects();
  const Eigen::MatrixXd own = S.bottomRightCorner(m, m), cross = S.bottomLeftCorner(m, n);
  const Eigen::VectorXd d = S.diagonal().head(n).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd base = d.asDiagonal() * S.topLeftCorner(n, n) * d.asDiagonal();
  const Eigen::MatrixXd scaled = cross * d.asDiagonal();
  const Eigen::MatrixXd left = own - scaled * base.ldlt().solve(scaled.transpose());
  const Eigen::VectorXd e = own.diagonal().cwiseSqrt().cwiseInverse();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(e.asDiagonal() * left * e.asDiagonal())
      .eigenvalues()
      .maxCoeff();
}

TEST(Absorbed, IronAndCrosstalkLeaveNothingInAUniformField) {
  const PoseTable table = testing::run_with({}, {}, 3);
  for (const char* spec : {"platform.hard-iron", "platform.soft-iron", "platform.crosstalk"})
    EXPECT_LT(information_left(table, spec), 1e-7) << spec;
  // The same figure for what is not absorbed.
  for (const char* spec :
       {"axis.quadratic", "platform.current", "platform.flexure", "axis.offset.temperature"})
    EXPECT_GT(information_left(table, spec), 1e-3) << spec;
}

TEST(Absorbed, AFitIsRefusedWithTheReason) {
  const PoseTable table = testing::run_with({}, {}, 3);
  for (const library::EffectFamily& family : library::effect_families()) {
    if (family.untestable.empty()) continue;
    fit::joint::JointOptions options;
    options.effects = {*library::make_effect(family.name)};
    const auto fit = fit::joint::fit_joint(table, options);
    ASSERT_FALSE(fit);
    EXPECT_THAT(fit.error().message, HasSubstr(std::string(family.untestable)));
    EXPECT_EQ(fit.error().remedy, family.experiment);
  }
}

TEST(Absorbed, AConstantCurrentIsPartOfTheOffsets) {
  PoseTable table = testing::run_with({}, {}, 3);
  for (Pose& pose : table.poses) pose.covariates["motor_A"] = 1.5;
  fit::joint::JointOptions options;
  options.effects = {*library::make_effect("platform.current")};
  const auto fit = fit::joint::fit_joint(table, options);
  ASSERT_FALSE(fit);
  EXPECT_THAT(fit.error().message, HasSubstr("motor_A is 1.5 A at every pose"));
  for (Pose& pose : table.poses) pose.covariates.clear();
  EXPECT_THAT(fit::joint::fit_joint(table, options).error().message,
              HasSubstr("no column of the poses ends in _A"));
}

}  // namespace
}  // namespace mgtd::calib::effects
