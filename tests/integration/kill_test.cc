// SPDX-License-Identifier: Apache-2.0
// The daemon is killed at random moments of real runs: every run is there again, with every pose that was
// stored, and goes on to its end.
//
//   MGTD_KILLS=100 build/bin/integration_test --gtest_filter='Kill.*'
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <set>
#include <thread>

#include "daemon/store/run_file.h"
#include "tests/integration/bench.h"

namespace mgtd::testing {
namespace {

using nlohmann::json;
namespace fs = std::filesystem;

constexpr int kKillsInEveryTest = 5;
constexpr int kLongest_ms = 4000;  ///< from a start to the next death: 120 s of the rig's time

int kills_wanted() {
  const char* const text = std::getenv("MGTD_KILLS");
  return text != nullptr ? std::atoi(text) : kKillsInEveryTest;
}

/// Numbers of the poses in the one run file that there is, as a reader sees it while nobody has it open.
std::set<int> stored(const Bench& bench) {
  std::set<int> numbers;
  for (const auto& entry : fs::recursive_directory_iterator(bench.dir().path())) {
    if (entry.path().extension() != ".mgtrun") continue;
    const auto file = daemon::store::RunFile::open(entry.path(), daemon::store::Access::read_only);
    EXPECT_TRUE(file) << (file ? "" : file.error().text());
    if (!file) continue;
    const auto poses = file->poses();
    EXPECT_TRUE(poses) << (poses ? "" : poses.error().text());
    for (const Pose& pose : poses ? poses->poses : std::vector<Pose>{})
      EXPECT_TRUE(numbers.insert(pose.number).second) << "pose " << pose.number << " twice";
  }
  return numbers;
}

/// Goes on with what there is: a run that was interrupted or failed is resumed, else a new one begins in an
/// empty directory. True while a run is under way.
bool go_on(Bench& bench, int& runs, std::set<int>& known, std::unique_ptr<ChildProcess>& follower) {
  const std::string state = bench.ask({"run", "status"}).value("state", "idle");
  if (state == "interrupted" || state == "failed") {
    // It follows the run to its end, which here is the daemon's.
    follower = std::make_unique<ChildProcess>(
        std::vector<std::string>{program("mgt"), "--socket", bench.dir() / "control.sock", "run", "resume"},
        bench.dir().path(), "resume");
    const bool resumed = eventually([&] {
      const std::string now = bench.ask({"run", "status"}).value("state", "");
      return now != "interrupted" && now != "failed";
    });
    EXPECT_TRUE(resumed) << follower->err();
    return resumed;
  }
  for (const auto& entry : fs::recursive_directory_iterator(bench.dir().path())) {
    if (entry.path().extension() == ".mgtrun") fs::rename(entry.path(), entry.path().string() + ".old");
  }
  known.clear();
  ++runs;
  return bench.mgt(detached(kShortRun)).exit_code == 0;
}

TEST(Kill, AtRandomMomentsLosesNothing) {
  Bench bench("30");
  std::mt19937_64 random(20261121);
  std::set<int> known;
  int runs = 0;
  std::unique_ptr<ChildProcess> follower;
  for (int kill = 0; kill < kills_wanted() && !HasFailure(); ++kill) {
    SCOPED_TRACE(kill);
    bench.start_daemon();
    ASSERT_TRUE(go_on(bench, runs, known, follower)) << bench.daemon().err();
    // The moment is the point: nothing is waited for.
    std::this_thread::sleep_for(std::chrono::milliseconds(random() % kLongest_ms));
    // What the daemon has told of is stored.
    const json told = bench.ask({"run", "status"});
    bench.daemon().signal(SIGKILL);
    ASSERT_TRUE(bench.daemon().wait());
    const std::set<int> now = stored(bench);
    EXPECT_TRUE(std::includes(now.begin(), now.end(), known.begin(), known.end())) << "a pose was lost";
    EXPECT_GE(static_cast<int>(now.size()), told.is_object() ? told.value("pose", 0) : 0);
    known = now;
  }
  bench.start_daemon();
  const std::string state = bench.ask({"run", "status"}).value("state", "");
  if (state == "interrupted" || state == "failed") {
    const Finished end = bench.mgt({"run", "resume"});
    EXPECT_EQ(end.exit_code, 0) << end.err << bench.daemon().err();
    EXPECT_EQ(stored(bench).size(), 34U);
  }
  fmt::print("{} kills in {} runs, the last with {} poses\n", kills_wanted(), runs, stored(bench).size());
}

}  // namespace
}  // namespace mgtd::testing
