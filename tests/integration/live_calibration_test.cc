// SPDX-License-Identifier: Apache-2.0
// A calibration with an effect, found offline, made live: the daemon streams what the rig really is.
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "tests/integration/bench.h"
#include "tests/support/whole_file.h"

namespace mgtd::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr std::array<const char*, 6> kComponents{"xx", "yy", "zz", "xy", "xz", "yz"};

std::string run_file(const Bench& bench) {
  for (const auto& entry : std::filesystem::directory_iterator(bench.dir() / "runs")) {
    if (entry.path().extension() == ".mgtrun") return entry.path();
  }
  return {};
}

struct Streamed {
  int samples{0};
  std::array<double, 6> mean{}, sd{};
  bool incomplete{false}, forced{false};
};

Streamed streamed(Bench& bench) {
  Streamed out;
  std::istringstream lines(bench.mgt({"watch", "--raw", "--rate", "50", "--count", "40"}).out);
  for (std::string line; std::getline(lines, line);) {
    const json sample = json::parse(line, nullptr, false);
    if (!sample.is_object() || sample.at("class") != "TENSOR") continue;
    ++out.samples;
    for (std::size_t i = 0; i < 6; ++i) {
      out.mean.at(i) += sample.at("g_nT_per_m").at(kComponents.at(i)).get<double>();
      out.sd.at(i) = sample.at("g_sd_nT_per_m").at(kComponents.at(i)).get<double>();
    }
    for (const auto& flag : sample.at("flags")) {
      out.incomplete = out.incomplete || flag == "incomplete";
      out.forced = out.forced || flag == "forced";
    }
  }
  for (double& mean : out.mean) mean /= out.samples;
  return out;
}

/// The table stands: the mean of the fields at the four sensors is what TENSOR says of the centre.
void expect_fields_of_the_sensors(Bench& bench) {
  std::optional<json> tensor, sensors;  // the last of each, in more than two seconds of the host
  std::istringstream lines(bench.mgt({"watch", "--raw", "--rate", "1", "--count", "75"}).out);
  for (std::string line; std::getline(lines, line);) {
    const json object = json::parse(line, nullptr, false);
    if (!object.is_object()) continue;
    if (object.at("class") == "TENSOR") tensor = object;
    if (object.at("class") == "SENSORS") sensors = object;
  }
  ASSERT_TRUE(tensor && sensors);
  EXPECT_EQ(sensors->at("cal"), tensor->at("cal"));
  EXPECT_TRUE(sensors->at("table").is_object()) << sensors->dump();
  ASSERT_EQ(sensors->at("sensors").size(), 4U);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double mean_nT = 0;
    for (const json& sensor : sensors->at("sensors")) mean_nT += sensor.at("b_nT").at(axis).get<double>() / 4;
    EXPECT_NEAR(mean_nT, tensor->at("b_nT").at(axis).get<double>(), 3) << axis;
  }
  for (const json& sensor : sensors->at("sensors")) {
    EXPECT_GT(sensor.at("epochs").get<int>(), 10);
    for (const json& sd : sensor.at("sd_nT")) EXPECT_GT(sd.get<double>(), 0);
  }
}

/// Largest deviation of the stream from the truth.
struct Deviation {
  double nT_per_m{0}, sd{0};  ///< sd: in the standard deviations of one sample that the stream states
};

Deviation deviation(Bench& bench, const Streamed& s) {
  const json real = json::parse(bench.rig({"field", bench.ports()}).out).at("g_nT_per_m");
  Deviation out;
  for (std::size_t i = 0; i < 6; ++i) {
    const double off = std::abs(s.mean.at(i) - real.at(kComponents.at(i)).get<double>());
    out = {std::max(out.nT_per_m, off), std::max(out.sd, off / s.sd.at(i))};
  }
  return out;
}

/// Calibrates and makes the run's own calibration active; nothing knows of the effect.
void calibrate(Bench& bench) {
  bench.start_daemon();
  const Finished run = bench.mgt(kShortRun);
  ASSERT_EQ(run.exit_code, 0) << run.err << bench.daemon().err();
  ASSERT_EQ(bench.mgt({"calibrations", "accept", "latest"}).exit_code, 0);
  EXPECT_GT(deviation(bench, streamed(bench)).nT_per_m, 10) << "the effect is not seen";
}

/// Fits with the effect and imports that.
void becomes_true(Bench& bench, const std::string& effect) {
  const std::string cal = bench.dir() / "cal.json";
  const Finished fit = bench.mgt({"fit", run_file(bench), "--with", effect, "-o", cal});
  ASSERT_EQ(fit.exit_code, 0) << fit.out << fit.err;
  const Finished imported = bench.mgt({"calibrations", "import", cal, "--accept"});
  ASSERT_EQ(imported.exit_code, 0) << imported.err;
  const Streamed after = streamed(bench);
  EXPECT_EQ(after.samples, 40);
  EXPECT_FALSE(after.incomplete);
  expect_fields_of_the_sensors(bench);
  // A mean of forty in the standard deviation of one: what is left is the calibration's.
  const Deviation left = deviation(bench, after);
  EXPECT_LT(left.sd, 3);
  EXPECT_LT(left.nT_per_m, 4);
  // And back, on one command.
  ASSERT_EQ(bench.mgt({"calibrations", "rollback"}).exit_code, 0);
  const json history = bench.ask({"history"});
  EXPECT_EQ(history.at("decisions").at(0).at("by"), "automatic") << "the run proposed it";
  EXPECT_EQ(history.at("decisions").back().at("event"), "rolled-back");
  ASSERT_EQ(history.at("moves").size(), 1U);
  EXPECT_EQ(history.at("moves").at(0).at("to"),
            bench.ask({"calibrations", "list"}).at("calibrations").at(1).at("id"));
  EXPECT_THAT(history.at("figure").at("svg").get<std::string>(), HasSubstr("<svg"));
  EXPECT_GT(deviation(bench, streamed(bench)).nT_per_m, 10);
}

TEST(LiveCalibration, AGradientOfTheSiteIsStreamedAsField) {
  Bench bench("30", R"(
[rig]
name = "gradient"
parameters = "table6"
seed = 3
[[effect]]
name = "site.gradient"
nT_per_m = [50.0, -20.0, 15.0, -25.0, 10.0]
)");
  calibrate(bench);
  becomes_true(bench, "site.gradient");
}

TEST(LiveCalibration, ATemperatureIsCorrectedFromTheLiveThermometer) {
  Bench bench("30", R"(
[rig]
name = "warming"
parameters = "table6"
seed = 4
[temperature]
start_degC = 18.0
ramp_degC_per_h = 60.0
[[effect]]
name = "axis.offset.temperature"
where = "s3.z"
nT_per_degC = 3.0
)");
  calibrate(bench);
  // The stream itself notices: its closure goes with the thermometer.
  ASSERT_TRUE(eventually([&] { return bench.ask({"status"}).at("criticism").at("state") == "suspect"; }))
      << bench.ask({"status"}).dump();
  EXPECT_THAT(bench.ask({"status"}).at("criticism").at("measured").get<std::string>(),
              HasSubstr("follows temperature"));
  EXPECT_THAT(bench.mgt({"status"}).out, HasSubstr("judged    suspect"));
  becomes_true(bench, "axis.offset.temperature@s3.z");
}

TEST(LiveCalibration, WhatCannotBeUsedIsRefusedAndNothingChanges) {
  Bench bench;
  bench.start_daemon();
  const std::string poses = bench.dir() / "poses.csv", cal = bench.dir() / "cal.json";
  ASSERT_EQ(bench.rig({"table", "--rig", "table6", "-o", poses}).exit_code, 0);
  ASSERT_EQ(bench.mgt({"fit", poses, "-o", cal}).exit_code, 0);
  std::string edited = whole_file(cal);
  edited.replace(edited.find("\"poses\": 157"), 12, "\"poses\": 158");
  std::ofstream(bench.dir() / "edited.json") << edited;
  const Finished changed = bench.mgt({"calibrations", "import", bench.dir() / "edited.json"});
  EXPECT_EQ(changed.exit_code, 2);
  EXPECT_THAT(changed.err, HasSubstr("the content was changed"));
  ASSERT_EQ(bench.mgt({"fit", poses, "--baseline", "0.5", "-o", bench.dir() / "long.json"}).exit_code, 0);
  const Finished other = bench.mgt({"calibrations", "import", bench.dir() / "long.json", "--accept"});
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.err, HasSubstr("0.5 m from arm to arm, this rig is the cross of four sensors, 0.4 m"));
  EXPECT_TRUE(bench.ask({"calibrations", "list"}).at("calibrations").empty());
  EXPECT_TRUE(bench.ask({"status"}).at("cal").is_null());
  ASSERT_EQ(bench.mgt({"calibrations", "import", cal}).exit_code, 0);
  EXPECT_TRUE(bench.ask({"status"}).at("cal").is_null()) << "proposed is not active";
  EXPECT_EQ(bench.mgt({"calibrations", "reject", "latest"}).exit_code, 2) << "a reason is needed";
  const Finished rejected = bench.mgt({"calibrations", "reject", "latest", "--why", "a car stood there"});
  EXPECT_EQ(rejected.exit_code, 0) << rejected.err;
  EXPECT_THAT(bench.mgt({"calibrations", "list"}).out, HasSubstr("because: a car stood there"));
  const json listed = bench.ask({"calibrations", "list"}).at("calibrations").at(0);
  EXPECT_EQ(listed.at("state"), "rejected");
  EXPECT_EQ(bench.mgt({"calibrations", "accept", "latest"}).exit_code, 1) << "it is no proposal any more";
  const Finished again = bench.mgt({"calibrations", "accept", listed.at("id")});
  EXPECT_EQ(again.exit_code, 1);
  EXPECT_THAT(again.err, HasSubstr("a car stood there"));
  EXPECT_TRUE(bench.ask({"status"}).at("cal").is_null());
  EXPECT_EQ(
      bench.mgt({"calibrations", "accept", listed.at("id"), "--force", "--why", "it was far"}).exit_code, 0);
  EXPECT_FALSE(streamed(bench).forced);
  const json decisions = bench.ask({"history"}).at("decisions");
  ASSERT_EQ(decisions.size(), 3U);
  const std::string me = decisions.at(0).at("by");
  EXPECT_FALSE(me.empty());
  for (const json& d : decisions) EXPECT_EQ(d.at("by"), me) << d.dump();
  EXPECT_EQ(decisions.at(2).at("event"), "accepted");
  EXPECT_EQ(decisions.at(2).at("why"), "it was far");
  EXPECT_THAT(bench.mgt({"history"}).out, HasSubstr("rejected    by " + me + ", because: a car stood there"));
}

}  // namespace
}  // namespace mgtd::testing
