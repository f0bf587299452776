// SPDX-License-Identifier: Apache-2.0
// Two plugs are exchanged on the real programs: raw from the first sample, named by stream, status and run.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/integration/bench.h"
#include "tests/support/whole_file.h"

namespace mgtd::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// The flags of the next samples, each as one text; "cal" where they name a calibration.
std::vector<std::string> next_samples(Bench& bench) {
  std::vector<std::string> out;
  std::istringstream lines(bench.mgt({"watch", "--raw", "--rate", "50", "--count", "10"}).out);
  for (std::string line; std::getline(lines, line);) {
    const json sample = json::parse(line, nullptr, false);
    if (!sample.is_object() || sample.at("class") != "TENSOR") continue;
    std::string text = sample.at("cal").is_null() ? "" : "cal";
    for (const std::string flag : sample.at("flags"))
      if (flag == "identity" || flag == "uncalibrated") text += " " + flag;
    out.push_back(text);
  }
  return out;
}

json criticism(Bench& bench) { return bench.ask({"status"}).value("criticism", json::object()); }

TEST(Identity, ExchangedPlugsStopCalibratedOutputAndTheNextRun) {
  Bench bench;
  bench.start_daemon();
  const Finished run = bench.mgt(kShortRun);
  ASSERT_EQ(run.exit_code, 0) << run.err << bench.daemon().err();
  const json shown = bench.ask({"calibrations", "show", "latest"});
  EXPECT_THAT(shown.dump(), HasSubstr("serial 1002")) << "the calibration holds who it was made with";
  ASSERT_EQ(bench.mgt({"calibrations", "accept", "latest"}).exit_code, 0);
  EXPECT_THAT(next_samples(bench), ::testing::Each("cal"));

  ASSERT_EQ(bench.rig({"fault", bench.ports(), "exchange", "fluxgate2", "fluxgate4"}).exit_code, 0);
  ASSERT_TRUE(eventually([&] { return criticism(bench).value("state", "") == "identity"; }))
      << bench.ask({"status"}).dump();
  ASSERT_TRUE(eventually([&] {
    return criticism(bench).value("measured", "").find("s2 and s4 are exchanged") != std::string::npos;
  })) << criticism(bench).dump();
  EXPECT_THAT(next_samples(bench), ::testing::Each(" uncalibrated identity"));
  EXPECT_THAT(bench.mgt({"status"}).out, HasSubstr("swap the plugs back"));

  static_cast<void>(bench.mgt(detached(kShortRun)));
  ASSERT_TRUE(eventually([&] {
    const json now = bench.ask({"status"}).at("run");
    return now.at("state") == "paused" && now.at("goes_on") == false;
  })) << bench.ask({"status"}).at("run").dump();
  const json paused = bench.ask({"status"}).at("run");
  EXPECT_EQ(paused.at("pose"), 0);
  EXPECT_THAT(paused.at("message").get<std::string>(), HasSubstr("s2 and s4 are exchanged"));
  ASSERT_EQ(bench.mgt({"run", "abort"}).exit_code, 0);

  ASSERT_EQ(bench.rig({"fault", bench.ports(), "restore", "fluxgate2"}).exit_code, 0);
  ASSERT_TRUE(eventually([&] {
    const auto samples = next_samples(bench);
    return !samples.empty() && samples.back() == "cal";
  })) << bench.ask({"status"}).dump();
}

TEST(Identity, SerialNumbersAreFilledIntoTheConfiguration) {
  Bench bench;
  bench.start_daemon();
  const Finished written = bench.mgt({"ports", "--write", bench.config_path()});
  ASSERT_EQ(written.exit_code, 0) << written.err;
  EXPECT_THAT(whole_file(bench.config_path()), HasSubstr("fluxgate2\"\nserial = \"1002\""));
  EXPECT_EQ(bench.mgt({"check-config", bench.config_path()}).exit_code, 0);
  bench.start_daemon();
  ASSERT_EQ(bench.rig({"fault", bench.ports(), "exchange", "fluxgate2", "fluxgate4"}).exit_code, 0);
  ASSERT_TRUE(eventually([&] {
    return bench.ask({"status"}).at("devices").at(1).value("detail", "").find("wrong device on the port") !=
           std::string::npos;
  })) << bench.ask({"status"}).dump();
}

}  // namespace
}  // namespace mgtd::testing
