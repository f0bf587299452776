// SPDX-License-Identifier: Apache-2.0
// The diagram of states in run_fsm.h is what the tests of a run see, all of it and nothing else:
//
//   MGTD_RUN_STATES=1 build/bin/daemon_test --gtest_filter='Run*'
//
// compares the two after the last test of the process, and prints the diagram as it ought to be.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <gmock/gmock.h>

#include <cstdlib>
#include <fstream>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "tests/support/checkout.h"
#include "tests/unit/daemon/run/run_bench.h"

namespace mgtd::test {
namespace {

using Diagram = std::map<std::string, std::set<std::string>>;

/// Lines "///     homing     => moving paused".
Diagram written() {
  std::ifstream in(mgtd::testing::source_path("daemon/run/run_fsm.h"));
  Diagram out;
  std::string line;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    std::string slashes, from, arrow, to;
    if (!(words >> slashes >> from >> arrow) || slashes != "///" || arrow != "=>") continue;
    while (words >> to) out[from].insert(to);
  }
  return out;
}

Diagram seen() {
  Diagram out;
  for (const auto& [from, to] : RunBench::transitions()) out[std::string(name(from))].emplace(name(to));
  return out;
}

std::string text(const Diagram& diagram) {
  std::string out;
  for (const auto& [from, to] : diagram)
    out += fmt::format("///     {:<10} => {}\n", from, fmt::join(to, " "));
  return out;
}

class DiagramOfStates : public ::testing::Environment {
 public:
  void TearDown() override {
    if (std::getenv("MGTD_RUN_STATES") == nullptr) return;
    EXPECT_EQ(text(written()), text(seen())) << "the diagram in daemon/run/run_fsm.h ought to be:\n"
                                             << text(seen());
  }
};
/// The operator aborts as soon as the state is reached.
void abort_in(RunState state, RunBench& bench) {
  ASSERT_TRUE(bench.run_to(state));
  bench.send(daemon::run::Request::abort);
  ASSERT_TRUE(bench.run(60));
  EXPECT_EQ(bench.finished->state, RunState::aborted);
}

TEST(RunStates, AQuestionCanBeAnsweredByAnAbort) {
  daemon::run::RunConfig config = bench_config();
  config.by_hand = true;
  RunBench bench(bench_plan(2), config);
  abort_in(RunState::asking, bench);
}

TEST(RunStates, ADisturbedRunCanBeAborted) {
  RunBench bench(bench_plan(2));
  ASSERT_TRUE(bench.run_to(RunState::dwelling));
  bench.disturbance_nT = 30;
  abort_in(RunState::suspended, bench);
}

TEST(RunStates, ADisturbanceWithoutEndPausesTheRun) {
  daemon::run::RunConfig config = bench_config();
  config.wait.calm_max_s = 20;
  RunBench bench(bench_plan(2), config);
  ASSERT_TRUE(bench.run_to(RunState::dwelling));
  bench.disturbance_nT = 30;
  ASSERT_TRUE(bench.run_to(RunState::suspended));
  ASSERT_TRUE(bench.run_to(RunState::paused));
  EXPECT_THAT(bench.status->message, ::testing::HasSubstr("it has not become so within 20 s"));
}

[[maybe_unused]] const ::testing::Environment* const kDiagram =
    ::testing::AddGlobalTestEnvironment(new DiagramOfStates);

}  // namespace
}  // namespace mgtd::test
