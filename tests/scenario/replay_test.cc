// SPDX-License-Identifier: Apache-2.0
// The stream made again of the journal, to the last byte, whatever happened.
#include "daemon/acquire/replay.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>

#include "tests/scenario/virtual_stream.h"

namespace mgtd::daemon {
namespace {

using test::perfect_calibration;
using test::scenario_of;
using test::VirtualStream;

rig::Scenario table6() {
  return scenario_of("[rig]\nname = \"table6\"\nparameters = \"table6\"\nseed = 6\n");
}

/// A virtual daemon, what its clients got, and its journal as bytes.
struct Recorded {
  explicit Recorded(const rig::Scenario& scenario) : daemon(scenario), journal(encode_header({"rig", "j"})) {
    daemon.on_line = [this](const RingRecord& record) { lines.emplace_back(record.line); };
    daemon.on_raw = [this](const RawRecord& record) { encoder.encode(record, journal); };
    daemon.start();
  }
  VirtualStream daemon;
  std::vector<std::string> lines;
  RawLogEncoder encoder;
  std::string journal;
};

struct Replayed {
  std::vector<std::string> lines;
  acquire::ReplayCounts counts;
};

Replayed replay(const std::string& journal,
                std::shared_ptr<const calib::calibration::Calibration> instead = nullptr) {
  Replayed out;
  acquire::Replay again([&](std::string_view line) { out.lines.emplace_back(line); }, std::move(instead));
  RawLogDecoder decoder;
  decoder.feed(journal);
  while (const auto record = decoder.next()) {
    const auto fed = again.feed(*record);
    EXPECT_TRUE(fed) << fed.error().text();
  }
  EXPECT_TRUE(decoder.finish());
  out.counts = again.counts();
  return out;
}

void expect_same(const Recorded& live, const Replayed& again) {
  ASSERT_EQ(again.lines.size(), live.lines.size());
  for (std::size_t i = 0; i < live.lines.size(); ++i) ASSERT_EQ(again.lines[i], live.lines[i]) << i;
  EXPECT_FALSE(again.counts.parted) << *again.counts.parted;
  EXPECT_EQ(again.counts.bytes_lost, 0U);
}

std::set<std::string> flags_in(const std::vector<std::string>& lines) {
  std::set<std::string> out;
  for (const std::string& line : lines) {
    const auto object = nlohmann::json::parse(line);
    if (!object.contains("flags")) continue;
    for (const auto& flag : object["flags"]) out.insert(flag);
  }
  return out;
}

/// Everything that can happen to a stream: faults of every kind on every port, a table that moves, clocks
/// that are set, calibrations that come and go.
TEST(Replay, MakesTheSameStreamToTheLastByte) {
  Recorded live(table6());
  VirtualStream& daemon = live.daemon;
  daemon.run(30);
  daemon.use(perfect_calibration(table6()));
  daemon.begin_probe();
  daemon.order({TableOrder::What::home, {}});
  daemon.run(60);
  int azimuth_deg = 0;
  for (const char* fault :
       {"unplug fluxgate1 for 3", "unplug fluxgate3 for 5", "stall fluxgate2 for 4", "freeze fluxgate4 for 6",
        "garbage fluxgate1", "torn fluxgate2 for 10", "saturate fluxgate3 for 4", "clock fluxgate1",
        "unplug scalar for 5", "unplug table for 5", "stall table for 5", "garbage table"}) {
    daemon.order({TableOrder::What::move, {to_rad(azimuth_deg += 20), to_rad(5), 0}});
    daemon.run(2);
    daemon.fault(fault);
    daemon.run(18);
  }
  daemon.wall_step_s = -3600.5;
  daemon.run(5);
  daemon.order({TableOrder::What::stop, {}});
  daemon.stop_probe();
  daemon.wall_step_s = 2;
  daemon.run(10);
  daemon.use(nullptr);
  daemon.run(5);
  const auto flags = flags_in(live.lines);
  for (const char* flag :
       {"interpolated", "calibrating", "uncalibrated", "frozen", "saturated", "clock_unsettled"}) {
    EXPECT_TRUE(flags.contains(flag)) << flag << ": the test does not test what it should";
  }
  const Replayed again = replay(live.journal);
  expect_same(live, again);
  EXPECT_GT(again.counts.samples, 12'000U);
  EXPECT_GT(again.counts.gaps, 5U);
  RecordProperty("samples", fmt::format("{}", again.counts.samples));
  RecordProperty("journal_bytes_per_s",
                 fmt::format("{:.0f}", static_cast<double>(live.journal.size()) / daemon.t_s));
}

TEST(Replay, GoesThroughLivesAsTheyWere) {
  Recorded live(table6());
  live.daemon.run(20);
  const std::uint64_t next = live.daemon.next_seq() + 500;
  live.daemon.start(next, Gap{live.daemon.next_seq(), next - 1, live.daemon.now(), "the daemon was stopped"});
  live.daemon.use(perfect_calibration(table6()));
  live.daemon.run(20);
  const Replayed again = replay(live.journal);
  expect_same(live, again);
  EXPECT_EQ(again.counts.lives, 2U);
}

TEST(Replay, AnotherCalibrationGivesOtherNumbersAtTheSameEpochs) {
  Recorded live(table6());
  live.daemon.run(20);
  const auto calibration = perfect_calibration(table6());
  const Replayed again = replay(live.journal, calibration);
  ASSERT_EQ(again.lines.size(), live.lines.size());
  const auto before = nlohmann::json::parse(live.lines.back()),
             after = nlohmann::json::parse(again.lines.back());
  EXPECT_EQ(before["seq"], after["seq"]);
  EXPECT_EQ(before["t_ns"], after["t_ns"]);
  EXPECT_TRUE(before["cal"].is_null());
  EXPECT_EQ(after["cal"], calibration->id);
  EXPECT_NEAR(after["f_nT"].get<double>(), table6().f_nT, 5);
}

/// The test of the tests: a byte that was not there is seen, and so is an answer that went elsewhere.
TEST(Replay, AJournalThatWasTouchedIsNoticed) {
  Recorded live(table6());
  live.daemon.run(20);
  std::string touched = encode_header({"rig", "j"});
  RawLogEncoder encoder;
  RawLogDecoder decoder;
  decoder.feed(live.journal);
  int received = 0;
  bool sent_changed = false;
  while (auto record = decoder.next()) {
    std::string bytes(record->bytes);
    record->bytes = bytes;
    if (record->direction == RawDirection::received && record->device == 2 && ++received == 700) continue;
    if (record->direction == RawDirection::sent && record->device == 1 &&
        !std::exchange(sent_changed, true)) {
      bytes[0] = '!';
    }
    encoder.encode(*record, touched);
  }
  const Replayed again = replay(touched);
  EXPECT_NE(again.lines, live.lines);
  ASSERT_TRUE(again.counts.parted);
  EXPECT_THAT(*again.counts.parted, ::testing::HasSubstr("s2"));
}

/// Fed until it refuses.
Error refusal(const std::string& journal, std::shared_ptr<const calib::calibration::Calibration> instead) {
  acquire::Replay again([](std::string_view) {}, std::move(instead));
  RawLogDecoder decoder;
  decoder.feed(journal);
  while (const auto record = decoder.next())
    if (auto fed = again.feed(*record); !fed) return fed.error();
  return {ErrorCode::internal, "nothing was refused", {}};
}

TEST(Replay, RefusesACalibrationOfAnotherArray) {
  Recorded live(table6());
  live.daemon.run(5);
  calib::calibration::Calibration two = *perfect_calibration(table6());
  two.geometry = calib::sensor::Geometry(PerSensor<Eigen::Vector3d>{{0.2, 0, 0}, {-0.2, 0, 0}});
  two.sensors.resize(2);
  EXPECT_THAT(refusal(live.journal, std::make_shared<const calib::calibration::Calibration>(two)).message,
              ::testing::HasSubstr(
                  "an array of 2 sensors, the journal was recorded by the cross of four sensors, 0.4 m"));
  calib::calibration::Calibration wider = *perfect_calibration(table6());
  wider.geometry = calib::sensor::Geometry(0.6);
  EXPECT_THAT(refusal(live.journal, std::make_shared<const calib::calibration::Calibration>(wider)).message,
              ::testing::HasSubstr("0.6 m from arm to arm"));
}

TEST(Replay, RefusesWhatHasNoBeginning) {
  Recorded live(table6());
  live.daemon.run(1);
  acquire::Replay again([](std::string_view) {}, nullptr);
  const auto refused = again.feed({0, RawDirection::received, {}, "*0102\r"});
  ASSERT_FALSE(refused);
  EXPECT_FALSE(refused.error().remedy.empty());
}

}  // namespace
}  // namespace mgtd::daemon
