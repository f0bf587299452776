// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/bench_rig.h"

#include <gmock/gmock.h>

#include <cmath>

namespace mgtd::rig {
namespace {

/// Digitisers that send of themselves from the first moment on, and no noise.
Scenario talkative() {
  Scenario scenario;
  scenario.truth = *rig_named("table6", 1);
  scenario.palmacq = false;
  scenario.autostart = true;
  scenario.noise.noise_nT = 0;
  scenario.faults = {{0.3, "runaway table for 0.4"}};
  return scenario;
}

constexpr double kStep_s = 0.005;

/// What a port has sent after `until_s`, while a table that runs away from 0.3 to 0.7 s is read at every step
/// or, by a host that stands still, at the end.
std::string sent(bool at_every_step, double until_s) {
  BenchRig rig(talkative(), 0);
  std::string out;
  for (double now_s = kStep_s; now_s < until_s; now_s += kStep_s) {
    rig.run_script(now_s);
    if (at_every_step) out += rig.read(0, now_s);
  }
  return out + rig.read(0, until_s);
}

TEST(BenchRig, ReadingsThatWaitAreOfTheMomentTheyWereTakenAt) {
  const std::string read_at_once = sent(true, 1.2);
  EXPECT_GT(read_at_once.size(), 500U);
  EXPECT_EQ(sent(false, 1.2), read_at_once);
}

/// Six sensors: six digitisers with ports of their own, then the table; every one talks, no two at one time.
TEST(BenchRig, EverySensorOfAnArrayHasAPort) {
  Scenario scenario = talkative();
  scenario.faults.clear();
  scenario.truth = rig_named("ideal", 1, 6).value();
  for (int i = 0; i < 6; ++i) scenario.positions_m.emplace_back(0.1 * i, 0, 0);
  scenario.plugs = {1, 2, 3, 4, 6, 5};
  BenchRig rig(scenario, 0);
  ASSERT_EQ(rig.ports(), 8U);
  EXPECT_EQ(rig.name(5), "fluxgate6");
  EXPECT_EQ(rig.instrument(5), "fluxgate5");
  EXPECT_EQ(rig.name(6), "table");
  EXPECT_EQ(rig.name(7), "scalar");
  ASSERT_TRUE(rig.apply(*parse_fault("unplug fluxgate6", 6), 0.5));
  for (std::size_t port = 0; port < 6; ++port)
    EXPECT_EQ(rig.read(port, 1).empty(), port == 5) << rig.name(port);
  EXPECT_FALSE(rig.apply(*parse_fault("unplug fluxgate7", 7), 1).has_value());
  ASSERT_TRUE(rig.apply(*parse_fault("runaway table", 6), 1));
  EXPECT_TRUE(rig.world().moving(2));
}

TEST(BenchRig, HandsWarmOneHeadOrAllForAWhileOrForGood) {
  BenchRig rig(talkative(), 0);
  const auto warmer_degC = [&](int head, double t_s) {
    return rig.world().head_degC(head, t_s) - rig.world().head_degC(head, 0);
  };
  ASSERT_TRUE(rig.surroundings("warm 5 90 2 100", 10));
  EXPECT_EQ(warmer_degC(1, 109), 0);
  EXPECT_NEAR(warmer_degC(1, 200), 5, 1e-9);
  EXPECT_EQ(warmer_degC(0, 200), 0);
  ASSERT_TRUE(rig.surroundings("heat 6 180", 1000));
  EXPECT_NEAR(warmer_degC(0, 1180), 6 * (1 - std::exp(-1)), 1e-9);
  EXPECT_NEAR(warmer_degC(3, 5000), 6, 1e-6);
  for (const char* nonsense : {"warm", "warm 5", "warm 5 0", "heat x 3", "coil 0", "cool 5 90"})
    EXPECT_FALSE(rig.surroundings(nonsense, 2000)) << nonsense;
}

}  // namespace
}  // namespace mgtd::rig
