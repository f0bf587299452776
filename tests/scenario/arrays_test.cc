// SPDX-License-Identifier: Apache-2.0
// Arrays other than the cross, from the wires to the calibrated stream: a whole run through the real drivers,
// its fit, the stream with that calibration, and the stream made again of its journal.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "calib/fit/method_choice/fit.h"
#include "calib/report/fit_reasons.h"
#include "daemon/acquire/replay.h"
#include "tests/scenario/virtual_daemon.h"
#include "tests/scenario/virtual_stream.h"

namespace mgtd::daemon {
namespace {

using nlohmann::json;
using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

struct Array {
  const char* name;
  int sensors;
  const char* positions_m;
  std::vector<std::string> gradient;  ///< components that it tells
  int closure;                        ///< numbers
};

void PrintTo(const Array& array, std::ostream* out) { *out << array.name; }

std::vector<Array> arrays() {
  const std::vector<std::string> all{"xx", "yy", "zz", "xy", "xz", "yz"};
  return {{"one", 1, "[[0, 0, 0]]", {}, 0},
          {"pair_along_z", 2, "[[0, 0, 0.25], [0, 0, -0.25]]", {"zz", "xz", "yz"}, 0},
          {"oblique_pair", 2, "[[0.2, 0.1, 0.15], [-0.2, -0.1, -0.15]]", {}, 0},
          {"tetrahedron", 4, "[[0.2, 0.2, 0.2], [-0.2, -0.2, 0.2], [0.2, -0.2, -0.2], [-0.2, 0.2, -0.2]]",
           all, 4},
          {"six", 6, "[[0.2, 0, 0], [-0.2, 0, 0], [0, 0.2, 0], [0, -0.2, 0], [0, 0, 0.2], [0, 0, -0.2]]", all,
           10}};
}

rig::Scenario scenario_of(const Array& array) {
  return test::scenario_of(
      fmt::format("[rig]\nname = \"{}\"\nparameters = \"random\"\nseed = 4\n[array]\npositions_m = {}\n",
                  array.name, array.positions_m));
}

/// What a short run finds, or nothing where it was refused.
std::shared_ptr<const calib::calibration::Calibration> calibrated(const rig::Scenario& scenario) {
  test::VirtualDaemon daemon(scenario);
  std::shared_ptr<const calib::calibration::Calibration> out;
  daemon.solver = [&](const PoseTable& poses) -> Result<run::Solution> {
    calib::fit::FitOptions options;
    PerSensor<Eigen::Vector3d> places(0);
    for (const Eigen::Vector3d& r_m : scenario.places_m()) places.push_back(r_m);
    options.geometry = calib::sensor::Geometry(places);
    auto fitted = calib::fit::method_choice::fit(poses, options);
    if (!fitted) return tl::unexpected(fitted.error());
    const auto& c = fitted->calibration;
    out = std::make_shared<const calib::calibration::Calibration>(c);
    return run::Solution{c.accepted_by_checks, c.id, calib::report::fit_reasons(*fitted), c.checks};
  };
  EXPECT_TRUE(daemon.run(60, [&] { return daemon.all_live(); }));
  const auto plan = plan::make_plan({.step_deg = 20, .random = 40, .revisits = 8}, daemon.table().limits());
  if (!plan) return nullptr;
  daemon.start(*plan);
  EXPECT_TRUE(daemon.run(3 * 3600)) << (daemon.status ? daemon.status->message : "");
  if (!daemon.finished) return nullptr;
  EXPECT_EQ(name(daemon.finished->state), "done") << daemon.finished->message;
  EXPECT_EQ(daemon.poses.poses.size(), plan->poses.size());
  for (const Pose& pose : daemon.poses.poses) EXPECT_EQ(pose.y_nT.size(), scenario.sensors());
  return out;
}

class AnyArray : public ::testing::TestWithParam<Array> {};

TEST_P(AnyArray, IsCalibratedAndStreamedAndReplayed) {
  const Array& array = GetParam();
  const rig::Scenario scenario = scenario_of(array);
  const auto calibration = calibrated(scenario);
  ASSERT_TRUE(calibration);
  EXPECT_TRUE(calibration->accepted_by_checks);

  test::VirtualStream daemon(scenario);
  std::vector<std::string> lines;
  std::string journal = encode_header({"rig", "j"});
  RawLogEncoder encoder;
  daemon.on_line = [&](const RingRecord& record) { lines.emplace_back(record.line); };
  daemon.on_raw = [&](const RawRecord& record) { encoder.encode(record, journal); };
  daemon.start();
  daemon.run(20);
  daemon.use(calibration);
  daemon.run(60);
  EXPECT_EQ(daemon.pipeline().finding().state, array.closure > 0 ? calib::criticism::live::LiveState::learning
                                                                 : calib::criticism::live::LiveState::none);

  std::map<std::string, std::pair<double, int>> sum;
  double f_nT = 0, chi2 = 0;
  std::array<double, 3> line_sd{};
  int samples = 0;
  for (const std::string& line : lines) {
    const json sample = json::parse(line);
    if (sample.at("class") != "TENSOR" || sample.at("cal").is_null()) continue;
    ++samples;
    f_nT += sample.at("f_nT").get<double>();
    for (const auto& [component, value] : sample.at("g_nT_per_m").items()) {
      EXPECT_EQ(value.is_null(), sample.at("g_sd_nT_per_m").at(component).is_null()) << component;
      if (value.is_null()) continue;
      const double sd = sample.at("g_sd_nT_per_m").at(component).get<double>();
      sum[component].first += value.get<double>() / sd;
      ++sum[component].second;
    }
    EXPECT_EQ(sample.contains("along_line_nT_per_m"), array.sensors == 2);
    for (std::size_t axis = 0; axis < 3 && array.sensors == 2; ++axis) {
      const double sd = sample.at("along_line_sd_nT_per_m").at(axis).get<double>();
      EXPECT_GT(sd, 0);
      line_sd.at(axis) += sample.at("along_line_nT_per_m").at(axis).get<double>() / sd;
    }
    const json& closure = sample.at("closure");
    EXPECT_TRUE(closure.at("curl_nT_per_m").is_null());
    EXPECT_TRUE(closure.at("center_nT").is_null());
    EXPECT_EQ(closure.at("dof"), array.closure);
    EXPECT_EQ(closure.at("combinations_nT").size(), static_cast<std::size_t>(array.closure));
    EXPECT_EQ(closure.at("chi2").is_null(), array.closure == 0);
    if (array.closure > 0) chi2 += closure.at("chi2").get<double>();
  }
  ASSERT_GT(samples, 2500);
  EXPECT_NEAR(f_nT / samples, scenario.f_nT, 2);
  for (const double total : line_sd) EXPECT_LT(std::abs(total / samples), 4.5);
  std::vector<std::string> told;
  for (const auto& [component, total] : sum) {
    told.push_back(component);
    // A uniform field has no gradient: the mean is off by no more than the calibration says.
    EXPECT_LT(std::abs(total.first / total.second), 4.5) << component;
  }
  EXPECT_THAT(told, ::testing::UnorderedElementsAreArray(array.gradient));
  EXPECT_LT(chi2 / samples, 3 * std::max(array.closure, 1));

  std::vector<std::string> replayed;
  acquire::Replay again([&](std::string_view line) { replayed.emplace_back(line); }, nullptr);
  RawLogDecoder decoder;
  decoder.feed(journal);
  while (const auto record = decoder.next()) {
    const auto fed = again.feed(*record);
    ASSERT_TRUE(fed) << fed.error().text();
  }
  EXPECT_FALSE(again.counts().parted) << *again.counts().parted;
  EXPECT_THAT(replayed, ElementsAreArray(lines));
}

INSTANTIATE_TEST_SUITE_P(Arrays, AnyArray, ::testing::ValuesIn(arrays()),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

TEST(ArrayInVirtualTime, TwoExchangedPlugsOfSixAreSeen) {
  const Array six = arrays().back();
  const auto calibration = calibrated(scenario_of(six));
  ASSERT_TRUE(calibration);
  rig::Scenario exchanged = scenario_of(six);
  exchanged.tells_serial = false;
  exchanged.plugs = {1, 5, 3, 4, 2, 6};
  test::VirtualStream daemon(exchanged);
  daemon.start();
  daemon.use(calibration);
  daemon.run(60);
  EXPECT_EQ(daemon.pipeline().finding().state, calib::criticism::live::LiveState::exchanged);
  EXPECT_THAT(daemon.pipeline().finding().measured, HasSubstr("s2 and s5 are exchanged"));
}

TEST(ArrayInVirtualTime, OneSensorHasNoCableToExchange) {
  test::VirtualStream daemon(scenario_of(arrays().front()));
  daemon.start();
  daemon.run(20);
  const auto refused = daemon.try_probe();
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("this rig has one sensor"));
}

}  // namespace
}  // namespace mgtd::daemon
