// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/scan_refinement.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "calib/criticism/search/explain.h"
#include "calib/effects/effect_spec.h"
#include "tests/blind/blind.h"

namespace mgtd::calib::testing {
namespace {

const HiddenLaw& law(std::string_view name) {
  return *std::find_if(hidden_laws().begin(), hidden_laws().end(),
                       [&](const HiddenLaw& l) { return l.name == name; });
}

TEST(Refinement, AnInstantBetweenThoseThatAreTriedFirstIsFoundToThePose) {
  // The step lies after pose 90; twenty instants are tried, eight poses apart.
  const HiddenLaw& step = law("axis.offset.step");
  const double size = 20 * crb_of(step, 1, 2, 5);
  const auto report = criticism::search::explain(hidden_run({.hidden = hide(step, 1, 2, size)}, 5), {});
  ASSERT_TRUE(report.has_value());
  ASSERT_FALSE(report->rounds.empty());
  const auto spec = effects::EffectSpec::parse(report->rounds.front().added.spec);
  ASSERT_TRUE(spec.has_value());
  EXPECT_EQ(spec->name, "axis.offset.step");
  ASSERT_NE(spec->find("ts"), nullptr);
  EXPECT_NEAR(std::stod(*spec->find("ts")), 0.754, 1.5 / 120);
  EXPECT_EQ(report->rounds.size(), 1U);
}

// A drift whose own entry is taken out: three steps follow it to the noise, and none of them is its cause.
TEST(Refinement, AStaircaseIsNotOneLaw) {
  const HiddenLaw& drift = law("axis.offset.drift");
  const PoseTable table = hidden_run({.hidden = hide(drift, 0, 0, 20 * crb_of(drift, 0, 0, 74'004))}, 74'004);
  criticism::search::ExplainOptions options;
  options.candidate_effects = criticism::tests::library_candidates(table).testable;
  std::erase_if(*options.candidate_effects,
                [](const criticism::tests::CandidateEffect& s) { return s.name == "axis.offset.drift"; });
  const auto report = criticism::search::explain(table, options);
  ASSERT_TRUE(report.has_value());
  EXPECT_TRUE(report->named.empty()) << report->named.front();
  EXPECT_NE(report->finding, criticism::search::Finding::explained);
}

}  // namespace
}  // namespace mgtd::calib::testing
