// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "tests/scenario/clean_poses.h"
#include "tests/scenario/stream_judge.h"
#include "tests/scenario/virtual_daemon.h"

namespace mgtd::test {

/// One fault in a run that is otherwise quiet, and everything that could be seen of it from outside.
struct FaultStory {
  std::string links;   ///< the states of the device's link, in their order
  std::string run;     ///< what became of the run
  std::string stream;  ///< gaps and flags
  std::string stored;

  [[nodiscard]] std::string row(const std::string& what) const {
    return fmt::format("| {} | {} | {} | {} | {} |", what, links, run, stream, stored);
  }
};

class FaultTeller {
 public:
  static constexpr std::size_t kPoses = 30;
  static constexpr double kPatience_s = 3600;

  /// `words` of the rig, several with a ';' between and a second from one to the next; or "kill",
  /// "terminate", "stand still", "the host's clock back by 3600 s". Struck when the run is in `when`.
  FaultTeller(const std::string& words, RunState when)
      : daemon_(scenario_of("[rig]\nname = \"page\"\nparameters = \"table6\"\nseed = 11\n"
                            "[sensors]\nautostart = true\n")),
        words_(words) {
    judge_.watch(daemon_);
    quiet_until(when);
  }

  [[nodiscard]] FaultStory tell() {
    const std::size_t gaps_before = judge_.why_gaps.size();
    judge_.seen = {};
    const int retries_before = daemon_.status->retries;
    const std::size_t poses_before = daemon_.poses.poses.size();
    port_ = port_of(words_);
    note_link();
    strike();
    follow(poses_before);
    FaultStory story;
    story.links = arrows(links_);
    story.run = run_words(retries_before);
    story.stream = stream_words(gaps_before);
    daemon_.run(kPatience_s);
    story.stored = stored_words();
    return story;
  }

 private:
  void quiet_until(RunState when) {
    EXPECT_TRUE(daemon_.run(60, [&] { return daemon_.all_live(); }));
    plan_ = *daemon::plan::make_plan(
        {.step_deg = 20, .random = 12, .revisits = 2, .dwell_short_s = 2, .dwell_long_s = 3},
        daemon_.table().limits());
    daemon_.start(plan_);
    EXPECT_TRUE(
        daemon_.run(600, [&] { return daemon_.poses.poses.size() >= 3 && daemon_.status->state == when; }));
    daemon_.run(0.3);  // well within it
  }
  [[nodiscard]] std::size_t port_of(const std::string& words) const {
    for (std::size_t i = 0; i < daemon_.rig.ports(); ++i) {
      if (words.find(daemon_.rig.name(i)) != std::string::npos) return i;
    }
    return daemon_.rig.ports();
  }
  void strike() {
    if (words_ == "kill" || words_ == "terminate") {
      daemon::run::EarlierLife earlier{daemon_.started_utc(), {}, 0};
      for (const Pose& pose : daemon_.poses.poses) {
        earlier.stored.insert(pose.number);
        earlier.last_t_s = std::max(earlier.last_t_s, *pose.t_s);
      }
      if (words_ == "kill") daemon_.restart();
      if (words_ == "terminate") daemon_.terminate();
      judge_.restarted();
      daemon_.run(60, [&] { return daemon_.all_live(); });
      daemon_.start(plan_, std::nullopt, earlier);
      resumed_ = true;
    } else if (words_.starts_with("the host's clock")) {
      daemon_.wall_step_s -= 3600;
    } else if (words_ == "stand still") {
      daemon_.stand_still(1.3);
    } else {
      strike_rig();
    }
  }
  void strike_rig() {
    std::istringstream faults(words_);
    bool first = true;
    for (std::string fault; std::getline(faults, fault, ';');) {
      if (!std::exchange(first, false)) daemon_.run(1);
      daemon_.fault(fault);
    }
  }
  void note_link() {
    if (port_ >= daemon_.rig.ports()) return;
    const std::string state(kLinkStateNames.at(static_cast<std::size_t>(daemon_.shown(port_).state)));
    if (links_.empty() || links_.back() != state) links_.push_back(state);
  }
  /// Until two more poses are stored after all has come back; an operator resumes what pauses.
  void follow(std::size_t poses_before) {
    double paused_s = 0, said_s = 0;
    const double end_s = daemon_.t_s + kPatience_s;
    while (!daemon_.finished && daemon_.t_s < end_s) {
      daemon_.step();
      note_link();
      const RunStatus& status = *daemon_.status;
      if (status.state != RunState::paused) paused_s = 0;
      if (status.state == RunState::paused) {
        // The last word of the first seconds: two plugs do not come in at once.
        if (pause_.empty() || (!status.goes_on && paused_s < 5 && !asked_)) pause_ = status.message;
        unreachable_ |= status.message.find("cannot be reached and may still move") != std::string::npos;
        wrong_device_ |= status.message.find("wrong device") != std::string::npos;
        paused_s += kStep_s;
      }
      if (paused_s > 40 && daemon_.t_s - said_s > 40) {
        said_s = daemon_.t_s;
        asked_ = true;
        daemon_.tell(daemon::run::Request::resume);
      }
      if (daemon_.poses.poses.size() >= poses_before + 4 && status.state == RunState::dwelling) return;
    }
  }
  [[nodiscard]] std::string run_words(int retries_before) const {
    if (resumed_) return "found again by the next start; `mgt run resume` goes on at the next pose";
    const bool again = daemon_.status->retries > retries_before;
    if (!pause_.empty() && asked_)
      return fmt::format("pauses: \"{}\"; goes on when the operator says so", first_part(pause_));
    if (!pause_.empty())
      return fmt::format("{}{}; goes on by itself, the pose is measured again",
                         unreachable_ ? "waits, and says that the table cannot be reached and may still move"
                                      : "stops the table and waits",
                         wrong_device_ ? "; says \"wrong device on the port\"" : "");
    return again ? "the pose is measured again" : "goes on";
  }
  [[nodiscard]] std::string stream_words(std::size_t gaps_before) const {
    std::vector<std::string> whys;
    for (std::size_t i = gaps_before; i < judge_.why_gaps.size(); ++i) {
      if (std::find(whys.begin(), whys.end(), judge_.why_gaps[i]) == whys.end())
        whys.push_back(judge_.why_gaps[i]);
    }
    std::vector<std::string> flags;
    for (const std::string_view flag : names(judge_.seen)) {
      if (flag != "interpolated") flags.push_back(fmt::format("`{}`", flag));
    }
    std::string out;
    if (!whys.empty()) out = fmt::format("GAP \"{}\"", fmt::join(whys, "\", \""));
    if (!flags.empty()) out += (out.empty() ? "" : "; ") + fmt::format("{}", fmt::join(flags, ", "));
    return out.empty() ? "as ever" : out;
  }
  [[nodiscard]] std::string stored_words() {
    if (!daemon_.finished || daemon_.poses.poses.size() != kPoses)
      return fmt::format("{} of {} poses", daemon_.poses.poses.size(), kPoses);
    expect_clean(daemon_);
    return "every pose, once";
  }
  static std::string arrows(const std::vector<std::string>& states) {
    return states.empty() ? "" : fmt::format("{}", fmt::join(states, " → "));
  }
  static std::string first_part(const std::string& text) { return text.substr(0, text.find(';')); }

  VirtualDaemon daemon_;
  StreamJudge judge_;
  daemon::plan::RunPlan plan_;
  std::string words_, pause_;
  std::size_t port_{0};
  std::vector<std::string> links_;
  bool asked_{false}, resumed_{false}, unreachable_{false}, wrong_device_{false};
};

}  // namespace mgtd::test
