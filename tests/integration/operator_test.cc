// SPDX-License-Identifier: Apache-2.0
// What an operator does beside a plain run: lists of poses, magnets, control, plugs in the wrong place.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/integration/bench.h"
#include "tests/support/whole_file.h"

namespace mgtd::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// The configuration with a line put into the first [[sensor]], or a text replaced everywhere.
void edit_config(const Bench& bench, const std::string& from, const std::string& to) {
  std::string text = whole_file(bench.config_path());
  const auto at = text.find(from);
  ASSERT_NE(at, std::string::npos);
  text.replace(at, from.size(), to);
  std::ofstream(bench.config_path()) << text;
}

TEST(Operator, SwappedCablesAreFoundWithAMagnet) {
  Bench bench("30", "[rig]\nname = \"swapped\"\nparameters = \"table6\"\n[sensors]\nwiring = [1, 4, 3, 2]\n");
  bench.start_daemon();
  ChildProcess hands(
      {program("mgt-rig"), "operate", bench.ports(), "--control", bench.dir() / "control.sock", "--magnet"},
      bench.dir().path(), "hands");
  const Finished test = bench.mgt({"run", "magnet-test"});
  EXPECT_EQ(test.exit_code, 1) << test.err;
  EXPECT_THAT(test.err, HasSubstr("arm 1 (+X)"));  // simulated hands may be quicker than the display
  EXPECT_THAT(test.out, HasSubstr("the cable labelled s4 is on arm 2"));
  EXPECT_THAT(test.out, HasSubstr("the cable labelled s2 is on arm 4"));
  const auto ended = hands.wait();
  ASSERT_TRUE(ended);
  EXPECT_EQ(ended->exit_code, 0);
}

/// Whose program was killed: control is free again, and the test goes on.
TEST(Operator, ARunIsNotResumedDuringAMagnetTest) {
  Bench bench;
  bench.start_daemon();
  ASSERT_EQ(bench.mgt(detached(kShortRun)).exit_code, 0);
  bench.daemon().signal(SIGKILL);
  bench.start_daemon();
  ASSERT_EQ(bench.ask({"run", "status"}).at("state"), "interrupted");
  ChildProcess test({program("mgt"), "--socket", bench.dir() / "control.sock", "run", "magnet-test"},
                    bench.dir().path(), "test");
  ASSERT_TRUE(eventually([&] { return test.err().find("arm 1 (+X)") != std::string::npos; })) << test.err();
  test.signal(SIGKILL);
  ASSERT_TRUE(test.wait());
  ASSERT_TRUE(eventually([&] { return bench.ask({"control", "show"}).at("holder").is_null(); }));
  const Finished refused = bench.mgt({"run", "resume", "--detach"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("a magnet test is going on"));
  EXPECT_EQ(bench.mgt({"run", "abort"}).exit_code, 0);
  EXPECT_EQ(bench.ask({"run", "status"}).at("state"), "interrupted") << "the test was ended, not the run";
  EXPECT_EQ(bench.mgt({"run", "resume", "--detach"}).exit_code, 0);
}

TEST(Operator, AListOfPosesIsARunAndWhatCannotBeMeasuredIsRefusedWithItsPlace) {
  Bench bench;
  bench.start_daemon();
  const std::string file = bench.dir() / "poses.csv";
  std::ofstream(file) << "pose,azimuth_deg,pitch_deg,roll_deg\n1,0,0,0\n2,10,20,x\n";
  const Finished broken = bench.mgt({"run", "start", "--poses", file});
  EXPECT_EQ(broken.exit_code, 2);
  EXPECT_THAT(broken.err, HasSubstr("poses.csv:3:9: 'x' in column roll_deg"));
  std::ofstream(file) << "pose,azimuth_deg,pitch_deg,roll_deg\n1,0,0,0\n2,10,300,0\n3,10,250,0\n";
  const Finished dry = bench.mgt({"run", "dry-run", "--poses", file});
  std::string list = "pose,set,azimuth_deg,pitch_deg,roll_deg,sense,dwell_s,since_stop_s\n";
  for (int i = 1; i <= 24; ++i)
    list += fmt::format("{},random,{:.2f},{:.2f},{:.2f},,2,\n", i, 15.0 * i, 80.0 * ((i * 7) % 24) / 23 - 40,
                        300.0 * ((i * 11) % 24) / 23 - 150);
  std::ofstream(file) << list;
  const Finished run = bench.mgt({"run", "start", "--poses", file});
  EXPECT_EQ(run.exit_code, 0) << dry.err << run.err << bench.daemon().err();
  const json status = bench.ask({"run", "status"});
  EXPECT_EQ(status.at("poses"), 24);
  EXPECT_EQ(status.at("pose"), 24);
}

TEST(Operator, WhileOneHasControlOthersLookAndMayStop) {
  Bench bench;
  bench.start_daemon();
  ChildProcess holder({program("mgt"), "--socket", bench.dir() / "control.sock", "control", "hold", "--why",
                       "somebody stands at the table"},
                      bench.dir().path(), "holder");
  ASSERT_TRUE(eventually([&] { return bench.ask({"control", "show"}).at("holder").is_object(); }));
  const Finished refused = bench.mgt(kShortRun);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("somebody stands at the table"));
  EXPECT_THAT(refused.err, HasSubstr("control is with pid "));
  EXPECT_EQ(bench.mgt({"status"}).exit_code, 0);
  const Finished nothing = bench.mgt({"run", "follow"});
  EXPECT_EQ(nothing.exit_code, 1);
  EXPECT_EQ(nothing.err, "mgt: no run is going on\n     mgt run start begins one\n");
  EXPECT_THAT(bench.mgt({"run", "abort"}).err, Not(HasSubstr("control is with")))
      << "stopping is for everyone";
  holder.signal(SIGINT);
  ASSERT_TRUE(holder.wait());
  ASSERT_TRUE(eventually([&] { return bench.ask({"control", "show"}).at("holder").is_null(); }));
  EXPECT_EQ(bench.mgt(detached(kShortRun)).exit_code, 0);
}

TEST(Operator, TheWrongDeviceOnAPortIsNamed) {
  Bench bench;
  edit_config(bench, "driver = \"obsdaq\"\n", "driver = \"obsdaq\"\nserial = \"1002\"\n");
  ChildProcess daemon({program("mgtd"), "--config", bench.config_path()}, bench.dir().path(), "mgtd");
  const auto first_sensor = [&] {
    const json status = bench.ask({"status"});
    return status.contains("devices") ? status.at("devices").at(0) : json::object();
  };
  ASSERT_TRUE(eventually([&] { return first_sensor().value("state", "") == "failed"; })) << daemon.err();
  EXPECT_THAT(first_sensor().value("detail", ""),
              HasSubstr("wrong device on the port: its serial number is 1001, not 1002"));
}

TEST(Operator, TwoDaemonsCannotHoldOnePort) {
  Bench bench;
  bench.start_daemon();
  const TemporaryDirectory other;
  std::string config = whole_file(bench.config_path());
  for (const std::string key : {"\ndir = \"", "\nunix = \""}) {
    for (auto at = config.find(key); at != std::string::npos; at = config.find(key, at + 1))
      config.replace(at + key.size(), bench.dir().path().size(), other.path());
  }
  std::ofstream(other / "mgtd.toml") << config;
  const ChildProcess second({program("mgtd"), "--config", other / "mgtd.toml"}, other.path(), "second");
  const auto devices = [&] {
    const Finished status =
        run_program({program("mgt"), "--socket", other / "control.sock", "status", "--json"}, other.path());
    return json::parse(status.out, nullptr, false).value("devices", json::array());
  };
  ASSERT_TRUE(eventually([&] { return !devices().empty(); }));
  const json told = devices();
  EXPECT_EQ(told.at(0).at("state"), "opening");
  EXPECT_THAT(told.at(0).at("detail").get<std::string>(), HasSubstr("in use by another program"));
  EXPECT_EQ(bench.mgt({"status", "--wait", "10"}).exit_code, 0) << "the first goes on";
}

}  // namespace
}  // namespace mgtd::testing
