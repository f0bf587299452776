// SPDX-License-Identifier: Apache-2.0
// A run that goes on until its residual is explained, in virtual time: the real drivers, the real judgement,
// and a hand that does what it is asked for.
#include <gmock/gmock.h>

#include "daemon/plan/plan_from_list.h"
#include "daemon/run/judge_run.h"
#include "tests/scenario/virtual_daemon.h"

namespace mgtd {
namespace {

using daemon::run::FurtherPoses;
using daemon::run::RunJudgement;
using test::VirtualDaemon;
using ::testing::HasSubstr;

/// Judges as the daemon does, and keeps the answers.
void judge_with(VirtualDaemon& daemon, double minutes, std::vector<RunJudgement>& judgements) {
  daemon.judge = [&daemon, minutes, &judgements](const PoseTable& poses) -> FurtherPoses {
    const auto next = daemon::run::judge(
        poses, {}, minutes, daemon::run::kMostJudgements - static_cast<int>(judgements.size()) - 1);
    if (!next) return {.judgement = {.found = next.error().text(), .next = {}}, .poses = {}};
    judgements.push_back(next->judgement);
    RunRequest request;
    request.poses = next->poses;
    for (RequestedPose& pose : request.poses) pose.number += static_cast<int>(poses.poses.size());
    const auto plan = daemon::plan::listed_plan(request, {}, daemon.table().limits());
    return {.judgement = next->judgement,
            .poses = plan ? plan->poses : std::vector<daemon::plan::PlannedPose>{}};
  };
}

/// The whole run; `deed` does on the rig what a note asks for.
void run_until_explained(VirtualDaemon& daemon, const std::function<void(const std::string&)>& deed) {
  ASSERT_TRUE(daemon.run(60, [&] { return daemon.all_live(); }));
  const auto plan = daemon::plan::make_plan({}, daemon.table().limits());
  ASSERT_TRUE(plan) << plan.error().text();
  daemon::run::RunConfig config = daemon.run_config();
  config.until_explained = true;
  daemon.start(*plan, config);
  while (!daemon.finished) {
    ASSERT_TRUE(daemon.run(4 * 3600, [&] { return daemon.status && daemon.status->prompt; }))
        << daemon.status->message;
    if (daemon.finished) break;
    deed(daemon.status->prompt->text);
    daemon.tell(daemon::run::Request::resume);
    daemon.status.reset();
  }
}

/// Of one field strength an own square and the transverse squares read alike: a weaker field tells them
/// apart.
TEST(UntilExplained, AWeakerFieldTellsAnOwnSquareFromTheTransverseOnes) {
  VirtualDaemon daemon(
      test::scenario_of("[rig]\nparameters = \"random\"\nseed = 17\n"
                        "[temperature]\nramp_degC_per_h = 2\n[sensors]\nnoise_nT = 0.3\n"
                        "[[effect]]\nname = \"axis.quadratic\"\nwhere = \"s2.y\"\n"
                        "nT_at_F0 = 0.6\n"));
  std::vector<RunJudgement> judgements;
  judge_with(daemon, 40, judgements);
  int deeds = 0;
  run_until_explained(daemon, [&](const std::string& text) {
    EXPECT_THAT(text, HasSubstr("the field a fifth weaker (coil)"));
    EXPECT_TRUE(daemon.rig.surroundings("coil 0.8", daemon.t_s));
    ++deeds;
  });
  EXPECT_EQ(deeds, 1);
  ASSERT_EQ(judgements.size(), 2U);
  EXPECT_EQ(judgements[0].found, "AMBIGUOUS: axis.quadratic or axis.transverse");
  EXPECT_EQ(judgements[1].found, "EXPLAINED: axis.quadratic");
  EXPECT_EQ(daemon.poses.poses.size(), 181U);
  ASSERT_TRUE(daemon.finished);
  EXPECT_EQ(name(daemon.finished->state), "done");
}

/// Nothing hidden: the first look ends it.
TEST(UntilExplained, ACleanRunMeasuresNothingMore) {
  VirtualDaemon daemon(test::scenario_of("[rig]\nparameters = \"random\"\nseed = 18\n"));
  std::vector<RunJudgement> judgements;
  judge_with(daemon, 40, judgements);
  run_until_explained(daemon, [](const std::string& text) { ADD_FAILURE() << text; });
  ASSERT_EQ(judgements.size(), 1U);
  EXPECT_EQ(judgements[0].found, "PASS");
  EXPECT_EQ(daemon.poses.poses.size(), 157U);
}

}  // namespace
}  // namespace mgtd
