// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/dcon_instrument.h"

#include <gtest/gtest.h>

namespace mgtd::rig {
namespace {

struct Bench {
  std::string say(const std::string& bytes) {
    module.receive(bytes, now_s);
    return module.take_output();
  }
  DconInstrument module{{Covariate{.name = "motor_A", .mean = 2.5, .amplitude = 0},
                         Covariate{.name = "lamp_A", .mean = -1, .amplitude = 2, .wave = Wave::ramp}}};
  double now_s{0};
};

TEST(DconInstrument, AnswersWithItsInputsOfTheMoment) {
  Bench bench;
  EXPECT_EQ(bench.say("$01M\r"), "!017017\r");
  EXPECT_EQ(bench.say("#0"), "");
  bench.now_s = 14.99;  // it thinks for 10 ms
  EXPECT_EQ(bench.say("1\r"), ">+002.500+000.000\r");
}

TEST(DconInstrument, RefusesWhatItDoesNotKnowAndIgnoresOtherAddresses) {
  Bench bench;
  EXPECT_EQ(bench.say("$01X\r"), "?01\r");
  EXPECT_EQ(bench.say("#02\r"), "");
}

TEST(DconInstrument, HasTheFaultsOfAnInstrument) {
  Bench bench;
  bench.module.set_saturated(true);
  EXPECT_EQ(bench.say("#01\r"), ">+9999+9999\r");
  bench.module.set_saturated(false);
  const std::string before = bench.say("#01\r");
  bench.module.set_frozen(true);
  bench.now_s = 10;
  EXPECT_EQ(bench.say("#01\r"), before);
  bench.module.set_silent(true);
  EXPECT_EQ(bench.say("#01\r"), "");
}

}  // namespace
}  // namespace mgtd::rig
