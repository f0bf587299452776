// SPDX-License-Identifier: Apache-2.0
// Sensors that change places, or turn, after they were calibrated: nothing wrong is streamed unflagged, and
// the operator is told which, with serial numbers and without, by the stream and by a run.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "calib/criticism/tests/exchange_in_run.h"
#include "calib/report/rearrangement_text.h"
#include "daemon/acquire/calibrated_with.h"
#include "tests/scenario/virtual_daemon.h"
#include "tests/scenario/virtual_stream.h"

namespace mgtd {
namespace {

using namespace mgtd::daemon;
using nlohmann::json;
using test::scenario_of;
using test::VirtualDaemon;
using test::VirtualStream;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

constexpr const char* kRig = "[rig]\nname = \"table6\"\nparameters = \"table6\"\nseed = 6\n";

std::vector<InstrumentIdentity> calibrated_ones() {
  std::vector<InstrumentIdentity> out;
  for (int i = 1; i <= kSensors; ++i)
    out.push_back({fmt::format("s{}", i), fmt::format("<obsDAQ V5.5.7>, serial {}", 1000 + i)});
  return out;
}

/// A stream with a perfect calibration that knows the instruments of this rig.
class Calibrated : public ::testing::Test {
 protected:
  void begin(const std::string& more = "") {
    stream.emplace(scenario_of(kRig + more));
    calib::calibration::Calibration c = *test::perfect_calibration(stream->rig.world().scenario());
    c.checks = daemon::acquire::to_checks(calibrated_ones());
    c.seal();
    stream->on_line = [this](const RingRecord& record) {
      json line = json::parse(record.line);
      if (line.at("class") == "TENSOR") samples.push_back(std::move(line));
    };
    stream->start();
    stream->use(std::make_shared<const calib::calibration::Calibration>(c));
    stream->run(10);
    ASSERT_GT(samples.size(), 200U);
    for (std::size_t i = samples.size() - 100; i < samples.size(); ++i)
      ASSERT_EQ(flags(samples[i]), "") << samples[i].dump();
    samples.clear();
  }
  /// But for what the alignment to common times adds.
  static std::string flags(const json& sample) {
    std::string out;
    for (const std::string flag : sample.at("flags"))
      if (flag != "interpolated" && flag != "clock_unsettled") out += (out.empty() ? "" : " ") + flag;
    return out;
  }
  std::optional<VirtualStream> stream;
  std::vector<json> samples;
};

TEST_F(Calibrated, ExchangedPlugsAreRawFromTheFirstSampleAndNamed) {
  begin();
  stream->fault("exchange fluxgate2 fluxgate4");
  stream->run(0.1);  // what was measured before the plugs were out
  samples.clear();
  stream->run(10);
  ASSERT_GT(samples.size(), 100U);
  for (const json& sample : samples) {
    ASSERT_EQ(flags(sample), "uncalibrated identity") << sample.dump();
    ASSERT_TRUE(sample.at("cal").is_null());
    ASSERT_TRUE(sample.at("g_sd_nT_per_m").at("yy").is_null());
  }
  EXPECT_EQ(
      stream->pipeline().instruments().measured(),
      "s2 and s4 are exchanged: the device with serial number 1002, calibrated as s2, now answers on the "
      "port of s4, and the device with serial number 1004, calibrated as s4, now answers on the port of s2");
  EXPECT_THAT(stream->pipeline().instruments().remedy(), HasSubstr("swap the plugs back"));
  stream->fault("exchange fluxgate2 fluxgate4");
  stream->run(10);
  EXPECT_EQ(flags(samples.back()), "");
  EXPECT_FALSE(samples.back().at("cal").is_null());
}

TEST_F(Calibrated, WithoutSerialNumbersTheReadingsTellAnExchange) {
  begin("[sensors]\ntells_serial = false\n");
  stream->fault("exchange fluxgate2 fluxgate4");
  stream->run(0.1);
  samples.clear();
  stream->run(10);
  ASSERT_GT(samples.size(), 100U);
  EXPECT_EQ(flags(samples.front()), "suspect") << "flagged on the very sample";
  EXPECT_GT(samples.front().at("closure").at("chi2"), 1e3);
  for (std::size_t i = 0; i < samples.size(); ++i)
    ASSERT_EQ(flags(samples[i]), i < 9 ? "suspect" : "uncalibrated identity") << i;
  ASSERT_EQ(stream->pipeline().finding().state, calib::criticism::live::LiveState::exchanged);
  EXPECT_THAT(stream->pipeline().finding().measured, HasSubstr("s2 and s4 are exchanged"));
  stream->fault("exchange fluxgate2 fluxgate4");
  stream->run(10);
  EXPECT_EQ(flags(samples.back()), "");
}

TEST_F(Calibrated, ATurnedSensorIsNamedBeforeASourceNearby) {
  begin();
  stream->fault("turn fluxgate3");
  stream->run(0.1);
  samples.clear();
  stream->run(5);
  EXPECT_NE(flags(samples.front()), "");
  EXPECT_EQ(flags(samples.back()), "uncalibrated identity");
  ASSERT_EQ(stream->pipeline().finding().state, calib::criticism::live::LiveState::turned);
  EXPECT_THAT(stream->pipeline().finding().measured, HasSubstr("s3 is turned by 90 deg about Z"));
}

class ARun : public ::testing::Test {
 protected:
  explicit ARun(const std::string& more = "") : daemon(scenario_of(kRig + more)) {
    EXPECT_TRUE(daemon.run(60, [&] { return daemon.all_live(); }));
  }
  void start(std::vector<InstrumentIdentity> calibrated) {
    daemon::run::RunConfig config = daemon.run_config();
    config.calibrated = std::move(calibrated);
    daemon.start(*daemon::plan::make_plan(
                     {.step_deg = 20, .random = 12, .revisits = 2, .dwell_short_s = 2, .dwell_long_s = 3},
                     daemon.table().limits()),
                 config);
  }
  bool run_to(RunState state) {
    return daemon.run(600, [&] { return daemon.status->state == state && !daemon.status->goes_on; });
  }
  VirtualDaemon daemon;
};

TEST_F(ARun, PausesBeforeItsFirstPoseAndSaysWhich) {
  daemon.fault("exchange fluxgate2 fluxgate4");
  daemon.run(5);
  start(calibrated_ones());
  ASSERT_TRUE(run_to(RunState::paused)) << daemon.status->message;
  EXPECT_TRUE(daemon.poses.poses.empty());
  EXPECT_THAT(
      daemon.status->message,
      AllOf(HasSubstr("s2 and s4 are exchanged: the device with serial number 1002, calibrated as s2, "
                      "now answers on the port of s4"),
            HasSubstr("swap the plugs back")));
  daemon.tell(daemon::run::Request::resume);
  ASSERT_TRUE(run_to(RunState::dwelling)) << "an operator who means it so goes on";
  EXPECT_THAT(daemon.records, Contains(HasSubstr("the operator goes on although s2 and s4 are exchanged")));
}

TEST_F(ARun, DoesNotMixTheInstrumentsOfItsPoses) {
  start({});
  ASSERT_TRUE(daemon.run(600, [&] { return daemon.poses.poses.size() >= 5; }));
  EXPECT_THAT(daemon.instruments, Contains(calibrated_ones().at(1)));
  daemon.fault("exchange fluxgate2 fluxgate4");
  ASSERT_TRUE(run_to(RunState::paused)) << daemon.status->message;
  daemon.run(5);
  EXPECT_THAT(daemon.status->message, HasSubstr("s2 and s4 are exchanged"));
  const std::size_t poses = daemon.poses.poses.size();
  daemon.tell(daemon::run::Request::resume);
  daemon.run(30);
  EXPECT_EQ(daemon.status->state, RunState::paused);
  EXPECT_EQ(daemon.poses.poses.size(), poses);
  daemon.fault("exchange fluxgate2 fluxgate4");
  daemon.run(5);
  EXPECT_THAT(daemon.status->message, HasSubstr("answers in its place again"));
  daemon.tell(daemon::run::Request::resume);
  ASSERT_TRUE(daemon.run(3600)) << daemon.status->message;
  EXPECT_EQ(daemon.finished->state, RunState::done);
}

class ARunWithoutSerialNumbers : public ARun {
 protected:
  ARunWithoutSerialNumbers() : ARun("[sensors]\ntells_serial = false\n") {}
};

TEST_F(ARunWithoutSerialNumbers, NamesTheExchangeFromItsPoses) {
  start({});
  ASSERT_TRUE(daemon.run(3600, [&] { return daemon.poses.poses.size() >= 14; }));
  EXPECT_FALSE(calib::criticism::tests::exchange_in_run(daemon.poses, std::nullopt));
  daemon.fault("exchange fluxgate2 fluxgate4");
  ASSERT_TRUE(daemon.run(3600)) << daemon.status->message;
  const auto found = calib::criticism::tests::exchange_in_run(daemon.poses, std::nullopt);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->from_pose, daemon.poses.poses.at(14).number);
  EXPECT_THAT(calib::report::exchange_text(*found), HasSubstr("s2 and s4 are exchanged from pose 15 on"));
  EXPECT_LT(found->residual_nT, 2);
  EXPECT_GT(found->without_nT, 50);
}

TEST(ExchangedSince, IsToldByEachOthersParameters) {
  const auto before = test::perfect_calibration(scenario_of(kRig));
  calib::calibration::Calibration now = *before;
  for (calib::sensor::SensorModel& sensor : now.sensors) sensor.offset_nT += Eigen::Vector3d(3, -4, 2);
  EXPECT_FALSE(calib::criticism::tests::exchanged_since(*before, now)) << "sensors age";
  std::swap(now.sensors[1], now.sensors[3]);
  const auto found = calib::criticism::tests::exchanged_since(*before, now);
  ASSERT_TRUE(found);
  EXPECT_EQ(calib::report::rearrangement_text(*found), "s2 and s4 are exchanged");
  now.sensors[1].offset_nT += Eigen::Vector3d(0, 60, 0);
  EXPECT_FALSE(calib::criticism::tests::exchanged_since(*before, now)) << "that is another sensor";
}

}  // namespace
}  // namespace mgtd
