// SPDX-License-Identifier: Apache-2.0
// Plugs that change places, and sensors that are turned, on the simulated rig.
#include <gmock/gmock.h>

#include "tests/rig/bench_rig.h"

namespace mgtd::rig {
namespace {

using ::testing::HasSubstr;

Scenario alone() {
  Scenario scenario;
  scenario.truth = *rig_named("table6", 1);
  scenario.palmacq = false;
  scenario.noise.noise_nT = 0;
  return scenario;
}

/// What the instrument at a port answers to the question for its serial number.
std::string serial(BenchRig& rig, std::size_t port, double& now_s) {
  rig.write(port, "$01SN\r", now_s);
  now_s += 0.5;
  rig.run_script(now_s);
  return rig.read(port, now_s);
}

TEST(Plugs, AreOutForASecondAndThenInTheOtherPlace) {
  BenchRig rig(alone(), 0);
  double now_s = 0;
  EXPECT_EQ(serial(rig, 1, now_s), "!01SN1002\r");
  ASSERT_TRUE(rig.apply(*parse_fault("exchange fluxgate2 fluxgate4 for 10"), now_s));
  EXPECT_FALSE(rig.plugged(1));
  EXPECT_FALSE(rig.plugged(3));
  now_s += 1.1;
  rig.run_script(now_s);
  EXPECT_EQ(serial(rig, 1, now_s), "!01SN1004\r");
  EXPECT_EQ(serial(rig, 3, now_s), "!01SN1002\r");
  EXPECT_EQ(serial(rig, 0, now_s), "!01SN1001\r");
  now_s = 20;
  rig.run_script(now_s);
  now_s = 22;
  rig.run_script(now_s);
  EXPECT_EQ(serial(rig, 1, now_s), "!01SN1002\r") << "the time of the fault is over";
}

TEST(Plugs, OfAScenarioAreElsewhereFromTheStart) {
  Scenario scenario = alone();
  scenario.plugs = {1, 4, 3, 2};
  BenchRig rig(scenario, 0);
  double now_s = 0;
  EXPECT_EQ(serial(rig, 1, now_s), "!01SN1004\r");
  EXPECT_EQ(rig.instrument(1), "fluxgate4");
  ASSERT_TRUE(rig.apply(*parse_fault("restore fluxgate2"), now_s));
  now_s += 1.1;
  rig.run_script(now_s);
  EXPECT_EQ(serial(rig, 1, now_s), "!01SN1002\r");
}

TEST(Plugs, OfDigitisersThatDoNotTell) {
  Scenario scenario = alone();
  scenario.tells_serial = false;
  BenchRig rig(scenario, 0);
  double now_s = 0;
  EXPECT_EQ(serial(rig, 1, now_s), "?01\r");
}

TEST(Plugs, EveryPortCanBeRestored) {
  BenchRig rig(alone(), 0);
  for (const std::string port : {"fluxgate1", "fluxgate4", "table", "scalar"}) {
    ASSERT_TRUE(rig.apply(*parse_fault("unplug " + port), 0)) << port;
    ASSERT_TRUE(rig.apply(*parse_fault("restore " + port), 1)) << port;
  }
  for (std::size_t port = 0; port < rig.ports(); ++port) EXPECT_TRUE(rig.plugged(port)) << port;
}

TEST(Plugs, OnlyOfTwoFluxgates) {
  EXPECT_THAT(parse_fault("exchange fluxgate2").error(), HasSubstr("two ports"));
  EXPECT_THAT(parse_fault("exchange fluxgate2 table").error(), HasSubstr("only a fluxgate"));
  EXPECT_THAT(parse_fault("exchange fluxgate2 fluxgate2").error(), HasSubstr("with another one"));
  EXPECT_THAT(parse_fault("turn scalar").error(), HasSubstr("only a fluxgate"));
}

TEST(TurnedSensor, ReadsWhatPointedAlongYAsItsX) {
  Scenario scenario = alone();
  scenario.truth = *rig_named("ideal", 1);
  BenchRig rig(scenario, 0);
  const Eigen::Vector3d before = rig.world().quiet_reading(2, 1);
  ASSERT_TRUE(rig.apply(*parse_fault("turn fluxgate3"), 1));
  const Eigen::Vector3d after = rig.world().quiet_reading(2, 1);
  EXPECT_NEAR(after.x(), before.y(), 0.02 * before.norm());
  EXPECT_NEAR(after.y(), -before.x(), 0.02 * before.norm());
  EXPECT_NEAR(after.z(), before.z(), 1e-6);
  ASSERT_TRUE(rig.apply(*parse_fault("restore fluxgate3"), 1));
  EXPECT_NEAR((rig.world().quiet_reading(2, 1) - before).norm(), 0, 1e-9);
}

}  // namespace
}  // namespace mgtd::rig
