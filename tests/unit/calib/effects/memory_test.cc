// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "calib/effects/laws/axis_hysteresis.h"
#include "calib/effects/library/library.h"
#include "calib/fit/joint/joint_fit.h"
#include "calib/fit/joint/profile_search.h"
#include "tests/blind/planted.h"
#include "tests/unit/calib/effects/effect_scene.h"

namespace mgtd::calib::effects {
namespace {

TEST(Hysteresis, PlayFollowsByHand) {
  double p = 0;
  const std::array<double, 6> x{0.05, 0.3, 0.25, 0.15, -0.4, -0.35};
  const std::array<double, 6> expected{0, 0.2, 0.2, 0.2, -0.3, -0.3};
  for (std::size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(p = laws::play(p, x[i], 0.1), expected[i], 1e-15);
}

/// A turn that goes beyond both dwells leaves its mark only where the path was kept.
TEST(Hysteresis, FollowsThePathBetweenTheDwells) {
  PoseTable table = testing::run_with({}, {.noise_nT = 0, .table_sd_rad = 0}, 4);
  const auto dwells = laws::play_before(**laws::run_memory({.table = &table, .offset_nT = {}}), 0.05);
  const Pose &from = table.poses[50], &to = table.poses[51];
  const TableAngles over{*from.azimuth_rad + 2, *from.pitch_rad + 1.5, *from.roll_rad};
  table.path = {{*from.t_s + 20, over}};
  const auto with_path = laws::run_memory({.table = &table, .offset_nT = {}});
  ASSERT_TRUE(with_path);
  const laws::RememberedPose& remembered = (*with_path)->poses[51];
  ASSERT_EQ(remembered.on_the_way.size(), 1U);
  const testing::Scene scene;
  const Eigen::Vector3d B_S = scene.f_nT * scene.direction;
  const Eigen::Vector3d v =
      testing::table6_rig()[0].predict(testing::attitude(over) * B_S) - testing::table6_rig()[0].offset_nT;
  // Noise-free dwells of a rig linear in the field: the map by angles is exact, the offset good to a
  // nanotesla.
  EXPECT_LT((remembered.on_the_way[0].v_nT[0] - v).norm(), 5);
  const auto path = laws::play_before(**with_path, 0.05);
  EXPECT_NE(path.at(to.number, 0, 0).p, dwells.at(to.number, 0, 0).p);
  EXPECT_EQ(path.at(from.number, 0, 0).p, dwells.at(from.number, 0, 0).p);
}

fit::joint::JointOptions options_with(const char* spec) {
  fit::joint::JointOptions options;
  options.effects = {*library::make_effect(spec)};
  return options;
}

/// The table stands a tenth of a degree off its angles, and 5 nT in a play of 0.1 F0 follow the field to 0.1
/// nT for each of them. Where the table goes beyond a pose before it comes to it, no reading tells how far it
/// is off: those poses have more noise than the others, and the fit is as good as it says.
TEST(Hysteresis, IsFollowedAlongTheWayOfATableThatIsNotQuiteAtItsAngles) {
  constexpr int kRuns = 20;
  double chi2 = 0, dof = 0, nees = 0;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    testing::Stage stage = testing::full_stage(seed);
    stage.design = rig::run_of_157({}, seed);
    for (rig::PlannedPose& pose : stage.design.poses) pose.sense = 1;
    const PoseTable run = testing::planted_run(stage, {{"axis.hysteresis", "s1.y", {5, 0.1}, {}}}, seed);
    ASSERT_FALSE(run.path.empty());
    const auto fit = fit::joint::fit_joint(run, options_with("axis.hysteresis@s1.y,w=0.1"));
    ASSERT_TRUE(fit) << fit.error().text();
    chi2 += fit->chi2, dof += fit->dof;
    const int h = fit->problem.slots().effects();
    nees += std::pow(fit->state.coefficients[0] - 5, 2) / fit->covariance(h, h) / kRuns;
  }
  EXPECT_NEAR(chi2 / dof, 1, 0.05);
  EXPECT_NEAR(nees, 1, 3 * std::sqrt(2.0 / kRuns));
}

testing::Injection hysteresis_of(double h_nT, double w) {
  const auto p = std::make_shared<double>(0);
  return {.axis = [=](const Pose&, int sensor, int axis, const Eigen::Vector3d& v,
                      const Eigen::Vector3d* before) {
    if (sensor != 1 || axis != 0) return 0.0;
    if (before == nullptr) *p = 0;
    const double x = v[0] / 50'000;
    *p = std::max(x - w, std::min(x + w, *p));
    return h_nT * (*p - x) / w;
  }};
}

TEST(Hysteresis, IsLeftOutWhereTheReadingsBeforeAreUnknown) {
  const PoseTable table = testing::run_with({}, {}, 4);
  for (const char* spec : {"axis.hysteresis@s2,w=0.1", "axis.settling@s2,tau=9"}) {
    EXPECT_EQ((*library::make_effect(spec))->missing(table.poses[5]), laws::kNoMemory);
    const EffectPtr bound =
        *library::make_effect(*EffectSpec::parse(spec), {.table = &table, .offset_nT = {}});
    EXPECT_EQ(bound->missing(table.poses[5]), "");
    Pose elsewhere = table.poses[5];
    elsewhere.number = 1000;
    EXPECT_EQ(bound->missing(elsewhere), laws::kNoMemory);
  }
}

TEST(Tune, FindsTheWidthOfAHysteresis) {
  const PoseTable table = testing::run_with(hysteresis_of(4, 0.3), {}, 6);
  const auto effects = fit::joint::profile_search(table, options_with("axis.hysteresis@s2.x"));
  ASSERT_TRUE(effects) << effects.error().text();
  const auto spec = *EffectSpec::parse(effects->front()->spec());
  EXPECT_NEAR(*spec.number("w", 0, 0, 10), 0.3, 0.03);
  fit::joint::JointOptions options;
  options.effects = *effects;
  const auto fit = fit::joint::fit_joint(table, options);
  ASSERT_TRUE(fit);
  EXPECT_NEAR(fit->chi2 / fit->dof, 1, 3.5 * std::sqrt(2 / fit->dof));
  EXPECT_NEAR(fit->state.coefficients[0], 4, 0.6);
}

TEST(Tune, LeavesAGivenNumberAlone) {
  const PoseTable table = testing::run_with(hysteresis_of(4, 0.3), {}, 6);
  const auto effects = fit::joint::profile_search(table, options_with("axis.hysteresis@s2.x,w=0.15"));
  ASSERT_TRUE(effects);
  EXPECT_EQ(effects->front()->spec(), "axis.hysteresis@s2.x,w=0.15");
}

TEST(Tune, FindsTheTimeOfAStep) {
  const testing::Injection step{
      .axis = [](const Pose& p, int sensor, int axis, const Eigen::Vector3d&, const Eigen::Vector3d*) {
        return sensor == 3 && axis == 1 && p.number > 60 ? 3.0 : 0.0;
      }};
  const PoseTable table = testing::run_with(step, {}, 7);
  const auto effects = fit::joint::profile_search(table, options_with("axis.offset.step@s4.y"));
  ASSERT_TRUE(effects) << effects.error().text();
  const auto spec = *EffectSpec::parse(effects->front()->spec());
  // Ten times the noise: no pose can be on the wrong side.
  EXPECT_NEAR(*spec.number("ts", 0, 0, 10), 59.5 / 60, 0.1 / 60);
}

TEST(Tune, FindsADipoleFromTheGrid) {
  const Eigen::Vector3d place(0.7, -0.6, 0.4), moment(0.3, 0.2, -0.4);
  const testing::Injection magnet{.site = [=](double, const Eigen::Vector3d& x) -> Eigen::Vector3d {
    const Eigen::Vector3d d = x - place;
    return 100 * (3 * moment.dot(d) * d / std::pow(d.norm(), 5) - moment / std::pow(d.norm(), 3));
  }};
  const PoseTable table = testing::run_with(magnet, {}, 8);
  const auto effects = fit::joint::profile_search(table, options_with("site.dipole"));
  ASSERT_TRUE(effects) << effects.error().text();
  fit::joint::JointOptions options;
  options.effects = *effects;
  const auto fit = fit::joint::fit_joint(table, options);
  ASSERT_TRUE(fit) << fit.error().text();
  EXPECT_NEAR(fit->chi2 / fit->dof, 1, 3.5 * std::sqrt(2 / fit->dof));
  const auto spec = *EffectSpec::parse(effects->front()->spec());
  for (int i = 0; i < 3; ++i) {
    const double sd = std::sqrt(fit->covariance(fit::joint::FixedSlots{}.effects() + 3 + i,
                                                fit::joint::FixedSlots{}.effects() + 3 + i));
    EXPECT_NEAR(*spec.number(std::string(1, "xyz"[i]), 0, -10, 10) + fit->state.coefficients[3 + i], place[i],
                5 * sd + 1e-3);
  }
}

}  // namespace
}  // namespace mgtd::calib::effects
