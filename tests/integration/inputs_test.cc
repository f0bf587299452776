// SPDX-License-Identifier: Apache-2.0
// What the digitisers measure beside the field, from the volts at an auxiliary input to the name of the
// cause.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "tests/integration/bench.h"
#include "tests/support/whole_file.h"

namespace mgtd::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// A motor's current, on the digitiser of sensor 3, disturbs the z axis of sensor 2; the supply disturbs
/// nothing.
constexpr const char* kRigScenario = R"(
[rig]
name = "motor"
parameters = "table6"
seed = 5
[[covariate]]
name = "motor_A"
mean = 1
amplitude = 1
every_s = 40
input = "s3.q"
unit = "A"
per_V = 2
at_0V = -0.5
[[covariate]]
name = "supply_V"
mean = 12
amplitude = 0.3
wave = "sine"
every_s = 400
input = "s1.r"
per_V = 5
[[effect]]
name = "platform.current"
where = "s2"
of = "motor_A"
nT_per_A = [0, 0, 8]
)";

std::string run_file(const Bench& bench) {
  for (const auto& entry : std::filesystem::directory_iterator(bench.dir() / "runs")) {
    if (entry.path().extension() == ".mgtrun") return entry.path();
  }
  return {};
}

std::map<std::string, json> inputs_of(const json& status) {
  std::map<std::string, json> out;
  for (const auto& input : status.at("inputs")) out[input.at("name")] = input;
  return out;
}

/// Columns of a pose table in CSV, by name, as text.
std::map<std::string, std::vector<std::string>> columns(const std::string& csv) {
  std::map<std::string, std::vector<std::string>> out;
  std::vector<std::string> names;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream cells(line);
    std::vector<std::string> row;
    for (std::string cell; std::getline(cells, cell, ',');) row.push_back(cell);
    if (names.empty()) names = std::exchange(row, {});
    for (std::size_t at = 0; at < row.size(); ++at) out[names.at(at)].push_back(row[at]);
  }
  return out;
}

TEST(Inputs, AMotorsCurrentIsSeenRecordedAndNamed) {
  Bench bench("30", kRigScenario);
  bench.start_daemon();

  // Before a run.
  const auto seen = inputs_of(bench.ask({"status"}));
  ASSERT_EQ(seen.size(), 6U) << "four thermometers, two columns";
  const json& motor = seen.at("motor_A");
  EXPECT_EQ(motor.at("device"), "s3");
  EXPECT_EQ(motor.at("input"), "q");
  EXPECT_EQ(motor.at("unit"), "A");
  EXPECT_NEAR(std::abs(motor.at("value").get<double>() - 1), 1, 2e-3) << "0 or 2 A";
  EXPECT_NEAR(seen.at("supply_V").at("value").get<double>(), 12, 0.31);
  EXPECT_EQ(seen.at("s4_T_degC").at("unit"), "degC");
  const std::string shown = bench.mgt({"status"}).out;
  EXPECT_THAT(shown, HasSubstr("motor_A      s3 q"));
  EXPECT_THAT(shown, HasSubstr("supply_V     s1 r"));
  EXPECT_THAT(bench.mgt({"watch", "--raw", "--count", "1"}).out, HasSubstr("\"motor_A\":"));

  // In every pose.
  const Finished run = bench.mgt({"run", "start", "--step", "20", "--random", "40", "--revisits", "10",
                                  "--dwell-short", "2", "--dwell-long", "4"});
  ASSERT_EQ(run.exit_code, 0) << run.err << bench.daemon().err();
  const std::string file = run_file(bench), csv = bench.dir() / "poses.csv";
  ASSERT_EQ(bench.mgt({"export", file, "-o", csv}).exit_code, 0);
  const auto table = columns(whole_file(csv));
  ASSERT_TRUE(table.contains("motor_A") && table.contains("supply_V"));
  ASSERT_EQ(table.at("motor_A").size(), 58U);
  for (const std::string& cell : table.at("motor_A")) EXPECT_NEAR(std::stod(cell), 1, 1.001);
  for (const std::string& cell : table.at("supply_V")) EXPECT_NEAR(std::stod(cell), 12, 0.301);

  // In the journal, and what is made of it again.
  bench.daemon().signal(SIGTERM);
  ASSERT_TRUE(bench.daemon().wait());
  std::vector<std::string> again{"replay"};
  for (const std::string& journal : journals(bench)) again.push_back(journal);
  const Finished replay = bench.mgt(again);
  EXPECT_EQ(replay.exit_code, 0) << replay.err;
  EXPECT_THAT(replay.out, HasSubstr("\"inputs\":{\"s1_T_degC\":"));
  EXPECT_THAT(replay.out, HasSubstr("\"motor_A\":"));

  // In explanations and formulas.
  const json explained = bench.ask({"explain", file});
  ASSERT_TRUE(explained.is_object());
  EXPECT_EQ(explained.at("verdict"), "EXPLAINED") << explained.at("text");
  EXPECT_THAT(explained.at("named").dump(), HasSubstr("platform.current"));
  EXPECT_THAT(explained.dump(), HasSubstr("motor_A"));
  const Finished defined = bench.mgt(
      {"define", file, "motor", "k*motor_A", "--level", "platform", "--scale", "s2.z", "--unit", "nT/A"});
  ASSERT_EQ(defined.exit_code, 0) << defined.out << defined.err;
  const json fitted = bench.ask({"fit", file, "--with", "motor"});
  ASSERT_TRUE(fitted.is_object());
  const json& k = fitted.at("effects").at(0).at("coefficients").at(0);
  EXPECT_NEAR(k.at("value").get<double>(), 8, 5 * k.at("sd").get<double>()) << fitted.at("effects");
  EXPECT_LT(k.at("sd").get<double>(), 0.5);
}

}  // namespace
}  // namespace mgtd::testing
