// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/effect_list.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/rig/effects/site_record.h"
#include "tests/rig/effects/temperature_law.h"
#include "tests/rig/simulated_table.h"

namespace mgtd::rig {
namespace {

std::shared_ptr<const Effect> made(const std::string& toml) {
  auto effect = effect_of(toml);
  EXPECT_TRUE(effect.has_value()) << (effect ? "" : effect.error());
  return effect.value_or(nullptr);
}

Scenario without_noise() {
  Scenario quiet;
  quiet.noise.noise_nT = 0;
  quiet.scalar_noise_nT = 0;
  quiet.table_accuracy_deg = 0;
  quiet.temperature.ramp_degC_per_h = 5;
  quiet.covariates.push_back({});
  return quiet;
}

Design short_run() { return run_of_157({.random = 30, .revisits = 0, .senses = true, .pause_s = 60}, 1); }

/// Every effect can be drawn, read back, and changes what a run reads: none is a name only.
TEST(EffectList, EveryEffectChangesTheReadings) {
  Scenario quiet = without_noise();
  quiet.truth = *rig_named("table6", 1);
  const Design design = short_run();
  const PoseTable without = simulated_table(quiet, design, 1);
  std::mt19937_64 random(7);
  for (const EffectKind* kind : all_kinds()) {
    Scenario hidden = quiet;
    hidden.effects.push_back(made(random_effect(*kind, 1, random)));
    const PoseTable with = simulated_table(hidden, design, 1);
    double change_nT = 0;
    for (std::size_t k = 0; k < with.poses.size(); ++k) {
      const auto &a = with.poses[k], &b = without.poses[k];
      for (std::size_t i = 0; i < 4; ++i) change_nT += (a.y_nT.at(i) - b.y_nT.at(i)).norm();
      change_nT += std::abs(*a.f_nT - *b.f_nT);
    }
    EXPECT_GT(change_nT, 1) << kind->name;
    EXPECT_TRUE(std::isfinite(change_nT)) << kind->name;
    EXPECT_EQ(hidden.effects.back()->truth().at("effect"), kind->name);
  }
}

/// Each is drawn for, and does something in, an array of two.
TEST(EffectList, EveryEffectFindsTheSensorsOfAnArray) {
  Scenario quiet = without_noise();
  quiet.truth = rig_named("ideal", 1, 2).value();
  quiet.positions_m = {{0.3, 0, 0}, {-0.1, 0.2, 0.1}};
  const Design design = short_run();
  const Survey without = simulated_survey(quiet, design, 1);
  std::mt19937_64 random(8);
  for (const EffectKind* kind : all_kinds()) {
    Scenario hidden = quiet;
    const auto effect = effect_of(random_effect(*kind, 1, random, "motor_A", 2), 2);
    ASSERT_TRUE(effect.has_value()) << kind->name << ": " << (effect ? "" : effect.error());
    hidden.effects.push_back(*effect);
    const Survey with = simulated_survey(hidden, design, 1);
    double change_nT = 0;
    for (std::size_t k = 0; k < with.rows.size(); ++k) {
      for (std::size_t i = 0; i < 2; ++i)
        change_nT += (with.rows[k].y_nT[i] - without.rows[k].y_nT[i]).norm();
      change_nT += std::abs(*with.rows[k].f_nT - *without.rows[k].f_nT);
    }
    EXPECT_GT(change_nT, 1) << kind->name;
    EXPECT_TRUE(std::isfinite(change_nT)) << kind->name;
  }
}

TEST(EffectList, MistakesAreNamed) {
  EXPECT_EQ(effect_of("name = 'axis.cubic'").error(), "[effect] nT_at_F0 is missing");
  EXPECT_NE(effect_of("name = 'axis.qubic'").error().find("no effect 'axis.qubic'"), std::string::npos);
  EXPECT_NE(
      effect_of("name = 'platform.hard-iron'\nwhere = 's1.x'\nnT = [1, 2, 3]").error().find("whole sensor"),
      std::string::npos);
}

/// By hand, 4 degC above T0: an arc second of 50 000 nT is 0.2424 nT.
TEST(EffectList, AxesLeanWithTheSquareOfTheWarmth) {
  const auto effect =
      made("name = 'axis.orthogonality.temperature2'\nwhere = 's2.y'\narcsec_per_degC2 = [3, -2]");
  const double arcsec_nT = 50'000 * M_PI / 180 / 3600;
  const Eigen::Vector3d v_nT(25'000, 40'000, 12'500);  // y leans towards x and z
  const auto at = [&](double T_degC) {
    return effect->axis_nT({.sensor = 1, .axis = 1, .T_degC = T_degC, .v_nT = v_nT});
  };
  EXPECT_NEAR(at(24), 16 * arcsec_nT * (3 * 0.5 - 2 * 0.25), 1e-9);
  EXPECT_NEAR(at(16), at(24), 1e-9);
  EXPECT_EQ(effect->axis_nT({.sensor = 1, .axis = 2, .T_degC = 24, .v_nT = v_nT}), 0);
}

/// By hand: sensor 687, axis 1, offset 25.837 + 1.3642 T - 0.058418 T^2, scale 0.99397 + 0.00021563 T +
/// 4.1443e-7 T^2, at 23 degC against 20 degC.
TEST(TemperatureLaw, IsTheMeasuredOne) {
  const TemperatureLaw law;
  const double offset_nT = 1.3642 * 3 - 0.058418 * (23.0 * 23 - 400);
  const double gain = (0.00021563 * 3 + 4.1443e-7 * (23.0 * 23 - 400)) / (0.99397 + 0.0043126 + 1.65772e-4);
  EXPECT_NEAR(law.axis_nT({.T_degC = 23}), offset_nT, 1e-9);
  EXPECT_NEAR(law.axis_nT({.T_degC = 23, .v_nT = {50'000, 0, 0}}), offset_nT + 50'000 * gain, 1e-6);
  EXPECT_NEAR(law.axis_nT({.T_degC = kT0_degC, .v_nT = {50'000, 30'000, 0}}), 0, 1e-10);  // rounding
  // The y axis leans towards x by the change of its angle: -(33.499 3 - 0.69658 (23^2 - 20^2)) arcsec.
  const double lean = -(33.499 * 3 - 0.69658 * (23.0 * 23 - 400)) / 3600 * M_PI / 180;
  const double offset_y_nT = -4.6222 * 3 + 0.048285 * (23.0 * 23 - 400);
  EXPECT_NEAR(law.axis_nT({.axis = 1, .T_degC = 23, .v_nT = {50'000, 0, 0}}) - offset_y_nT, 50'000 * lean,
              0.01);  // products of angles and scales of a thousandth
}

/// There are four measured laws: the fifth sensor has the first one again, each its own temperature.
TEST(TemperatureLaw, BeginsAgainAfterFourSensors) {
  const TemperatureLaw law;
  EXPECT_EQ(law.axis_nT({.sensor = 4, .T_degC = 23}), law.axis_nT({.sensor = 0, .T_degC = 23}));
  EXPECT_NE(law.axis_nT({.sensor = 5, .T_degC = 23}), law.axis_nT({.sensor = 4, .T_degC = 23}));
}

/// What the observatory's file says changed from 18:00 to 18:10 of the storm day.
TEST(SiteRecord, BeginsAtZeroAndFollowsTheObservatory) {
  const auto record = SiteRecord::named("usgs-bou-2016-01-20", 18);
  ASSERT_TRUE(record.has_value());
  EXPECT_EQ(record->site_nT(0, {0, 0, 0}).norm(), 0);
  const Eigen::Vector3d change = record->site_nT(600, {0, 0, 0});
  EXPECT_NEAR((change - Eigen::Vector3d(-1.70, -1.78, 0.07)).norm(), 0, 1e-9);
  EXPECT_FALSE(SiteRecord::named("usgs-bou-1816-01-20", 0).has_value());
}

}  // namespace
}  // namespace mgtd::rig
