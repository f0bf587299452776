// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/log.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <sstream>

namespace mgtd::daemon::app {
namespace {

using ::testing::HasSubstr;

class QuietLogTest : public ::testing::Test {
 protected:
  QuietLogTest() : before_(spdlog::default_logger()) {
    auto logger = std::make_shared<spdlog::logger>(
        "test", std::make_shared<spdlog::sinks::ostream_sink_mt>(out_, true));
    logger->set_pattern("%v");
    spdlog::set_default_logger(std::move(logger));
  }
  ~QuietLogTest() override { spdlog::set_default_logger(before_); }

  static Instant at(double t_s) { return Instant{from_seconds(1000 + t_s)}; }
  [[nodiscard]] long lines() const {
    const std::string text = out_.str();
    return std::count(text.begin(), text.end(), '\n');
  }

  std::ostringstream out_;
  std::shared_ptr<spdlog::logger> before_;
  QuietLog log_;
};

TEST_F(QuietLogTest, WhatRepeatsIsWrittenOnceAMinuteWithACount) {
  for (int second = 0; second < 61; ++second) {
    log_.warn("s2", "silent", at(second));
    log_.tick(at(second));
  }
  EXPECT_EQ(out_.str(), "s2: silent\ns2: silent (59 more since the last line)\n");
}

/// A loose plug: three words for each time it comes and goes, every two seconds, for a day.
TEST_F(QuietLogTest, ADeviceThatComesAndGoesDoesNotFillTheDisk) {
  constexpr int kSeconds = 86'400;
  for (int second = 0; second < kSeconds; ++second) {
    if (second % 2 == 0) {
      log_.warn("s2", "gone: the port is gone", at(second));
      log_.warn("s2", "probing: asking the device who it is", at(second + 0.3));
      log_.info("s2", "live, obsDAQ", at(second + 1.6));
    }
    log_.tick(at(second + 1.7));
  }
  EXPECT_LE(lines(), (QuietLog::kLinesAMinute + 1) * kSeconds / 60 + QuietLog::kLinesAMinute);
  EXPECT_GT(lines(), kSeconds / 60);
}

/// The last word counts: that it is live again must not stay untold.
TEST_F(QuietLogTest, TheLastOfThoseHeldBackIsToldWhenTheMinuteIsOver) {
  for (int i = 0; i < 20; ++i) log_.warn("s2", fmt::format("silent, {}", i), at(0.1 * i));
  log_.info("s2", "live", at(3));
  EXPECT_EQ(lines(), QuietLog::kLinesAMinute);
  log_.tick(at(59));
  EXPECT_EQ(lines(), QuietLog::kLinesAMinute);
  log_.tick(at(61));
  EXPECT_THAT(out_.str(), HasSubstr("s2: live (8 more since the last line)\n"));
  log_.tick(at(62));
  EXPECT_EQ(lines(), QuietLog::kLinesAMinute + 1);
}

TEST_F(QuietLogTest, OneDeviceDoesNotSilenceAnother) {
  for (int i = 0; i < 20; ++i) log_.warn("s2", fmt::format("silent, {}", i), at(0.1 * i));
  log_.warn("s3", "gone", at(2.1));
  EXPECT_THAT(out_.str(), HasSubstr("s3: gone\n"));
}

}  // namespace
}  // namespace mgtd::daemon::app
