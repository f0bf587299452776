// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/remaining_law.h"

#include <gmock/gmock.h>

#include <cmath>

#include "calib/effects/library/library.h"
#include "calib/report/discovery_report.h"
#include "tests/unit/calib/discovery/discovery_scene.h"

namespace mgtd::calib::discovery {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::vector<effects::EffectPtr> model(const std::vector<std::string>& specs) {
  std::vector<effects::EffectPtr> out;
  for (const std::string& spec : specs) out.push_back(effects::library::make_effect(spec, 4).value());
  return out;
}

/// A fourth power of its own reading on s2.z, for which a square stands in, and a third power on s1.x.
PoseTable powers(double fourth_nT, double third_nT, std::uint64_t seed) {
  return testing::run_with({.noise_nT = 0.05,
                            .hidden =
                                [=](const Pose&, int sensor, int axis, const Eigen::Vector3d& v) {
                                  if (sensor == 1 && axis == 2)
                                    return fourth_nT * std::pow(v[axis] / 50'000, 4);
                                  return sensor == 0 && axis == 0 ? third_nT * std::pow(v[axis] / 50'000, 3)
                                                                  : 0;
                                }},
                           seed);
}

constexpr int kDraws = 300;
const DiscoverOptions kQuick{.fit = {}, .draws = kDraws, .checks = false};

TEST(RemainingLaw, TakesThePlaceOfAnEffectThatDescribesAPart) {
  const auto law = remaining_law(powers(3, 0, 3), kQuick, model({"axis.quadratic@s2.z"}));
  ASSERT_TRUE(law.found) << law.found.error().text();
  EXPECT_TRUE(law.found->accounts_for_everything());
  EXPECT_THAT(law.model, IsEmpty());
  EXPECT_THAT(law.instead_of, ElementsAre("axis.quadratic@s2.z"));
}

/// Formulas alone account for an effect of the library too, and that is no reason to take its name back.
TEST(RemainingLaw, AnEffectThatSavesAFormulaKeepsItsName) {
  const auto law = remaining_law(powers(3, 3, 5), kQuick, model({"axis.cubic@s1.x", "axis.quadratic@s2.z"}));
  ASSERT_TRUE(law.found) << law.found.error().text();
  EXPECT_THAT(effects::specs_of(law.model), ElementsAre("axis.cubic@s1.x"));
  EXPECT_THAT(law.instead_of, ElementsAre("axis.quadratic@s2.z"));
  ASSERT_TRUE(law.found->accounts_for_everything()) << report::to_text(*law.found, "run.csv");
  ASSERT_EQ(law.found->laws.size(), 1U);
  EXPECT_EQ(law.found->laws.front().formulas.front().formula, "z^4");
}

TEST(RemainingLaw, AnEffectThatLeavesNothingKeepsItsName) {
  const auto law = remaining_law(powers(0, 3, 7), kQuick, model({"axis.cubic@s1.x"}));
  ASSERT_TRUE(law.found) << law.found.error().text();
  EXPECT_THAT(law.instead_of, IsEmpty());
  EXPECT_EQ(law.found->finding, LawFinding::pass);
}

/// A formula that is this effect says nothing of the others.
TEST(RemainingLaw, WhereOneEffectLeavesNothingNoFormulaTakesThePlaceOfTheOthers) {
  EXPECT_FALSE(law_instead(powers(0, 3, 7), kQuick, model({"axis.cubic@s1.x", "axis.quadratic@s2.z"})));
}

TEST(RemainingLaw, TakesThePlaceOfNothingWhereNothingWasAdded) {
  DiscoverOptions options = kQuick;
  options.fit.effects = model({"axis.quadratic@s2.z"});
  EXPECT_FALSE(law_instead(powers(3, 0, 3), options, options.fit.effects));
}

TEST(RemainingLaw, ARefusalIsKept) {
  const auto law = remaining_law({}, kQuick, model({"axis.cubic@s1.x"}));
  EXPECT_FALSE(law.found);
  EXPECT_THAT(law.instead_of, IsEmpty());
}

}  // namespace
}  // namespace mgtd::calib::discovery
