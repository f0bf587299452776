// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/lane_history.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "daemon/serve/console/lane_request.h"

namespace mgtd::daemon::serve::console {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kStart_s = 1'795'255'200;

TensorSample sample(double t_s, double f_nT) {
  TensorSample out;
  out.t.wall.ns = static_cast<std::int64_t>(std::llround(1e9 * (kStart_s + t_s)));
  out.f_nT = f_nT;
  out.closure.chi2 = std::numeric_limits<double>::quiet_NaN();
  return out;
}

/// F as a sine of an hour, with one spike.
LaneHistory recorded(double hours, double spike_at_s = 1000) {
  LaneHistory out;
  for (double t_s = 0; t_s < 3600 * hours; t_s += 0.5) {
    const double spike = std::abs(t_s - spike_at_s) < 0.1 ? 500 : 0;
    out.add(sample(t_s, 50'000 + 10 * std::sin(2 * M_PI * t_s / 3600) + spike), {20.5}, {});
  }
  return out;
}

TEST(LaneHistory, EverySampleLiesWithinItsColumn) {
  const LaneHistory history = recorded(1.5);
  const auto lane = history.lane("f", 3600, 300);
  ASSERT_TRUE(lane);
  EXPECT_LE(lane->mean.size(), 301U);
  EXPECT_NEAR(std::fmod(lane->from_s, lane->step_s), 0, 1e-6) << "columns do not move as time goes on";
  for (std::size_t i = 0; i < lane->mean.size(); ++i) {
    ASSERT_TRUE(std::isfinite(lane->mean[i])) << i;
    EXPECT_LE(lane->least[i], lane->mean[i]);
    EXPECT_GE(lane->greatest[i], lane->mean[i]);
    const double middle_s = lane->from_s + (static_cast<double>(i) + 0.5) * lane->step_s - kStart_s;
    const double truth = 50'000 + 10 * std::sin(2 * M_PI * middle_s / 3600);
    EXPECT_LE(lane->least[i], truth + 0.02);
    EXPECT_GE(lane->greatest[i], truth - 0.02);
  }
}

TEST(LaneHistory, ASpikeStaysInSightHoweverLongTheWindow) {
  const LaneHistory history = recorded(8, 3600 * 7.5);
  for (const double window_s : {3600.0, 21'600.0, 86'400.0}) {
    const auto lane = history.lane("f", window_s, 200);
    ASSERT_TRUE(lane);
    double most = 0;
    for (const double v : lane->greatest) most = std::fmax(most, v);
    EXPECT_GT(most, 50'480) << window_s;
  }
}

TEST(LaneHistory, WhatWasNotMeasuredIsEmptyAndHasItsReason) {
  LaneHistory history;
  for (double t_s = 0; t_s < 60; t_s += 0.5) history.add(sample(t_s, 50'000), {}, {});
  Gap gap{121, 200, {}, "s2: silent"};
  gap.at.wall.ns = static_cast<std::int64_t>(1e9 * (kStart_s + 60));
  history.add(gap);
  for (double t_s = 100; t_s < 160; t_s += 0.5) history.add(sample(t_s, 50'000), {}, {});
  const auto gaps = history.gaps(600);
  ASSERT_EQ(gaps.size(), 1U);
  EXPECT_EQ(gaps[0].why, "s2: silent");
  EXPECT_NEAR(gaps[0].from_s - kStart_s, 59.5, 0.6);
  EXPECT_NEAR(gaps[0].to_s - kStart_s, 100, 0.6);
  const auto lane = history.lane("f", 160, 80);
  ASSERT_TRUE(lane);
  EXPECT_TRUE(std::isnan(lane->mean[lane->mean.size() / 2]));
  EXPECT_TRUE(std::isfinite(lane->mean.back()));
}

TEST(LaneHistory, ChannelsAreThoseThatHaveValues) {
  LaneHistory history;
  TensorSample one = sample(0, 50'000);
  one.g_nT_per_m = {std::nan(""), std::nan(""), 1, std::nan(""), 2, 3};
  const std::vector<InputValue> inputs{{"motor_A", 0.5}};
  history.add(one, {21, std::nan("")}, inputs);
  EXPECT_THAT(history.channels(), Contains("zz"));
  EXPECT_THAT(history.channels(), Contains("T1"));
  EXPECT_THAT(history.channels(), Contains("motor_A"));
  EXPECT_THAT(history.channels(), Not(Contains("xx")));
  EXPECT_THAT(history.channels(), Not(Contains("T2")));
  EXPECT_THAT(history.channels(), Not(Contains("chi2")));
  EXPECT_FALSE(history.lane("xx", 60, 10));
}

TEST(LaneHistory, AClockThatIsSetBackBeginsAnew) {
  LaneHistory history;
  for (double t_s = 0; t_s < 100; t_s += 1) history.add(sample(1000 + t_s, 1), {}, {});
  for (double t_s = 0; t_s < 10; t_s += 1) history.add(sample(t_s, 2), {}, {});
  const auto lane = history.lane("f", 60, 30);
  ASSERT_TRUE(lane);
  EXPECT_EQ(lane->mean.back(), 2);
}

TEST(LaneRequest, ReadsWhatIsAskedAndRefusesTheRest) {
  const auto good = parse_lane_request("channel=xx&window_s=3600&columns=600");
  ASSERT_TRUE(good);
  EXPECT_EQ(good->channel, "xx");
  EXPECT_EQ(good->window_s, 3600);
  EXPECT_EQ(good->columns, 600U);
  for (const char* bad : {"", "channel=", "channel", "channel=xx&columns=0", "channel=xx&columns=1e9",
                          "channel=xx&window_s=nan", "channel=xx&window_s=-5", "channel=xx&color=red"})
    EXPECT_FALSE(parse_lane_request(bad)) << bad;
}

TEST(LaneRequest, TheAnswerIsNullWhereThereIsNothing) {
  LaneHistory history;
  history.add(sample(100, 50'000.1234567), {}, {});
  const auto text = answer({.channel = "f", .window_s = 20, .columns = 10}, history);
  ASSERT_TRUE(text);
  const auto json = nlohmann::json::parse(*text);
  EXPECT_EQ(json["channel"], "f");
  EXPECT_TRUE(json["mean"].front().is_null());
  EXPECT_EQ(json["mean"].back(), 50'000.123);
  const auto unknown = answer({.channel = "<script>", .window_s = 20, .columns = 10}, history);
  ASSERT_FALSE(unknown);
  EXPECT_THAT(unknown.error().message, HasSubstr("no such channel"));
}

}  // namespace
}  // namespace mgtd::daemon::serve::console
