// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/checkout.h"
#include "tests/support/child_process.h"
#include "tests/support/whole_file.h"

namespace mgtd::testing {

/// A Bench runs a simulated rig and a daemon on it, in a directory of their own.
class Bench {
 public:
  /// `scenario`: the text of a scenario file; a clean rig of the published parameters when empty.
  explicit Bench(std::string speed_up = "30", const std::string& scenario = "")
      : speed_up_(reached(std::move(speed_up))) {
    std::vector<std::string> rig{"--rig", "table6"};
    if (!scenario.empty()) {
      std::ofstream(dir_ / "scenario.toml") << scenario;
      rig = {"--scenario", dir_ / "scenario.toml"};
    }
    rig_ = std::make_unique<ChildProcess>(
        with({program("mgt-rig"), "run", "--dir", ports(), "--speed-up", speed_up_}, rig), dir_.path(),
        "rig");
    const bool ready = eventually([&] { return !whole_file(dir_ / "ports/ready").empty(); });
    const Finished config = run_program(with({program("mgt-rig"), "config", "--dir", ports(), "--speed-up",
                                              speed_up_, "--state", dir_.path(), "--tcp", "127.0.0.1:0"},
                                             rig),
                                        dir_.path());
    std::ofstream(config_path()) << config.out;
    EXPECT_TRUE(ready && config.exit_code == 0) << rig_->err();
  }

  void start_daemon() {
    daemon_.reset();
    daemon_ = std::make_unique<ChildProcess>(
        std::vector<std::string>{program("mgtd"), "--config", config_path()}, dir_.path(), "mgtd");
    const bool live = eventually([&] { return mgt({"status", "--wait", "10"}).exit_code == 0; });
    EXPECT_TRUE(live) << daemon_->err();
  }
  Finished mgt(std::vector<std::string> words) {
    words.insert(words.begin(), {program("mgt"), "--socket", dir_ / "control.sock"});
    return run_program(std::move(words), dir_.path(), std::chrono::seconds(400));
  }
  nlohmann::json ask(std::vector<std::string> words) {
    words.emplace_back("--json");
    return nlohmann::json::parse(mgt(std::move(words)).out, nullptr, false);
  }
  /// The rig's own programs on this rig.
  Finished rig(std::vector<std::string> words) {
    words.insert(words.begin(), program("mgt-rig"));
    return run_program(std::move(words), dir_.path());
  }
  [[nodiscard]] std::string ports() const { return dir_ / "ports"; }
  [[nodiscard]] std::string config_path() const { return dir_ / "mgtd.toml"; }
  [[nodiscard]] ChildProcess& daemon() { return *daemon_; }
  [[nodiscard]] const TemporaryDirectory& dir() const { return dir_; }

 private:
  /// Programs under a sanitizer keep up with a third of the speed.
  static std::string reached(std::string speed_up) {
#ifdef MGTD_SANITIZED
    speed_up = std::to_string(std::max(1, std::stoi(speed_up) / 3));
#endif
    return speed_up;
  }
  static std::vector<std::string> with(std::vector<std::string> words, const std::vector<std::string>& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }

  TemporaryDirectory dir_;
  std::string speed_up_;
  std::unique_ptr<ChildProcess> rig_, daemon_;
};

inline const std::vector<std::string> kShortRun{"run",           "start", "--step",       "20",
                                                "--random",      "16",    "--revisits",   "4",
                                                "--dwell-short", "1",     "--dwell-long", "2"};

/// A command that begins a run and leaves it to the daemon.
inline std::vector<std::string> detached(std::vector<std::string> start) {
  start.emplace_back("--detach");
  return start;
}

/// The raw journals of its daemon, in the order they were written.
inline std::vector<std::string> journals(const Bench& bench) {
  std::vector<std::string> out;
  for (const auto& entry : std::filesystem::directory_iterator(bench.dir() / "runs")) {
    if (entry.path().extension() == ".raw") out.push_back(entry.path());
  }
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace mgtd::testing
