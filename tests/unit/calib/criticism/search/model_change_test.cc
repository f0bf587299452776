// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/model_change.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "calib/effects/library/library.h"
#include "calib/report/model_change_report.h"
#include "calib/report/waterfall_report.h"
#include "tests/blind/hidden_run.h"
#include "tests/blind/planted.h"

namespace mgtd::calib::criticism::search {
namespace {

using testing::hidden_run;
using testing::HiddenRun;

effects::EffectPtr effect(const std::string& spec) { return effects::library::make_effect(spec).value(); }

/// An offset that follows temperature on s3.z, and a cubic on s1.x that is much smaller.
PoseTable warm_and_bent(std::uint64_t seed) {
  HiddenRun run;
  run.hidden = [](const Pose& p, int i, int a, const Eigen::Vector3d& v) {
    if (i == 2 && a == 2) return 3.0 * (*p.T_degC[2] - 20);
    return i == 0 && a == 0 ? 2.0 * std::pow(v[0] / 50'000, 3) : 0.0;
  };
  return hidden_run(run, seed);
}

TEST(ModelChange, TheFallIsTheOneThatWasPredictedAndUnseenPosesAgree) {
  const PoseTable table = warm_and_bent(1);
  const auto change = add_effect(table, {}, effect("axis.offset.temperature@s3.z"));
  ASSERT_TRUE(change) << change.error().text();
  EXPECT_NEAR(change->realised, change->predicted, 0.05 * change->predicted);
  EXPECT_LT(change->log10_p, -100);
  EXPECT_EQ(change->k, 1);
  EXPECT_LT(*change->held_out_after_nT, 0.3 * *change->held_out_before_nT);
  EXPECT_FALSE(change->vetoed());
  ASSERT_EQ(change->coefficients.size(), 1U);
  EXPECT_NEAR(change->coefficients[0].value, 3, 5 * change->coefficients[0].sd);
  EXPECT_THAT(change->model, ::testing::ElementsAre("axis.offset.temperature@s3.z"));
}

/// The covariance of the narrower model is its own: what the effect costs is the same from either side.
TEST(ModelChange, UnderTheSameWeightsUncertaintiesCompare) {
  const PoseTable table = warm_and_bent(1);
  const auto stage =
      model_stage(table, {.effects = {effect("axis.offset.temperature@s3.z"), effect("axis.cubic@s1.x")}});
  ASSERT_TRUE(stage) << stage.error().text();
  const auto narrow = fit_under_same_weights(table, *stage, {});
  ASSERT_TRUE(narrow) << narrow.error().text();
  const VariancePrice price = variance_price(*narrow, stage->fit);
  EXPECT_GT(price.sd_ratio, 1.5);
  const Eigen::ArrayXd ratio =
      (stage->fit.covariance.diagonal().head(48).array() / narrow->covariance.diagonal().head(48).array())
          .sqrt();
  EXPECT_NEAR(ratio.maxCoeff(), price.sd_ratio, 1e-3 * price.sd_ratio);
}

/// What is not there brings the fall of one coefficient's chance, and costs variance.
TEST(ModelChange, AnEffectThatIsNotThereBuysNothingAndHasItsPrice) {
  const PoseTable table = hidden_run({}, 2);
  const auto change = add_effect(table, {}, effect("axis.cubic@s2.y"));
  ASSERT_TRUE(change);
  EXPECT_LT(change->realised, 12);  // p 5e-4
  EXPECT_NEAR(change->realised, change->predicted, 0.1);
  EXPECT_GT(change->price.sd_ratio, 1.2);
  EXPECT_EQ(change->price.parameter, "s2.cy") << "a cubic hides behind the scale of its own axis";
  EXPECT_THAT(report::to_text(*change), ::testing::HasSubstr("weak evidence")) << "p = 0.048";
}

TEST(ModelChange, ALawMayActOnASecondAxisButNotTwiceOnOne) {
  const PoseTable table = warm_and_bent(1);
  fit::FitOptions model;
  model.effects = {effect("axis.offset.temperature@s3.z")};
  const auto second = add_effect(table, model, effect("axis.offset.temperature@s1.x"));
  ASSERT_TRUE(second) << second.error().text();
  EXPECT_EQ(second->model.size(), 2U);
  const auto again = add_effect(table, model, effect("axis.offset.temperature@s3"));
  ASSERT_FALSE(again);
  EXPECT_THAT(again.error().text(), ::testing::HasSubstr("axis.offset.temperature@s3.z already"));
}

/// Without its moment a step of the site is looked for, as the step of an axis is.
TEST(ModelChange, TheMomentOfAStepOfTheSiteIsSearched) {
  testing::Stage stage = testing::full_stage(3);
  const PoseTable quiet = testing::planted_run(stage, {}, 3);
  const double at_s = *quiet.poses[70].t_s - 1;
  const PoseTable table =
      testing::planted_run(stage, {{"site.gradient-step", "all", {30, -10, 5, 20, -15, at_s}}}, 3);
  const auto change = add_effect(table, {}, effect("site.step"));
  ASSERT_TRUE(change) << change.error().text();
  EXPECT_THAT(change->spec, ::testing::StartsWith("site.step,ts="));
  const auto spec = effects::EffectSpec::parse(change->spec);
  ASSERT_TRUE(spec);
  EXPECT_NEAR(*spec->number("ts", 0, 0, 100), at_s / 3600, 30.0 / 3600) << change->spec;
  EXPECT_FALSE(change->vetoed());
}

/// A magnet that was put down during the run is a step of the site, and no gradient.
TEST(ModelChange, AStepOfTheSiteIsTheSourceThatMadeIt) {
  testing::Stage stage = testing::full_stage(3);
  const PoseTable quiet = testing::planted_run(stage, {}, 3);
  const double at_s = *quiet.poses[70].t_s - 1;
  stage.scenario.magnets = {{.at_s = at_s, .moment_Am2 = {0.5, 1, 0.3}, .at_m = {2, 1, -0.5}}};
  const PoseTable table = testing::planted_run(stage, {}, 3);
  const auto change = add_effect(table, {}, effect("site.step"));
  ASSERT_TRUE(change) << change.error().text();
  const auto spec = effects::EffectSpec::parse(change->spec);
  ASSERT_TRUE(spec);
  EXPECT_NEAR(*spec->number("x", 0, -9, 9), 2, 0.1) << change->spec;
  EXPECT_NEAR(*spec->number("ts", 0, 0, 100), at_s / 3600, 30.0 / 3600) << change->spec;
  EXPECT_LT(change->rms_after_nT, 1.2 * change->noise_nT) << change->spec;
}

/// A gradient that nobody knows of leaves fifty times the noise: chi-square falls by hundreds for nothing.
TEST(ModelChange, InAModelFarOffChanceIsJudgedByWhatIsLeft) {
  Eigen::Matrix3d G;
  G << 50, 15, -25, 15, -20, 10, -25, 10, -30;
  const auto change =
      add_effect(hidden_run({.noise_nT = 0.02, .G_nT_per_m = G}, 2), {}, effect("axis.cubic@s2.y"));
  ASSERT_TRUE(change);
  EXPECT_GT(change->birge_ratio, 50);
  EXPECT_GT(change->realised, 100);
  EXPECT_GT(change->log10_p, -2);
}

TEST(ModelChange, DroppingIsAddingBackwards) {
  const PoseTable table = warm_and_bent(3);
  fit::FitOptions with;
  with.effects = {effect("axis.offset.temperature@s3.z"), effect("axis.cubic@s1.x")};
  fit::FitOptions without;
  without.effects = {with.effects[0]};
  const auto added = add_effect(table, without, with.effects[1]);
  const auto dropped = drop_effect(table, with, 1);
  ASSERT_TRUE(added && dropped);
  EXPECT_FALSE(dropped->adding);
  EXPECT_NEAR(dropped->realised, added->realised, 0.02 * added->realised);
  EXPECT_NEAR(dropped->predicted, dropped->realised, 0.05 * dropped->realised);
  EXPECT_NEAR(dropped->rms_after_nT, added->rms_before_nT, 1e-6);
  EXPECT_EQ(dropped->price.parameter, added->price.parameter);
}

TEST(ModelChange, DroppingWhatIsNeededIsVetoedByPosesLeftOut) {
  const PoseTable table = warm_and_bent(4);
  fit::FitOptions with;
  with.effects = {effect("axis.offset.temperature@s3.z")};
  const auto dropped = drop_effect(table, with, 0);
  ASSERT_TRUE(dropped);
  EXPECT_TRUE(dropped->vetoed());
}

/// Of figures alone, no fit.
TEST(ModelChange, ChanceAndPriceForbidAnAdditionAndNoRemoval) {
  ModelChange change;
  change.log10_p = -1.2;
  change.price = {.sd_ratio = 1540, .parameter = "s2.scale.z"};
  change.held_out_before_nT = 1, change.held_out_after_nT = 1.005;
  EXPECT_THAT(change.vetoes(), ::testing::ElementsAre(Veto::not_shown, Veto::price));
  EXPECT_THAT(report::to_text(change, Veto::price), ::testing::HasSubstr("s2.scale.z would be 1540 times"));
  EXPECT_THAT(report::to_text(change, Veto::not_shown), ::testing::HasSubstr("not shown to be there"));
  EXPECT_EQ(report::to_json(change)["vetoes"].size(), 2U);
  change.log10_p = -1.4;
  change.price.sd_ratio = 99;
  EXPECT_FALSE(change.vetoed());
  change.held_out_after_nT = 1.02;
  EXPECT_THAT(change.vetoes(), ::testing::ElementsAre(Veto::held_out));
  change.adding = false;
  change.log10_p = 0;
  change.price.sd_ratio = 1540;
  EXPECT_THAT(change.vetoes(), ::testing::ElementsAre(Veto::held_out));
}

TEST(ModelChange, AnEffectCannotBeInTwice) {
  const PoseTable table = hidden_run({}, 5);
  fit::FitOptions with;
  with.effects = {effect("site.gradient")};
  const auto again = add_effect(table, with, effect("site.gradient"));
  ASSERT_FALSE(again);
  EXPECT_EQ(again.error().code, ErrorCode::refused);
}

TEST(Waterfall, ErrorsOfEffectsThatHaveNothingInCommonAddInSquares) {
  const PoseTable table = warm_and_bent(6);
  fit::FitOptions with;
  with.effects = {effect("axis.cubic@s1.x"), effect("axis.offset.temperature@s3.z")};
  const auto w = waterfall(table, with);
  ASSERT_TRUE(w) << w.error().text();
  ASSERT_EQ(w->steps.size(), 2U);
  EXPECT_EQ(w->steps[0].effect, "axis.offset.temperature") << "the larger one stands first";
  double first = w->with_nT * w->with_nT, last = first;
  for (const WaterfallStep& s : w->steps) {
    first += s.first_nT * s.first_nT;
    last += s.last_nT * s.last_nT;
    EXPECT_NEAR(s.first_nT, s.last_nT, 0.1 * s.first_nT) << s.spec;
    EXPECT_GT(s.last_nT_per_m, 0);
  }
  EXPECT_NEAR(std::sqrt(first), w->without_nT, 0.02 * w->without_nT);
  EXPECT_NEAR(std::sqrt(last), w->without_nT, 0.02 * w->without_nT);
  // All that is left is noise; the fit took some of its freedom.
  EXPECT_NEAR(w->with_nT, w->floor_nT, 0.15 * w->floor_nT);
  EXPECT_EQ(report::to_json(*w).at("steps").size(), 2U);
}

}  // namespace
}  // namespace mgtd::calib::criticism::search
