// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/model_history.h"

#include <gmock/gmock.h>

#include "daemon/store/pose_source.h"
#include "daemon/store/run_file.h"
#include "tests/unit/daemon/poses.h"
#include "tests/unit/daemon/temp_dir.h"

namespace mgtd::daemon::store {
namespace {

using test::full_pose;
using test::TempDir;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

ModelStep step(std::string action, std::string spec) {
  return {.at = {1'795'255'200'123'456'789},
          .who = "anna, mgt 0.1.0",
          .action = std::move(action),
          .spec = std::move(spec),
          .result = "{}"};
}

TEST(KeptModel, IsWhatTheStepsLeadTo) {
  std::vector<ModelStep> steps;
  EXPECT_THAT(current_model(steps), IsEmpty());
  EXPECT_FALSE(undoable(steps));
  steps.push_back(step("add", "axis.cubic@s3.z"));
  steps.push_back(step("add", "site.gradient"));
  EXPECT_THAT(current_model(steps), ElementsAre("axis.cubic@s3.z", "site.gradient"));
  steps.push_back(step("drop", "axis.cubic@s3.z"));
  EXPECT_THAT(current_model(steps), ElementsAre("site.gradient"));
}

TEST(KeptModel, UndoGoesBackStepByStepAndNotBeyondTheBeginning) {
  std::vector<ModelStep> steps{step("add", "a"), step("add", "b"), step("drop", "a")};
  ASSERT_TRUE(undoable(steps));
  EXPECT_EQ(undoable(steps)->action, "drop");
  steps.push_back(step("undo", "a"));
  EXPECT_THAT(current_model(steps), ElementsAre("a", "b")) << "the order it had";
  EXPECT_EQ(undoable(steps)->spec, "b");
  steps.push_back(step("undo", "b"));
  steps.push_back(step("undo", "a"));
  steps.push_back(step("undo", "?"));
  EXPECT_THAT(current_model(steps), IsEmpty());
  EXPECT_FALSE(undoable(steps));
  steps.push_back(step("add", "c"));
  EXPECT_THAT(current_model(steps), ElementsAre("c"));
}

TEST(KeptModel, LivesInTheRunFileBesideWhatWasMeasured) {
  TempDir dir;
  RunHeader header;
  header.run_id = "r1";
  {
    auto file = RunFile::create(dir / "a.mgtrun", header).value();
    ASSERT_TRUE(file.append_pose(full_pose(1)));
    EXPECT_THAT(file.model_steps().value(), IsEmpty()) << "a file that knows of no model";
    ASSERT_TRUE(file.append_model_step(step("add", "site.gradient")));
    ASSERT_TRUE(file.append_model_step(step("add", "axis.cubic@s3.z")));
  }
  const auto file = RunFile::open(dir / "a.mgtrun", Access::read_only).value();
  const auto steps = file.model_steps().value();
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_EQ(steps[1].at.ns, 1'795'255'200'123'456'789);
  EXPECT_EQ(steps[1].who, "anna, mgt 0.1.0");
  const PoseSource source = read_run(dir / "a.mgtrun").value();
  EXPECT_THAT(source.model, ElementsAre("site.gradient", "axis.cubic@s3.z"));
  EXPECT_EQ(source.table.poses.size(), 1U);
}

}  // namespace
}  // namespace mgtd::daemon::store
