// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/settle.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/unit/daemon/serve/streams.h"

namespace mgtd::daemon::run {
namespace {

using test::stamp_at;

TableReading table(double t_s, bool on_target) {
  TableReading r;
  r.arrival = stamp_at(t_s);
  r.moving = !on_target;
  r.on_target = on_target;
  return r;
}

/// The table moves from 0 to 2 s; then s3.y decays by decay_nT exp(-t/tau). Gives the outcome and when it
/// fell.
struct Ended {
  SettleOutcome outcome;
  double at_s{0};
};
Ended settle(double decay_nT, double tau_s, double noise_nT, SettleConfig config = {},
             double known_noise_nT = 1) {
  config.noise_nT = known_noise_nT;
  Settle judge(config, stamp_at(0).mono);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0, noise_nT);
  for (int k = 0;; ++k) {
    const double t_s = k / config.rate_hz;
    judge.add(table(t_s, t_s >= 2));
    Epoch e;
    e.t = stamp_at(t_s);
    for (auto& y : e.y_nT) y = {normal(random), normal(random), normal(random)};
    e.y_nT[2].y() += t_s < 2 ? 5000 * t_s : decay_nT * std::exp(-(t_s - 2) / tau_s);
    judge.add(EpochOrGap{e});
    const SettleOutcome v = judge.judge(stamp_at(t_s).mono);
    if (v.state != SettleState::settling) return {v, t_s - 2};
  }
}

TEST(Settle, QuietFieldNeedsOneWindow) {
  const Ended o = settle(0, 1, 1);
  EXPECT_EQ(o.outcome.state, SettleState::settled);
  EXPECT_LT(o.at_s, 1.5);
  EXPECT_GE(o.at_s, 0.5);
}

/// At the rate of the slowest digitisers a window of one second holds too few samples.
TEST(Settle, TheWindowIsLongerWhereSamplesAreRare) {
  for (const double rate_hz : {0.5, 1.0, 3.0, 5.0}) {
    SCOPED_TRACE(rate_hz);
    SettleConfig config;
    config.rate_hz = rate_hz;
    const Ended quiet = settle(0, 1, 1, config);
    EXPECT_EQ(quiet.outcome.state, SettleState::settled) << quiet.outcome.measured;
  }
  SettleConfig slow;
  slow.rate_hz = 1;
  EXPECT_EQ(settle(5000, 20, 1, slow).outcome.state, SettleState::timed_out);
}

TEST(Settle, WaitsForADecayAndNotLonger) {
  const Ended o = settle(500, 1, 1);
  EXPECT_EQ(o.outcome.state, SettleState::settled);
  EXPECT_GT(o.at_s, 4);  // 500 exp(-4) = 9 nT are still to come
  EXPECT_LT(o.at_s, 8);  // 500 exp(-7) = 0.5 nT are within the noise of the slope
}

TEST(Settle, TimesOutNamingTheAxisThatDrifts) {
  const Ended o = settle(5000, 30, 1);
  EXPECT_EQ(o.outcome.state, SettleState::timed_out);
  EXPECT_TRUE(o.outcome.measured.starts_with("s3.y drifts")) << o.outcome.measured;
  EXPECT_NEAR(o.at_s, 20, 0.1);
  EXPECT_FALSE(o.outcome.remedy.empty());
}

TEST(Settle, ScatterFarAboveTheKnownNoiseIsADisturbance) {
  EXPECT_EQ(settle(0, 1, 8).outcome.state, SettleState::disturbed);
  EXPECT_EQ(settle(0, 1, 8, {}, 0).outcome.state, SettleState::settled);  // no noise known: not judged
}

TEST(Settle, TableThatNeverArrivesTimesOut) {
  Settle judge({}, stamp_at(0).mono);
  judge.add(table(1, false));
  EXPECT_EQ(judge.judge(stamp_at(100).mono).state, SettleState::settling);
  EXPECT_EQ(judge.judge(stamp_at(121).mono).state, SettleState::timed_out);
  judge.add(table(122, true));
  EXPECT_EQ(judge.judge(stamp_at(123).mono).state, SettleState::timed_out);
}

TEST(Settle, AReadingFromBeforeTheCommandIsNoArrival) {
  Settle judge({}, stamp_at(10).mono);
  judge.add(table(9.99, true));
  EXPECT_FALSE(judge.stopped());
  judge.add(table(12, true));
  judge.add(table(12.1, false));  // swings out again
  EXPECT_FALSE(judge.stopped());
}

TEST(Settle, WithoutEpochsNothingIsSettled) {
  Settle judge({}, stamp_at(0).mono);
  judge.add(table(1, true));
  EXPECT_EQ(judge.judge(stamp_at(15).mono).state, SettleState::settling);
  EXPECT_EQ(judge.judge(stamp_at(22).mono).state, SettleState::timed_out);
}

}  // namespace
}  // namespace mgtd::daemon::run
