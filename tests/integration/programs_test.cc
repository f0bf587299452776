// SPDX-License-Identifier: Apache-2.0
// The real programs against each other: mgt-rig on ptys, mgtd on its ports, mgt as the operator.
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>

#include "tests/integration/bench.h"
#include "tests/support/whole_file.h"

namespace mgtd::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

TEST(Programs, ARunFromPortsToACalibratedStream) {
  Bench bench;
  bench.start_daemon();
  EXPECT_TRUE(bench.ask({"status"}).at("cal").is_null());
  const Finished run = bench.mgt(kShortRun);
  ASSERT_EQ(run.exit_code, 0) << run.err << bench.daemon().err();
  EXPECT_THAT(run.out, HasSubstr("proposed: c"));
  // Proposed is not active.
  EXPECT_TRUE(bench.ask({"status"}).at("cal").is_null());
  ASSERT_EQ(bench.mgt({"calibrations", "accept", "latest"}).exit_code, 0);
  const std::string id = bench.ask({"status"}).at("cal");
  const Finished watch = bench.mgt({"watch", "--raw", "--count", "1"});
  EXPECT_THAT(watch.out, HasSubstr("\"cal\":\"" + id + "\""));
  const json devices = bench.ask({"status"}).at("devices");
  for (const json& device : devices) EXPECT_TRUE(device.at("balanced")) << device.dump();
  bench.daemon().signal(SIGTERM);
  const auto ended = bench.daemon().wait();
  ASSERT_TRUE(ended);
  EXPECT_EQ(ended->exit_code, 0);
}

/// A limit that the first tilted poses meet: the run ends long before its plan, with a calibration.
TEST(Programs, ARunEndsWhenTheTensorIsKnownWellEnough) {
  Bench bench;
  bench.start_daemon();
  std::vector<std::string> command = kShortRun;
  command.insert(command.end(), {"--until-tensor-sd", "1000"});
  command[5] = "60";
  const Finished run = bench.mgt(command);
  ASSERT_EQ(run.exit_code, 0) << run.err << bench.daemon().err();
  const json status = bench.ask({"run", "status"});
  EXPECT_EQ(status.at("wanted_tensor_sd_nT_per_m"), 1000);
  EXPECT_LE(status.at("tensor_sd_nT_per_m").get<double>(), 1000);
  EXPECT_LT(status.at("pose").get<int>(), 60);
  EXPECT_EQ(status.at("poses"), 78);
  const json course = bench.ask({"run", "course"});
  EXPECT_EQ(course.at("run_id"), status.at("run_id"));
  EXPECT_EQ(course.at("accuracy").at("wanted_nT_per_m"), 1000);
  EXPECT_FALSE(course.at("accuracy").at("poses").empty());
  EXPECT_FALSE(course.at("accuracy").at("expected").at("poses").empty());
  const json& states = course.at("coverage").at("state");
  EXPECT_EQ(std::count(states.begin(), states.end(), "measured"), status.at("pose").get<int>());
}

TEST(Programs, AKilledDaemonOffersTheRunAndGoesOnAtTheNextPose) {
  Bench bench;
  bench.start_daemon();
  ASSERT_EQ(bench.mgt(detached(kShortRun)).exit_code, 0);
  int stored = 0;
  ASSERT_TRUE(eventually([&] {
    const json run = bench.ask({"run", "status"});
    stored = run.is_object() ? run.value("pose", 0) : 0;
    return stored >= 4;
  })) << bench.daemon().err();
  bench.daemon().signal(SIGKILL);
  ASSERT_TRUE(bench.daemon().wait());
  bench.start_daemon();
  const json offered = bench.ask({"run", "status"});
  EXPECT_EQ(offered.at("state"), "interrupted");
  EXPECT_GE(offered.at("pose").get<int>(), stored);
  EXPECT_EQ(bench.mgt(kShortRun).exit_code, 1) << "a new run must not bury the old one";
  const Finished resumed = bench.mgt({"run", "resume"});
  EXPECT_EQ(resumed.exit_code, 0) << resumed.err << bench.daemon().err();
}

/// The terminal in which it runs is closed: the table is stopped as for any other end.
TEST(Programs, AClosedTerminalEndsItInOrder) {
  Bench bench;
  bench.start_daemon();
  bench.daemon().signal(SIGHUP);
  const auto ended = bench.daemon().wait();
  ASSERT_TRUE(ended);
  EXPECT_EQ(ended->exit_code, 0);
  EXPECT_THAT(ended->err, HasSubstr("stopping the table and closing"));
}

/// A file that is damaged in its middle is no journal of what was.
TEST(Programs, AReplayOfADamagedJournalSaysSo) {
  Bench bench;
  bench.start_daemon();
  ASSERT_EQ(bench.mgt({"watch", "--count", "20"}).exit_code, 0);
  bench.daemon().signal(SIGTERM);
  ASSERT_TRUE(bench.daemon().wait());
  std::string journal;
  for (const auto& entry : std::filesystem::directory_iterator(bench.dir() / "runs"))
    if (entry.path().extension() == ".raw") journal = entry.path();
  ASSERT_FALSE(journal.empty());
  const auto replay = [&] {
    return run_program({program("mgt"), "replay", "--json", journal}, bench.dir().path());
  };
  const Finished whole = replay();
  EXPECT_EQ(whole.exit_code, 0) << whole.err;
  EXPECT_EQ(json::parse(whole.out).at("bytes_damaged"), 0);
  std::string bytes = whole_file(journal);
  const std::size_t middle = bytes.size() / 2;
  for (std::size_t i = middle; i < middle + 64; ++i) bytes[i] = static_cast<char>(~bytes[i]);
  std::ofstream(journal, std::ios::binary | std::ios::trunc) << bytes;
  const Finished damaged = replay();
  EXPECT_EQ(damaged.exit_code, 1);
  EXPECT_GT(json::parse(damaged.out).at("bytes_damaged"), bytes.size() / 3);
  EXPECT_LT(json::parse(damaged.out).at("samples"), json::parse(whole.out).at("samples"));
}

/// Whoever reads the log of a daemon that streams nothing finds why.
TEST(Programs, APortThatIsMissingFromTheStartIsInTheLog) {
  Bench bench;
  std::string config = whole_file(bench.config_path());
  const std::size_t port = config.find("/fluxgate2\"");
  ASSERT_NE(port, std::string::npos);
  config.replace(port, std::string("/fluxgate2").size(), "/nowhere");
  std::ofstream(bench.dir() / "missing.toml") << config;
  const ChildProcess daemon({program("mgtd"), "--config", bench.dir() / "missing.toml"}, bench.dir().path(),
                            "mgtd");
  EXPECT_TRUE(eventually([&] { return daemon.err().find("s2: absent: ") != std::string::npos; }))
      << daemon.err();
  EXPECT_THAT(daemon.err(), HasSubstr("/nowhere: there is no such port"));
}

/// What is no mistake and will be missed all the same is said by both programs.
TEST(Programs, AConfigurationIsCheckedByTheDaemonAsByTheTool) {
  Bench bench;
  std::string config = whole_file(bench.config_path());
  const std::size_t scalar = config.find("[scalar]");
  ASSERT_NE(scalar, std::string::npos);
  config.erase(scalar, config.find("\n[", scalar) - scalar);
  const std::string file = bench.dir() / "without-field.toml";
  std::ofstream(file) << config;
  const Finished tool = run_program({program("mgt"), "check-config", file}, bench.dir().path());
  const Finished daemon =
      run_program({program("mgtd"), "--config", file, "--check-config"}, bench.dir().path());
  EXPECT_EQ(daemon.exit_code, 0);
  EXPECT_THAT(daemon.err, HasSubstr("warning: neither [scalar] nor field_nT"));
  EXPECT_EQ(daemon.err, tool.err);
  EXPECT_EQ(daemon.out, tool.out);
}

/// The sockets are the service manager's: opened before the daemon, there after it.
TEST(Programs, SocketsThatTheServiceManagerHoldsAreTakenOver) {
  constexpr const char* kActivator = "/usr/bin/systemd-socket-activate";
  if (!std::filesystem::exists(kActivator)) GTEST_SKIP() << kActivator << " is not on this machine";
  Bench bench;
  const std::string control = bench.dir() / "control.sock";
  ChildProcess manager({kActivator, "--listen=" + control, "--listen=" + (bench.dir() / "stream.sock"),
                        program("mgtd"), "--config", bench.config_path()},
                       bench.dir().path(), "manager");
  ASSERT_TRUE(eventually([&] { return std::filesystem::exists(control); })) << manager.err();
  EXPECT_EQ(bench.mgt({"status", "--wait", "30"}).exit_code, 0) << manager.err();
  manager.signal(SIGTERM);
  ASSERT_TRUE(manager.wait());
  EXPECT_TRUE(std::filesystem::exists(control)) << "a socket of the service manager was removed";
}

/// Says `begin` and waits until so many poses are stored. The clock of a simulated rig runs on while this
/// computer serves other programs; a preflight that fails for that is repeated, as an operator would.
void measures(Bench& bench, const std::vector<std::string>& begin, int poses) {
  json status;
  for (int attempt = 0; attempt < 5; ++attempt) {
    const Finished begun = bench.mgt(begin);
    ASSERT_EQ(begun.exit_code, 0) << begun.err << bench.daemon().err();
    const bool decided = eventually([&] {
      status = bench.ask({"run", "status"});
      const std::string state = status.value("state", "");
      return status.value("pose", 0) >= poses || state == "failed" || state == "paused";
    });
    if (decided && status.value("pose", 0) >= poses) return;
    ASSERT_THAT(status.value("message", ""), HasSubstr("preflight failed")) << bench.daemon().err();
  }
  FAIL() << "after five attempts: " << status.dump() << bench.daemon().err();
}

/// Two minutes without a sensor end the run; what it then says to do works, and again after a restart.
TEST(Programs, ARunThatFailedIsTakenUpWhereItStopped) {
  Bench bench("60");
  bench.start_daemon();
  const std::vector<std::string> start = detached(kShortRun);
  const std::vector<std::string> resume{"run", "resume", "--detach"};
  const auto fails = [&](const std::vector<std::string>& begin, int poses) {
    measures(bench, begin, poses);
    if (HasFatalFailure()) return;
    ASSERT_EQ(bench.rig({"fault", bench.ports(), "unplug", "fluxgate2"}).exit_code, 0);
    ASSERT_TRUE(eventually([&] { return bench.ask({"run", "status"}).value("state", "") == "failed"; }));
    EXPECT_THAT(bench.ask({"run", "status"}).at("message").get<std::string>(), HasSubstr("resume the run"));
    ASSERT_EQ(bench.rig({"fault", bench.ports(), "restore", "fluxgate2"}).exit_code, 0);
    ASSERT_TRUE(eventually([&] { return bench.mgt({"status", "--wait", "5"}).exit_code == 0; }));
  };
  fails(start, 3);
  if (HasFatalFailure()) return;
  // What cannot be taken up yet stays as it is.
  ASSERT_EQ(bench.rig({"fault", bench.ports(), "unplug", "table"}).exit_code, 0);
  ASSERT_TRUE(eventually([&] {
    const json devices = bench.ask({"status"}).at("devices");
    return std::any_of(devices.begin(), devices.end(),
                       [](const json& d) { return d.at("name") == "table" && d.at("state") == "gone"; });
  }));
  EXPECT_EQ(bench.mgt({"run", "resume"}).exit_code, 1);
  EXPECT_EQ(bench.ask({"run", "status"}).value("state", ""), "failed");
  ASSERT_EQ(bench.rig({"fault", bench.ports(), "restore", "table"}).exit_code, 0);
  ASSERT_TRUE(eventually([&] { return bench.mgt({"status", "--wait", "5"}).exit_code == 0; }));
  fails(resume, 6);
  if (HasFatalFailure()) return;
  bench.daemon().signal(SIGTERM);
  ASSERT_TRUE(bench.daemon().wait());
  bench.start_daemon();
  measures(bench, resume, 8);
  if (HasFatalFailure()) return;
  EXPECT_TRUE(eventually([&] {
    return bench.ask({"run", "status"}).value("state", "") == "done";
  })) << bench.ask({"run", "status"}).dump()
      << bench.daemon().err();
}

TEST(Programs, AbortChangesNothingAndASecondDaemonIsTurnedAway) {
  Bench bench;
  bench.start_daemon();
  const Finished second = run_program({program("mgtd"), "--config", bench.config_path()}, bench.dir().path());
  EXPECT_NE(second.exit_code, 0);
  EXPECT_NE(second.err.find("is in use by mgtd with pid"), std::string::npos) << second.err;
  ASSERT_EQ(bench.mgt(detached(kShortRun)).exit_code, 0);
  ASSERT_TRUE(eventually([&] { return bench.ask({"run", "status"}).value("pose", 0) >= 1; }));
  EXPECT_EQ(bench.mgt({"run", "abort"}).exit_code, 0);
  ASSERT_TRUE(eventually([&] { return bench.ask({"run", "status"}).value("state", "") == "aborted"; }));
  EXPECT_TRUE(bench.ask({"calibrations", "list"}).at("calibrations").empty());
  EXPECT_EQ(bench.mgt({"run", "pause"}).exit_code, 1);
}

TEST(Programs, BadInputIsNamedAndNothingIsWritten) {
  TemporaryDirectory dir;
  std::ofstream(dir / "bad.csv") << "pose,s1_x_nT\n1,abc\n";
  const Finished fit =
      run_program({program("mgt"), "fit", dir / "bad.csv", "-o", dir / "cal.json"}, dir.path());
  EXPECT_EQ(fit.exit_code, 2);
  EXPECT_THAT(fit.err, HasSubstr("bad.csv:1:1: missing column"));
  EXPECT_EQ(whole_file(dir / "cal.json"), "");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"frobnicate"}, {"explain"}, {"fit", "x.csv", "--method", "guess"}}) {
    std::vector<std::string> command{program("mgt"), "--json"};
    command.insert(command.end(), words.begin(), words.end());
    const Finished wrong = run_program(command, dir.path());
    EXPECT_EQ(wrong.exit_code, 2);
    EXPECT_THAT(wrong.err, ::testing::StartsWith("mgt: "));
    EXPECT_EQ(json::parse(wrong.out).at("error").at("code"), "usage") << wrong.out;
  }
  const Finished nobody =
      run_program({program("mgt"), "--socket", dir / "nobody.sock", "status"}, dir.path());
  EXPECT_EQ(nobody.exit_code, 3);
  EXPECT_THAT(nobody.err, HasSubstr("is mgtd running"));
  EXPECT_EQ(run_program({program("mgtd"), "--config", dir / "none.toml"}, dir.path()).exit_code, 78);
}

TEST(Programs, TheOfflineChainFromTableToTensor) {
  TemporaryDirectory dir;
  ASSERT_EQ(run_program({program("mgt-rig"), "table", "--rig", "table6", "-o", dir / "poses.csv"}, dir.path())
                .exit_code,
            0);
  ASSERT_EQ(run_program({program("mgt"), "import", dir / "poses.csv", "-o", dir / "run.mgtrun"}, dir.path())
                .exit_code,
            0);
  const Finished fit =
      run_program({program("mgt"), "fit", dir / "run.mgtrun", "-o", dir / "cal.json", "--json"}, dir.path());
  ASSERT_EQ(fit.exit_code, 0) << fit.err;
  const json report = json::parse(fit.out);
  EXPECT_EQ(report.at("schema"), "mgt.fit/1");
  EXPECT_EQ(report.at("poses"), 157);
  EXPECT_TRUE(report.at("accepted"));
  const Finished apply =
      run_program({program("mgt"), "apply", dir / "cal.json", dir / "run.mgtrun"}, dir.path());
  EXPECT_EQ(apply.exit_code, 0);
  EXPECT_THAT(apply.out, HasSubstr("Gxx_nT_per_m"));
  EXPECT_EQ(apply.err, "");
  ASSERT_EQ(
      run_program({program("mgt-rig"), "table", "--rig", "random", "--seed", "5", "-o", dir / "other.csv"},
                  dir.path())
          .exit_code,
      0);
  const Finished foreign =
      run_program({program("mgt"), "apply", dir / "cal.json", dir / "other.csv"}, dir.path());
  EXPECT_THAT(foreign.err, HasSubstr("is that of another rig"));
  const Finished exported = run_program({program("mgt"), "export", dir / "run.mgtrun"}, dir.path());
  EXPECT_THAT(exported.out, HasSubstr("azimuth_deg"));
}

}  // namespace
}  // namespace mgtd::testing
