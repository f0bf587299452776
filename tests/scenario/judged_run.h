// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "daemon/run/further_poses.h"
#include "tests/rig/deed.h"
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
  std::vector<PoseTable> looked_at;  ///< by each judgement
  std::vector<std::string> deeds;    ///< as the run asked for them

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
  daemon::run::FurtherPoses judged(const PoseTable& poses, double minutes) {
    const daemon::run::LooksLeft left = daemon::run::left_after(judgements, minutes);
    const auto further = daemon::run::further_poses(daemon::run::judge(poses, {}, left.minutes, left.looks),
                                                    daemon.plan(), daemon.table().limits());
    judgements.push_back(further.judgement);
    looked_at.push_back(poses);
    return further;
  }

  /// False: not on this rig.
  bool done(const std::string& text) {
    const auto deed = rig::deed_of(text);
    if (!deed) return false;
    for (const std::string& line : deed->lines)
      if (!daemon.rig.surroundings(line, daemon.t_s)) return false;
    for (const double end_s = daemon.t_s + deed->wait_s; daemon.t_s < end_s;) daemon.step();
    return true;
  }
};

}  // namespace mgtd::test
