// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>
#include <string>

#include "tests/scenario/clean_poses.h"
#include "tests/scenario/stream_judge.h"
#include "tests/scenario/virtual_daemon.h"

namespace mgtd::test {

/// What can strike a run. Words before the port; `lasts` for a random time, on `ports` of the rig.
struct Strike {
  enum class Where { any, asked, sensors, stamped_sensors, pairs, table, program } where;
  const char* words;
  bool lasts;
};
inline constexpr std::array<Strike, 29> kStrikes{{
    {Strike::Where::any, "unplug", true},
    {Strike::Where::any, "torn", true},
    {Strike::Where::any, "half", true},
    {Strike::Where::any, "freeze", true},
    {Strike::Where::any, "stall", true},
    {Strike::Where::any, "power", true},
    {Strike::Where::any, "stranger", true},
    {Strike::Where::any, "garbage", false},
    {Strike::Where::any, "clock", false},
    {Strike::Where::stamped_sensors, "twice", true},
    {Strike::Where::sensors, "saturate", true},
    {Strike::Where::sensors, "rate", false},
    {Strike::Where::stamped_sensors, "swap", true},
    {Strike::Where::table, "runaway", true},
    {Strike::Where::table, "backwards", true},
    {Strike::Where::table, "limit", true},
    {Strike::Where::program, "kill", false},
    {Strike::Where::program, "terminate", false},
    {Strike::Where::program, "set the host's clock", false},
    {Strike::Where::program, "pause", false},
    {Strike::Where::program, "redo", false},
    {Strike::Where::any, "mute", true},
    {Strike::Where::asked, "late", true},
    {Strike::Where::asked, "mute", true},
    {Strike::Where::program, "stand still", false},
    {Strike::Where::program, "stand still for long", false},
    {Strike::Where::sensors, "slow", true},
    {Strike::Where::sensors, "step", true},
    {Strike::Where::pairs, "exchange", true},
}};
/// Those of the runs that once failed: with more to draw from, a seed is another run.
inline constexpr std::size_t kFirstStrikes = 21;

/// One run with everything that strikes it, and an operator who looks, waits, and goes on.
class StruckRun {
 public:
  static constexpr int kPoses = 30;
  static constexpr double kMeanPause_s = 15;      ///< between faults
  static constexpr double kSlowUnseen_s = 4;      ///< 1 %, 16 ms of delivery, a block of samples, and some
  static constexpr double kLongest_s = 4 * 3600;  ///< of a run with its faults; without any, eight minutes

  explicit StruckRun(std::uint64_t seed, std::size_t strikes = kStrikes.size())
      : random_(seed),
        strikes_(strikes),
        stamped_(seed % 2 == 0),
        exchanges_(seed % 3 == 1),
        daemon_(scenario_of(fmt::format("[rig]\nname = \"struck\"\nparameters = \"table6\"\nseed = {}\n"
                                        "[sensors]\npalmacq = {}\nautostart = {}\n",
                                        seed, stamped_, seed % 3 == 0))) {
    judge_.watch(daemon_);
    judge_.unsettled_is_said = true;
  }

  /// Returns the number of faults that it had.
  int play() {
    EXPECT_TRUE(daemon_.run(60, [&] { return daemon_.all_live(); }));
    plan_ = plan();
    daemon_.start(plan_);
    double next_s = daemon_.t_s + pause();
    while (!over() && daemon_.t_s < kLongest_s && !::testing::Test::HasFailure()) {
      daemon_.run(next_s - daemon_.t_s);
      if (over()) break;
      next_s = daemon_.t_s + pause();
      strike();
      operate();
    }
    conclude();
    return faults_;
  }
  [[nodiscard]] const StreamJudge& stream() const { return judge_; }

 private:
  [[nodiscard]] bool over() const { return daemon_.finished && daemon_.finished->state == RunState::done; }
  [[nodiscard]] daemon::plan::RunPlan plan() {
    return *daemon::plan::make_plan(
        {.step_deg = 20, .random = 12, .revisits = 2, .dwell_short_s = 2, .dwell_long_s = 3},
        daemon_.table().limits());
  }
  double pause() { return std::exponential_distribution<double>(1 / kMeanPause_s)(random_); }
  std::size_t pick(std::size_t n) { return random_() % n; }

  void strike() {
    // Exchanged plugs, the last of all, strike every third run only.
    const bool with_last = strikes_ < kStrikes.size() || exchanges_;
    const Strike& what = kStrikes.at(pick(with_last ? strikes_ : strikes_ - 1));
    const std::string port(daemon_.rig.name(pick(daemon_.rig.ports())));
    const double for_s = std::pow(10.0, 2.0 * static_cast<double>(pick(1000)) / 1000.0 - 0.5);  // 0.3 to 30
    const std::string lasting = what.lasts ? fmt::format(" for {:.2f}", for_s) : "";
    switch (what.where) {
      case Strike::Where::stamped_sensors:
        // Without a time on them, lines that change places cannot be told; and twice as many are more than
        // the speed of such a line carries.
        if (!stamped_) return;
        [[fallthrough]];
      case Strike::Where::sensors:
        if (what.words == std::string_view("slow")) {
          judge_.forgive(daemon_.t_s, daemon_.t_s + kSlowUnseen_s);
          judge_.forgive(daemon_.t_s + for_s, daemon_.t_s + for_s + kSlowUnseen_s);
        }
        return fault(fmt::format("{} fluxgate{}{}", what.words, 1 + pick(kSensors), lasting));
      case Strike::Where::asked:
        return fault(fmt::format("{} {}{}", what.words, pick(2) == 0 ? "table" : "scalar", lasting));
      case Strike::Where::pairs: {
        // Before a run knows its instruments, those that are there are its own.
        if (daemon_.instruments.empty()) return;
        const std::size_t one = pick(kSensors), other = (one + 1 + pick(kSensors - 1)) % kSensors;
        return fault(fmt::format("{} fluxgate{} fluxgate{}{}", what.words, 1 + one, 1 + other, lasting));
      }
      case Strike::Where::table:
        return fault(fmt::format("{} table{}", what.words, lasting));
      case Strike::Where::any:
        return fault(fmt::format("{} {}{}", what.words, port, lasting));
      case Strike::Where::program:
        return strike_program(what.words);
    }
  }
  void note(const std::string& what) {
    ++faults_;
    story_ += fmt::format("{:8.2f} s, {} poses, {}: {}\n", daemon_.t_s, daemon_.poses.poses.size(),
                          daemon_.status ? name(daemon_.status->state) : "idle", what);
  }
  void fault(const std::string& line) {
    note(line);
    daemon_.fault(line);
  }
  void strike_program(std::string_view what) {
    note(std::string(what));
    if (what == "kill") return come_back([&] { daemon_.restart(); });
    if (what == "terminate") return come_back([&] { daemon_.terminate(); });
    if (what == "stand still") return daemon_.stand_still(0.1 + 0.02 * static_cast<double>(pick(100)));
    if (what == "stand still for long") return daemon_.stand_still(static_cast<double>(2 + pick(20)));
    if (what == "pause") return daemon_.tell(daemon::run::Request::pause);
    if (what == "redo") return daemon_.tell(daemon::run::Request::redo);
    static constexpr std::array<double, 4> kSteps_s{-1, 1, -3600, 86'400};
    daemon_.wall_step_s += kSteps_s.at(pick(kSteps_s.size()));
  }
  template <class End>
  void come_back(const End& end) {
    daemon::run::EarlierLife earlier{daemon_.started_utc(), {}, 0};
    earlier.instruments = daemon_.instruments;
    for (const Pose& pose : daemon_.poses.poses) {
      earlier.stored.insert(pose.number);
      earlier.last_t_s = std::max(earlier.last_t_s, *pose.t_s);
    }
    end();
    judge_.restarted();
    // Nothing is resumed before the table is there.
    EXPECT_TRUE(daemon_.run(200, [&] { return daemon_.health(4).state == LinkState::live; }));
    daemon_.start(plan_, std::nullopt, earlier);
  }
  void operate() {
    if (daemon_.finished && daemon_.finished->state == RunState::failed) {
      note("the operator takes up what failed: " + daemon_.finished->message);
      come_back([&] { daemon_.restart(); });
    }
    if (daemon_.finished || !daemon_.status || daemon_.status->state != RunState::paused) return;
    EXPECT_FALSE(daemon_.status->message.empty());
    if (daemon_.status->message.find("switch the controller off and on") != std::string::npos)
      daemon_.fault("power table for 1");
    daemon_.run(40);
    daemon_.tell(daemon::run::Request::resume);
  }
  void conclude() {
    SCOPED_TRACE(story_);
    ASSERT_TRUE(over()) << "hangs at " << daemon_.t_s << " s: " << daemon_.status->message;
    EXPECT_EQ(daemon_.poses.poses.size(), static_cast<std::size_t>(kPoses));
    for (std::size_t i = 1; i < daemon_.poses.poses.size(); ++i)
      EXPECT_GT(*daemon_.poses.poses[i].t_s, *daemon_.poses.poses[i - 1].t_s);
    expect_clean(daemon_);
  }

  std::mt19937_64 random_;
  std::size_t strikes_;       ///< to draw from, the first of all
  bool stamped_, exchanges_;  ///< exchanges_: plugs, among what strikes
  VirtualDaemon daemon_;
  StreamJudge judge_;
  daemon::plan::RunPlan plan_;
  std::string story_;
  int faults_{0};
};

}  // namespace mgtd::test
