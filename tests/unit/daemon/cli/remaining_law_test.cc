// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/remaining_law.h"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "calib/effects/library/library.h"
#include "tests/blind/hidden_run.h"

namespace mgtd::daemon::cli {
namespace {

using calib::criticism::search::Finding;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

std::vector<calib::effects::EffectPtr> model(const char* spec) {
  return {calib::effects::library::make_effect(spec, 4).value()};
}

/// A fourth power of its own reading on one axis: a square accounts for most of it.
PoseTable fourth_power() {
  return calib::testing::hidden_run(
      {.hidden =
           [](const Pose&, int sensor, int axis, const Eigen::Vector3d& v) {
             return sensor == 1 && axis == 2 ? 20 * std::pow(v[axis] / 50'000, 4) : 0;
           }},
      3);
}

TEST(RemainingLaw, OfAllInsteadOfAnEffectThatDescribesAPart) {
  const auto law = remaining_law(fourth_power(), {}, model("axis.quadratic@s2.z"), Finding::partial);
  ASSERT_TRUE(law);
  ASSERT_TRUE(law->found) << law->found.error().text();
  EXPECT_TRUE(law->found->accounts_for_everything());
  EXPECT_THAT(law->model, IsEmpty());
  EXPECT_THAT(law->instead_of, ElementsAre("axis.quadratic@s2.z"));
  EXPECT_THAT(law_text(law, {}, "run.csv"),
              HasSubstr("A formula for everything, instead of axis.quadratic@s2.z"));
  EXPECT_EQ(law_json(law, {}, "run.csv")["instead_of"], nlohmann::json::array({"axis.quadratic@s2.z"}));
}

TEST(RemainingLaw, BesideTheEffectsWhereAFormulaAloneLeavesSomething) {
  const std::optional<RemainingLaw> law =
      RemainingLaw{.found = calib::discovery::DiscoveryReport{}, .model = model("axis.cubic@s1.x")};
  EXPECT_THAT(law_text(law, {}, "run.csv"), HasSubstr("A formula for what remains beside axis.cubic@s1.x"));
}

TEST(RemainingLaw, IsNotLookedForWhereNothingRemains) {
  for (const Finding done : {Finding::pass, Finding::explained, Finding::ambiguous, Finding::bad_data}) {
    const auto law = remaining_law({}, {}, {}, done);
    EXPECT_FALSE(law);
    EXPECT_EQ(law_text(law, {}, "run.csv"), "");
    EXPECT_TRUE(law_json(law, {}, "run.csv").is_null());
  }
}

TEST(RemainingLaw, ASearchThatIsRefusedSaysWhy) {
  const auto law = remaining_law({}, {}, {}, Finding::unknown);
  ASSERT_TRUE(law);
  ASSERT_FALSE(law->found);
  EXPECT_THAT(law_text(law, {}, "run.csv"), HasSubstr("No formula was looked for: "));
  EXPECT_EQ(law_json(law, {}, "run.csv")["refused"], law->found.error().message);
}

}  // namespace
}  // namespace mgtd::daemon::cli
