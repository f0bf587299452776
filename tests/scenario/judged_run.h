// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "daemon/plan/plan_from_list.h"
#include "daemon/run/judge_run.h"
#include "tests/scenario/virtual_daemon.h"

/// A run that goes on until its residual is explained, in virtual time: the real drivers, the real judgement,
/// and a hand that does what it is asked for.
namespace mgtd::test {

class JudgedRun {
 public:
  JudgedRun(const rig::Scenario& scenario, double minutes) : daemon(scenario) {
    daemon.judge = [this, minutes](const PoseTable& poses) { return judged(poses, minutes); };
  }

  VirtualDaemon daemon;
  std::vector<daemon::run::RunJudgement> judgements;
  std::vector<std::string> deeds;  ///< as the run asked for them

  /// From the switch on to the end. False when the instruments do not come up, or the run does not end.
  [[nodiscard]] bool run() {
    if (!daemon.run(60, [&] { return daemon.all_live(); })) return false;
    const auto plan = daemon::plan::make_plan({}, daemon.table().limits());
    if (!plan) return false;
    daemon::run::RunConfig config = daemon.run_config();
    config.until_explained = true;
    daemon.start(*plan, config);
    while (!daemon.finished) {
      if (!daemon.run(4 * 3600, [&] { return daemon.status && daemon.status->prompt; })) return false;
      if (daemon.finished) break;
      deeds.push_back(daemon.status->prompt->text);
      daemon.tell(done(deeds.back()) ? daemon::run::Request::resume : daemon::run::Request::finish);
      daemon.status.reset();
    }
    return true;
  }

 private:
  /// As the executor does it.
  daemon::run::FurtherPoses judged(const PoseTable& poses, double minutes) {
    for (const daemon::run::RunJudgement& j : judgements) minutes -= j.minutes;
    const int looks_left = daemon::run::kMostJudgements - static_cast<int>(judgements.size()) - 1;
    const auto next = daemon::run::judge(poses, {}, minutes, looks_left);
    if (!next) {
      judgements.push_back(
          {.poses = static_cast<int>(poses.poses.size()), .found = next.error().text(), .next = {}});
      return {.judgement = judgements.back(), .poses = {}};
    }
    judgements.push_back(next->judgement);
    RunRequest request;
    request.poses = next->poses;
    for (RequestedPose& pose : request.poses) pose.number += static_cast<int>(poses.poses.size());
    const auto plan = daemon::plan::listed_plan(request, {}, daemon.table().limits());
    return {.judgement = next->judgement,
            .poses = plan ? plan->poses : std::vector<daemon::plan::PlannedPose>{}};
  }

  /// False: not on this rig.
  bool done(const std::string& deed) {
    if (deed.find("the field a fifth weaker (coil)") != std::string::npos)
      return daemon.rig.surroundings("coil 0.8", daemon.t_s);
    if (deed.find("warm the heads by 5 degC") == std::string::npos) return false;
    // The poses are measured about the peak, where a dwell sees little of the change.
    constexpr double kToThePeak_s = 210;
    const bool warm = daemon.rig.surroundings("warm 5 300", daemon.t_s);
    for (const double end_s = daemon.t_s + kToThePeak_s; daemon.t_s < end_s;) daemon.step();
    return warm;
  }
};

}  // namespace mgtd::test
