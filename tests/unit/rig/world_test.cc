// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/world.h"

#include <gtest/gtest.h>

#include "tests/rig/effects/axis_hysteresis.h"
#include "tests/rig/effects/site_gradient.h"

namespace mgtd::rig {
namespace {

Scenario ideal() {
  Scenario scenario;
  scenario.truth = *rig_named("ideal", 1);
  scenario.noise.noise_nT = 0;
  scenario.table_accuracy_deg = 0;
  scenario.f_nT = 50'000;
  scenario.inclination_deg = 0;
  scenario.declination_deg = 0;  // along site X
  return scenario;
}

constexpr double kRounding_nT = 1e-9;

TEST(World, ATurnedTableSeesTheFieldTurnBack) {
  World world(ideal());
  world.move(azimuth, 90, 0);
  const double t = 100;
  // b = Rz(90) B: the X of the site is the -Y of the platform.
  EXPECT_LT((world.read_sensor(0, t) - Eigen::Vector3d(0, -50'000, 0)).norm(), kRounding_nT * 50);
}

TEST(World, AGradientActsWhereTheSensorReallyIs) {
  Scenario scenario = ideal();
  scenario.effects.push_back(
      std::make_shared<SiteGradient>(SiteGradient::Five{100, 0, 0, 0, 0}, SiteGradient::Five{}));
  World world(scenario);
  EXPECT_NEAR(world.read_sensor(0, 0)[0], 50'000 + 100 * 0.2, kRounding_nT * 50);
  world.move(azimuth, 180, 0);
  // Sensor 1 now sits at -X of the site: 20 nT less there, and the reading is turned round.
  EXPECT_NEAR(world.read_sensor(0, 100)[0], -(50'000 - 20), kRounding_nT * 50);
}

/// A cross has it from its own sensors, any other array from the field round its centre.
TEST(World, TheTrueGradientIsThatOfTheSite) {
  Scenario scenario = ideal();
  scenario.effects.push_back(
      std::make_shared<SiteGradient>(SiteGradient::Five{100, -30, 5, 7, 9}, SiteGradient::Five{}));
  const World cross(scenario);
  scenario.truth = rig_named("ideal", 1, 1).value();
  scenario.positions_m = {{0, 0, 0.1}};
  World one(scenario);
  constexpr std::array<double, 6> kExpected{100, -30, -70, 5, 7, 9};
  for (std::size_t k = 0; k < 6; ++k) {
    EXPECT_NEAR(cross.true_gradient_nT_per_m(0)[k], kExpected.at(k), 1e-6) << k;
    EXPECT_NEAR(one.true_gradient_nT_per_m(0)[k], kExpected.at(k), 1e-6) << k;
  }
  // By hand: 1 A m2 along z, 0.2 m beyond: across its moment 100/0.008 nT against it.
  const Eigen::Vector3d before = one.read_sensor(0, 0);
  one.hold_magnet(1);
  EXPECT_NEAR((one.read_sensor(0, 1) - before).norm(), 2 * 100 / 0.008, 1e-6);  // its arm is along z
}

TEST(World, PlayFollowsThePath) {
  // w = 0.1, h = 8, by hand: up to x = 0.5 the play hangs 0.1 below, coming back to 0.45 it has not moved
  // yet.
  AxisHysteresis effect(*Where::parse("s1.x"), 8, 0.1);
  const auto at = [&](double x) {
    const AxisContext c{.v_nT = {x * kF0_nT, 0, 0}};
    effect.follow(c);
    return effect.axis_nT(c);
  };
  EXPECT_NEAR(at(0.05), 8 * (0 - 0.05) / 0.1, 1e-12);
  EXPECT_NEAR(at(0.5), -8, 1e-12);
  EXPECT_NEAR(at(0.45), 8 * (0.4 - 0.45) / 0.1, 1e-12);
  EXPECT_NEAR(at(0.0), 8, 1e-12);
}

TEST(World, TheTableIsNeverQuiteWhereItSays) {
  Scenario scenario = ideal();
  scenario.table_accuracy_deg = 0.1;
  World world(scenario);
  double squares = 0;
  constexpr int kMoves = 400;
  for (int i = 0; i < kMoves; ++i) {
    const double t = 100.0 * i;
    world.move(azimuth, i % 2 == 0 ? 10 : 0, t);
    squares += std::pow(world.axis(azimuth).true_deg(t + 50) - world.axis(azimuth).indicated_deg(t + 50), 2);
  }
  EXPECT_NEAR(std::sqrt(squares / kMoves), 0.1, 0.02);  // 3.5 % one sigma
}

}  // namespace
}  // namespace mgtd::rig
