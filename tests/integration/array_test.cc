// SPDX-License-Identifier: Apache-2.0
// Another array than the cross, with the real programs: a run of it, its calibration accepted, the stream
// held against the rig's truth, an exchange of the configuration noticed.
#include <gmock/gmock.h>

#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/integration/bench.h"
#include "tests/support/whole_file.h"

namespace mgtd::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr const char* kTetrahedron = R"([rig]
name = "tetrahedron"
parameters = "random"
seed = 12
[array]
positions_m = [[0.2, 0.2, 0.2], [-0.2, -0.2, 0.2], [0.2, -0.2, -0.2], [-0.2, 0.2, -0.2]]
[[effect]]
name = "site.gradient"
nT_per_m = [40.0, -25.0, 15.0, -20.0, 10.0]
)";

TEST(ArrayOnTheBench, ATetrahedronStreamsTheGradientThatIsThere) {
  Bench bench("30", kTetrahedron);
  std::ofstream(bench.config_path(), std::ios::app) << "\n[calibration]\neffects = [\"site.gradient\"]\n";
  bench.start_daemon();
  const json status = bench.ask({"status"});
  EXPECT_EQ(status.at("array").at("sensors"), 4);
  EXPECT_EQ(status.at("array").at("gradient").size(), 6U);
  EXPECT_THAT(bench.mgt({"status"}).out, HasSubstr("4 sensors: field and all five independent components"));
  const Finished run = bench.mgt(kShortRun);
  ASSERT_EQ(run.exit_code, 0) << run.err << bench.daemon().err();
  ASSERT_EQ(bench.mgt({"calibrations", "accept", "latest"}).exit_code, 0);

  const json real = json::parse(bench.rig({"field", bench.ports()}).out).at("g_nT_per_m");
  std::istringstream lines(bench.mgt({"watch", "--raw", "--rate", "50", "--count", "40"}).out);
  int samples = 0;
  std::map<std::string, double> mean, sd;
  for (std::string line; std::getline(lines, line);) {
    const json sample = json::parse(line, nullptr, false);
    if (!sample.is_object() || sample.at("class") != "TENSOR") continue;
    ++samples;
    EXPECT_EQ(sample.at("closure").at("dof"), 4);
    for (const auto& [component, value] : sample.at("g_nT_per_m").items()) {
      mean[component] += value.get<double>();
      sd[component] = sample.at("g_sd_nT_per_m").at(component).get<double>();
    }
  }
  ASSERT_EQ(samples, 40);
  for (const auto& [component, sum] : mean)
    EXPECT_LT(std::abs(sum / samples - real.at(component).get<double>()), 4 * sd.at(component)) << component;
  EXPECT_GT(std::abs(real.at("xx").get<double>()), 10) << "there is no gradient to be seen";

  // The sensors are moved and the configuration follows: the calibration no longer holds.
  bench.daemon().signal(SIGTERM);
  std::string config = whole_file(bench.config_path());
  config.replace(config.find("[0.2, 0.2, 0.2]"), 15, "[0.3, 0.3, 0.3]");
  std::ofstream(bench.config_path()) << config;
  bench.start_daemon();
  EXPECT_THAT(bench.daemon().err() + bench.daemon().out(), HasSubstr("streaming raw"));
}

}  // namespace
}  // namespace mgtd::testing
