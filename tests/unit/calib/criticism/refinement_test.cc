// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/refinement.h"

#include <gtest/gtest.h>

#include "calib/criticism/explain.h"
#include "calib/effects/effect_spec.h"
#include "tests/blind/blind.h"

namespace mgtd::calib::testing {
namespace {

TEST(Refinement, AnInstantBetweenThoseThatAreTriedFirstIsFoundToThePose) {
  // The step lies after pose 90; twenty instants are tried, eight poses apart.
  const HiddenLaw& step = *std::find_if(hidden_laws().begin(), hidden_laws().end(),
                                        [](const HiddenLaw& l) { return l.name == "axis.offset.step"; });
  const double size = 20 * crb_of(step, 1, 2, 5);
  const auto report = explain(hidden_run({.hidden = hide(step, 1, 2, size)}, 5), {});
  ASSERT_TRUE(report.has_value());
  ASSERT_FALSE(report->rounds.empty());
  const auto spec = EffectSpec::parse(report->rounds.front().added.spec);
  ASSERT_TRUE(spec.has_value());
  EXPECT_EQ(spec->name, "axis.offset.step");
  ASSERT_NE(spec->find("ts"), nullptr);
  EXPECT_NEAR(std::stod(*spec->find("ts")), 0.754, 1.5 / 120);
  EXPECT_EQ(report->rounds.size(), 1U);
}

}  // namespace
}  // namespace mgtd::calib::testing
