// SPDX-License-Identifier: Apache-2.0
// Digitisers of a wrong rate and delivery in steps, while the field turns fast: every epoch is held against
// the rig's truth, through the real drivers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/scenario/stream_judge.h"
#include "tests/scenario/virtual_daemon.h"

namespace mgtd {
namespace {

using namespace mgtd::daemon;
using test::scenario_of;
using test::StreamJudge;
using test::VirtualDaemon;

/// The azimuth runs away at 20 deg/s: up to 9000 nT/s.
void turn_and_judge(const std::string& keys, double seconds) {
  VirtualDaemon daemon(
      scenario_of("[rig]\nname = \"table6\"\nparameters = \"table6\"\nseed = 6\n[sensors]\n" + keys));
  StreamJudge judge;
  judge.watch(daemon);
  ASSERT_TRUE(daemon.run(60, [&] { return daemon.all_live(); }));
  daemon.fault("runaway table");
  daemon.run(seconds);
  EXPECT_GT(static_cast<double>(judge.judged), 40 * seconds);
  EXPECT_TRUE(judge.why_gaps.empty() || judge.why_gaps.back().find("lost") == std::string::npos);
}

TEST(ClocksOnTheRig, ADigitiserThatIsOnePercentSlow) {
  turn_and_judge("rate_error_percent = [0, -1, 0, 0]\n", 60);
}

TEST(ClocksOnTheRig, AReferenceThatIsFivePercentFast) {
  turn_and_judge("rate_error_percent = [5, 0, 0, 0]\n", 60);
}

TEST(ClocksOnTheRig, DeliveryInStepsThatBeat) {
  turn_and_judge("oscillator_ppm = 50\ndelivery_s = [0.015, 0.015, 0.015, 0.015]\n", 60);
}

TEST(ClocksOnTheRig, SlowAndDeliveredInSteps) {
  turn_and_judge("rate_error_percent = [0, 0, -0.2, 0]\ndelivery_s = [0.015, 0.01, 0.015, 0.005]\n", 60);
}

}  // namespace
}  // namespace mgtd
