// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/obsdaq_instrument.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace mgtd::rig {
namespace {

using ::testing::MatchesRegex;

Scenario ideal(bool palmacq) {
  Scenario scenario;
  scenario.truth = *rig_named("ideal", 1);
  scenario.palmacq = palmacq;
  scenario.noise.noise_nT = 0;
  scenario.table_accuracy_deg = 0;
  return scenario;
}

struct ObsdaqBench {
  explicit ObsdaqBench(bool palmacq = false)
      : world(ideal(palmacq)), instrument(world, 0, 1'580'481'457.617) {}
  std::string say(const std::string& bytes) {
    instrument.receive(bytes, now_s);
    return instrument.take_output();
  }
  World world;
  ObsdaqInstrument instrument;
  double now_s{0};
};

/// The captured dialogues of the digitiser.
TEST(ObsdaqInstrument, AnswersAsTheCapturedDialogues) {
  ObsdaqBench bench;
  EXPECT_EQ(bench.say("$01M\r"), "!01<obsDAQ V5.5.7>\r");
  EXPECT_EQ(bench.say("$010WS02010233\r"), "!0102010233\r");
  EXPECT_EQ(bench.say("#01PP10000500\r"), "!0110000500\r");
  EXPECT_EQ(bench.say("#01CS\r"), "!01\r");
}

TEST(ObsdaqInstrument, RefusesNonsenseAndIgnoresAnotherAddress) {
  ObsdaqBench bench;
  EXPECT_EQ(bench.say("$01XYZ\r"), "?01\r");
  EXPECT_EQ(bench.say("#01PPQQQQ0600\r"), "?01\r");
  EXPECT_EQ(bench.say("$02M\r"), "");
}

TEST(ObsdaqInstrument, StreamsAtItsRateUntilTheQuickStop) {
  ObsdaqBench bench;
  bench.say("#01PP0C000600\r");  // 20 ms
  bench.say("#01CS\r");
  bench.now_s = 1.0;
  bench.instrument.advance(bench.now_s);
  const std::string said = bench.instrument.take_output();
  // Its oscillator is 20 ppm fast: the fiftieth sample is just in.
  EXPECT_EQ(std::count(said.begin(), said.end(), '*'), 50);
  EXPECT_THAT(said.substr(0, 42), MatchesRegex("\\*[0-9A-F]+L:[0-9A-F]+\r"));
  bench.say(std::string(30, '|'));
  bench.now_s = 2.0;
  bench.instrument.advance(bench.now_s);
  EXPECT_EQ(bench.instrument.take_output(), "");
}

TEST(ObsdaqInstrument, PalmAcqPutsTheTimeInFront) {
  ObsdaqBench bench(true);
  EXPECT_EQ(bench.say("$01M\r"), "");  // not before the way through is open
  EXPECT_EQ(bench.say("SM:TRP\r"), "AM:TRP,001B\r");
  EXPECT_EQ(bench.say("$01M\r"), "!01<obsDAQ V5.5.7>\r");
  bench.say("#01PP0C000600\r#01CS\r");
  bench.say(std::string("\x00\x1b", 2) + "SM:CMD\rSF:R\r");
  bench.now_s = 0.05;
  bench.instrument.advance(bench.now_s);
  EXPECT_THAT(bench.instrument.take_output().substr(0, 25),
              MatchesRegex(":R,00,[0-9]{6}\\.[0-9]{6}\\.[0-9]{3},\\*"));
}

}  // namespace
}  // namespace mgtd::rig
