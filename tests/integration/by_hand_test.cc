// SPDX-License-Identifier: Apache-2.0
// Runs in which somebody turns the table or mounts the array: a scripted operator, and questions on a
// terminal.
#include <fcntl.h>
#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <csignal>
#include <memory>

#include "tests/integration/bench.h"

namespace mgtd::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr const char* kByHand =
    "[rig]\nname = \"by hand\"\nparameters = \"table6\"\n[table]\nhands = \"table\"\n";

/// `mgt run follow` with a keyboard on which somebody may type.
class FollowedRun {
 public:
  explicit FollowedRun(const Bench& bench) : keyboard_(bench.dir() / "keyboard") {
    EXPECT_EQ(::mkfifo(keyboard_.c_str(), 0600), 0);
    hand_ = ::open(keyboard_.c_str(), O_RDWR | O_CLOEXEC);
    EXPECT_GE(hand_, 0);
    follow_ = std::make_unique<ChildProcess>(
        std::vector<std::string>{"/bin/sh", "-c", "exec \"$0\" --socket \"$1\" run follow < \"$2\"",
                                 program("mgt"), bench.dir() / "control.sock", keyboard_},
        bench.dir().path(), "follow");
  }
  FollowedRun(const FollowedRun&) = delete;
  FollowedRun& operator=(const FollowedRun&) = delete;
  ~FollowedRun() { ::close(hand_); }
  [[nodiscard]] bool shows(const std::string& text) const {
    return eventually([&] { return follow_->err().find(text) != std::string::npos; });
  }
  [[nodiscard]] bool type(const std::string& line) const {
    return ::write(hand_, line.data(), line.size()) == static_cast<ssize_t>(line.size());
  }
  [[nodiscard]] ChildProcess& process() { return *follow_; }

 private:
  std::string keyboard_;
  int hand_{-1};
  std::unique_ptr<ChildProcess> follow_;
};

/// A table of one axis: the array is mounted in five ways and the first once more, by a scripted operator who
/// misreads the scale once.
TEST(RunsByHand, AOneAxisTableIsCalibratedWithMountingsByHand) {
  Bench bench("30", "[rig]\nname = \"one axis\"\nparameters = \"table6\"\n[table]\nhands = \"mount\"\n");
  bench.start_daemon();
  std::vector<std::string> start = kShortRun;
  start[5] = "36";
  const Finished started = bench.mgt(detached(start));
  ASSERT_EQ(started.exit_code, 0) << started.err;
  const Finished hands = run_program({program("mgt-rig"), "operate", bench.dir() / "ports", "--control",
                                      bench.dir() / "control.sock", "--blunder", "3"},
                                     bench.dir().path(), std::chrono::seconds(300));
  EXPECT_EQ(hands.exit_code, 0) << hands.out << hands.err << bench.daemon().err();
  EXPECT_THAT(hands.out, HasSubstr("was asked for"));
  EXPECT_THAT(hands.out, HasSubstr("the field turned by"));
  const json run = bench.ask({"run", "status"});
  EXPECT_EQ(run.at("state"), "done") << run.dump();
  EXPECT_EQ(run.at("pose"), 54);
}

TEST(RunsByHand, ATableTurnedByHandIsCalibratedFromWhatItsScalesSay) {
  Bench bench("30", kByHand);
  bench.start_daemon();
  ASSERT_EQ(bench.mgt(detached(kShortRun)).exit_code, 0);
  const Finished hands = run_program(
      {program("mgt-rig"), "operate", bench.dir() / "ports", "--control", bench.dir() / "control.sock"},
      bench.dir().path(), std::chrono::seconds(300));
  EXPECT_EQ(hands.exit_code, 0) << hands.out << hands.err << bench.daemon().err();
  EXPECT_EQ(bench.ask({"run", "status"}).at("pose"), 34);
}

/// Somebody waits at the question and leaves: no line has to be entered first.
TEST(RunsByHand, CtrlCLeavesTheQuestionOfARunByHand) {
  Bench bench("30", kByHand);
  bench.start_daemon();
  ASSERT_EQ(bench.mgt(detached(kShortRun)).exit_code, 0);
  FollowedRun follow(bench);
  ASSERT_TRUE(follow.shows("azimuth")) << follow.process().err();
  follow.process().signal(SIGINT);
  const auto ended = follow.process().wait();
  ASSERT_TRUE(ended);
  EXPECT_EQ(ended->exit_code, 0) << ended->err;
  EXPECT_THAT(ended->err, HasSubstr("the run goes on"));
  EXPECT_EQ(bench.ask({"run", "status"}).at("pose"), 0);
}

/// Somebody else has answered meanwhile: the entry is not taken for the next pose, and that is asked for.
TEST(RunsByHand, AQuestionThatWasAnsweredElsewhereIsAskedNoLonger) {
  Bench bench("30", kByHand);
  bench.start_daemon();
  ASSERT_EQ(bench.mgt(detached(kShortRun)).exit_code, 0);
  FollowedRun follow(bench);
  ASSERT_TRUE(follow.shows("pose 1 of 34: turn")) << follow.process().err();
  const json target = bench.ask({"run", "status"}).at("prompt").at("target");
  std::vector<std::string> enter{"run", "enter"};
  for (const char* axis : {"azimuth_deg", "pitch_deg", "roll_deg"}) enter.push_back(target.at(axis).dump());
  ASSERT_EQ(bench.mgt(enter).exit_code, 0);
  ASSERT_TRUE(eventually([&] {
    const json prompt = bench.ask({"run", "status"}).at("prompt");
    return prompt.is_object() && prompt.at("pose") == 2;
  }));
  ASSERT_TRUE(follow.type("0 0 0\n"));
  EXPECT_TRUE(follow.shows("that answers another question")) << follow.process().err();
  EXPECT_TRUE(follow.shows("pose 2 of 34: turn the table to")) << follow.process().err();
}

}  // namespace
}  // namespace mgtd::testing
