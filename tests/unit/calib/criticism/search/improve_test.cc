// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/improve.h"

#include <gtest/gtest.h>

#include "calib/criticism/search/model_change.h"
#include "calib/criticism/search/nonlinear_parameters.h"
#include "calib/effects/library/library.h"
#include "calib/fit/joint/cross_validation.h"
#include "calib/fit/joint/joint_errors.h"
#include "calib/fit/joint/pose_residuals.h"
#include "tests/blind/hidden_run.h"
#include "tests/unit/calib/effects/effect_scene.h"

namespace mgtd::calib::criticism::search {
namespace {

using testing::hidden_run;

/// 40 nT of an offset that follows temperature, far above a noise of 0.3 nT.
PoseTable very_warm(std::uint64_t seed) {
  return hidden_run(
      {.hidden = [](const Pose& p, int i, int a,
                    const Eigen::Vector3d&) { return i == 2 && a == 2 ? 15 * (*p.T_degC[2] - 20) : 0.0; }},
      seed);
}

/// A residual a hundred times the noise is no price: what counts is one coefficient more at one noise.
TEST(Improve, ThePriceOfAnEffectIsThatOfItsCoefficientNotOfTheMisfitBefore) {
  const PoseTable table = very_warm(1);
  const auto report = improve(table, {});
  ASSERT_TRUE(report) << report.error().text();
  ASSERT_FALSE(report->rounds.empty());
  const ImproveRound& round = report->rounds.front();
  EXPECT_EQ(round.added.spec, "axis.offset.temperature@s3.z");
  EXPECT_GT(round.rms_before_nT, 10 * round.rms_after_nT);
  const auto alone = add_effect(table, {}, effects::library::make_effect(round.added.spec).value());
  ASSERT_TRUE(alone);
  EXPECT_LT(round.price.sd_ratio, 3);
  EXPECT_NEAR(round.price.sd_ratio, alone->price.sd_ratio, 0.02);
  EXPECT_EQ(round.price.parameter, alone->price.parameter);
}

/// Ten fits from the solution, and one Gauss-Newton step for each fold.
TEST(LeftOut, IsTheErrorThatTenFitsFind) {
  const PoseTable table = hidden_run({}, 2);
  fit::joint::JointOptions options;
  for (const char* spec : {"axis.offset.temperature", "site.gradient"})
    options.effects.push_back(effects::library::make_effect(spec).value());
  const auto fit = fit::joint::fit_joint(table, options);
  ASSERT_TRUE(fit);
  const auto quick = fit::joint::left_out_nT(*fit);
  const auto fits = fit::joint::held_out_errors(*fit, fit::joint::reduce(fit->problem, fit->state, 0));
  ASSERT_TRUE(quick && fits);
  EXPECT_NEAR(*quick, fits->residual_nT, 1e-3 * fits->residual_nT);
  EXPECT_GT(*quick,
            fit::joint::joint_errors(fit->problem, fit->state, fit::joint::FixedBlock::fitted).residual_nT);
}

/// From the nearest value of a grid to the true width, without a search.
TEST(Numbers, TheWidthOfAHysteresisIsRefinedBesideEverythingElse) {
  const auto p = std::make_shared<double>(0);
  const PoseTable table = testing::run_with(
      {.axis =
           [p](const Pose&, int sensor, int axis, const Eigen::Vector3d& v, const Eigen::Vector3d* before) {
             if (sensor != 1 || axis != 0) return 0.0;
             if (before == nullptr) *p = 0;
             const double x = v[0] / 50'000, w = 0.3;
             *p = std::max(x - w, std::min(x + w, *p));
             return 4 * (*p - x) / w;
           }},
      {}, 6);
  fit::joint::JointOptions options;
  options.effects.push_back(effects::library::make_effect("axis.hysteresis@s2.x,w=0.22").value());
  auto fit = fit::joint::fit_joint(table, options);
  ASSERT_TRUE(fit);
  const double before = fit::joint::pose_residuals(fit->problem, fit->state).residual_nT();
  refine_nonlinear_parameters(table, 0, options, *fit);
  const auto spec = effects::EffectSpec::parse(options.effects.front()->spec());
  ASSERT_TRUE(spec);
  EXPECT_NEAR(*spec->number("w", 0, 0, 10), 0.3, 0.03);
  EXPECT_LT(fit::joint::pose_residuals(fit->problem, fit->state).residual_nT(), before);

  fit::joint::JointOptions kept;
  kept.effects.push_back(effects::library::make_effect("axis.hysteresis@s2.x,w=0.22").value());
  auto same = fit::joint::fit_joint(table, kept);
  ASSERT_TRUE(same);
  refine_nonlinear_parameters(table, 1, kept, *same);
  EXPECT_EQ(kept.effects.front()->spec(), "axis.hysteresis@s2.x,w=0.22") << "what was given stays";
}

}  // namespace
}  // namespace mgtd::calib::criticism::search
