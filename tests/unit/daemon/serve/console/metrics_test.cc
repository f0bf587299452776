// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/metrics.h"

#include <gmock/gmock.h>

#include <regex>
#include <sstream>

namespace mgtd::daemon::serve::console {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

StatusReport report() {
  StatusReport out;
  out.rig = "rig \"7\"\n";
  out.software = "mgtd test";
  out.sampler = {.epochs = 100, .gaps = 3, .rate_hz = 49.9, .skew_bound_s = std::nullopt};
  out.devices.push_back({.name = "s1", .driver = "obsdaq", .port = "/dev/x", .health = {}});
  out.devices[0].health.state = LinkState::live;
  out.devices[0].health.frames = 55;
  out.devices[0].health.state_since = Instant{std::chrono::seconds(5)};
  out.devices[0].rate_hz = 49.5;
  out.at.mono = Instant{std::chrono::seconds(12)};
  out.calibration_use.age_s = 3600;
  out.inputs.push_back(
      {.name = "motor_A", .device = "aux1", .input = "1", .unit = "A", .value = 0.25, .heard = {}});
  out.inputs.push_back(
      {.name = "off_A", .device = "aux1", .input = "2", .unit = "A", .value = {}, .heard = {}});
  return out;
}

TEST(Metrics, SayWhatIsKnownAndNothingElse) {
  const std::string text = metrics(report(), 7);
  EXPECT_THAT(text, HasSubstr("mgtd_epochs_total 100\n"));
  EXPECT_THAT(text, HasSubstr("mgtd_gap_epochs_total 3\n"));
  EXPECT_THAT(text, HasSubstr("mgtd_console_refused_total 7\n"));
  EXPECT_THAT(text, HasSubstr("mgtd_device_live{device=\"s1\"} 1\n"));
  EXPECT_THAT(text, HasSubstr("mgtd_device_frame_rate_hertz{device=\"s1\"} 49.5\n"));
  EXPECT_THAT(text, HasSubstr("mgtd_device_state_seconds{device=\"s1\"} 7\n"));
  EXPECT_THAT(text, HasSubstr("mgtd_calibration_age_seconds 3600\n"));
  EXPECT_THAT(text, HasSubstr("mgtd_input{name=\"motor_A\",unit=\"A\"} 0.25\n"));
  EXPECT_THAT(text, HasSubstr(R"(mgtd_info{rig="rig \"7\" ",software="mgtd test"} 1)"));
  EXPECT_THAT(text, Not(HasSubstr("off_A")));
  EXPECT_THAT(text, Not(HasSubstr("mgtd_skew_bound_seconds ")));
}

TEST(Metrics, SayThatTheCalibrationIsDoubted) {
  StatusReport seen = report();
  const auto doubted = [&](const char* state) {
    seen.criticism.state = state;
    return metrics(seen, 0).find("mgtd_calibration_doubted 1\n") != std::string::npos;
  };
  for (const char* state : {"suspect", "identity", "exchanged", "turned"})
    EXPECT_TRUE(doubted(state)) << state;
  for (const char* state : {"none", "learning", "ok", "near source"}) EXPECT_FALSE(doubted(state)) << state;
}

/// The grammar of the exposition format.
TEST(Metrics, EveryLineIsACommentOrAValue) {
  const std::regex comment("# (HELP|TYPE) mgtd_[a-z_]+ .+");
  const std::regex value(R"re(mgtd_[a-z_]+(\{([a-z]+="([^"\\]|\\.)*",?)+\})? -?[0-9][0-9.e+-]*)re");
  std::istringstream lines(metrics(report(), 7));
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count)
    EXPECT_TRUE(std::regex_match(line, comment) || std::regex_match(line, value)) << line;
  EXPECT_GT(count, 30);
}

}  // namespace
}  // namespace mgtd::daemon::serve::console
