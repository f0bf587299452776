// SPDX-License-Identifier: Apache-2.0
// What the rig can do and no library has: forty Cramer-Rao sigmas of each, and none may be explained by a
// name or pass unseen. No law of the library describes any of them. Those that are slow may be offsets that
// wander, for all that one run can tell: these are said to be that, with their size, and nothing else. Where
// a few poses in a row are disturbed, these are left out and listed.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "calib/criticism/search/explain.h"
#include "calib/report/verdict_text.h"
#include "tests/blind/planted.h"

namespace mgtd::calib::criticism::search {
namespace {

using testing::Planted;

constexpr double kSigmas = 40;
constexpr std::uint64_t kSeed = 70;

struct Row {
  std::string title;
  Planted planted;
  bool reference{true};  ///< a scalar reference stands beside the table
  bool slow{false};      ///< an offset moves smoothly over the run, or a few poses in a row are disturbed
};

void PrintTo(const Row& row, std::ostream* out) { *out << row.title; }

std::vector<Row> rows() {
  return {
      {"azimuth_harmonic", {"hidden.azimuth-harmonic", "s2.x", {1, 3, 40}}},
      {"lamp", {"hidden.lamp", "s3", {1, -2, 1, 45, 11}}},
      {"battery_squared", {"hidden.battery-squared", "s1.z", {1, 12.6}, "battery_V"}, true, true},
      {"offset_walk", {"hidden.offset-walk", "s4.y", {1}}, true, true},
      {"site_oscillation",
       {"hidden.site-oscillation", "all", {1, 2, -1, 500}},
       false},  // with one its strength is no mystery
      {"gradient_oscillation", {"hidden.gradient-oscillation", "all", {1, 500}}},
      {"quartic", {"hidden.quartic", "s3.x", {1}}},
      {"cross_cubic", {"hidden.cross-cubic", "s2.z", {-1}}},
      {"soft_limit", {"hidden.soft-limit", "s4.z", {1, 0.6}}},
      {"warm_up", {"hidden.warm-up", "s1.y", {1, 400}}, true, true},
      {"thermometer_lag", {"hidden.thermometer-lag", "s2.y", {1, 600}}, true, true},
      {"slip", {"hidden.slip", "s3", {5, -3, 8, 900}}},
      {"gravity_offset", {"hidden.gravity-offset", "s4.x", {1, -1, 2}}},
      {"cable_twist", {"hidden.cable-twist", "s1.x", {1}}},
      {"passing_iron", {"hidden.passing-iron", "all", {1, -1, 2, 2, 1, 0.5, 0.03, 900}}, true, true},
      {"neighbour", {"hidden.neighbour", "s2", {1, -1, 2, 2}}},
      {"beat", {"hidden.beat", "s2.x", {1, 37}}},
  };
}

std::string title_of(const ::testing::TestParamInfo<Row>& info) { return info.param.title; }

TEST(Unlisted, EveryOneThatTheRigCanHideIsHere) {
  std::set<std::string> rig, here;
  for (const rig::EffectKind& kind : rig::unnamed_kinds()) rig.insert(kind.name);
  for (const Row& row : rows()) here.insert(row.planted.kind);
  EXPECT_EQ(here, rig);
}

class NotListed : public ::testing::TestWithParam<Row> {};

TEST_P(NotListed, IsNotGivenASingleName) {
  const Row& row = GetParam();
  testing::Stage stage = testing::full_stage(kSeed);
  stage.scenario.scalar = row.reference;
  const testing::Sized planted = testing::sized(stage, row.planted, kSigmas, kSeed);
  ExplainOptions options;
  if (!row.reference) options.fit.field_nT = stage.scenario.f_nT;
  const PoseTable run = testing::planted_run(stage, {planted.effect}, kSeed);
  const auto r = explain(run, options);
  ASSERT_TRUE(r) << r.error().text();
  EXPECT_TRUE(r->finding != Finding::pass || (row.slow && (r->noise.wandering.any() || !r->outliers.empty())))
      << report::sentence(*r);
  EXPECT_NE(r->finding, Finding::bad_data) << report::sentence(*r);
  EXPECT_NE(r->finding, Finding::explained) << report::sentence(*r);
}

/// Twice what is usual of an offset that follows temperature, and nothing else: it is named, with its size.
TEST(Unlisted, ALawThatLeavesOnlyNoiseIsNamedAtAnySize) {
  const Planted hot{"axis.offset.temperature", "s1.y", {40}, {}};
  const PoseTable run = testing::planted_run(testing::full_stage(kSeed), {hot}, kSeed);
  const auto r = explain(run, {});
  ASSERT_TRUE(r) << r.error().text();
  ASSERT_EQ(r->candidates.front().effect, hot.kind);
  EXPECT_FALSE(r->candidates.front().plausible);
  EXPECT_EQ(r->finding, Finding::explained) << report::sentence(*r);
  EXPECT_EQ(r->named, std::vector<std::string>{hot.kind}) << report::sentence(*r);
  EXPECT_NE(report::sentence(*r).find("is larger than is usual"), std::string::npos) << report::sentence(*r);
}

/// An exponential of the time, in a table of poses without the way between them: one offset that wanders.
TEST(Unlisted, WhatManyNamesWouldDescribeGetsNone) {
  const testing::Stage stage = testing::full_stage(kSeed);
  const testing::Sized planted = testing::sized(stage, {"hidden.warm-up", "s1.y", {1, 400}, {}}, 80, kSeed);
  PoseTable run = testing::planted_run(stage, {planted.effect}, kSeed);
  run.path.clear();
  const auto r = explain(run, {});
  ASSERT_TRUE(r) << r.error().text();
  EXPECT_TRUE(r->named.empty());
  EXPECT_EQ(r->noise.wandering.where, std::vector<std::string>{"s1.y"});
  const std::string text = report::sentence(*r);
  EXPECT_NE(text.find("slow wandering of the offsets of s1.y"), std::string::npos) << text;
  EXPECT_EQ(text.find("Nothing else in the library looks like it"), std::string::npos) << text;
  EXPECT_EQ(text.find("way of the table"), std::string::npos) << text;
}

/// Beside a law that is known, and in a table of poses without the way between them.
TEST(Unlisted, BesideAKnownLawOnlyThatIsNamed) {
  const Planted known{"axis.gain.step", "s3.z", {117, 32'000}, {}};
  for (const Planted& unknown : {Planted{"hidden.cable-twist", "s2.z", {4.8}, {}},
                                 Planted{"hidden.gravity-offset", "s2.z", {-2, 5.4, -0.5}, {}}}) {
    PoseTable run = testing::planted_run(testing::full_stage(kSeed), {known, unknown}, kSeed);
    run.path.clear();
    const auto r = explain(run, {});
    ASSERT_TRUE(r) << r.error().text();
    EXPECT_EQ(r->finding, Finding::partial) << report::sentence(*r);
    EXPECT_EQ(r->named, std::vector<std::string>{known.kind}) << unknown.kind << ": " << report::sentence(*r);
  }
}

INSTANTIATE_TEST_SUITE_P(Unlisted, NotListed, ::testing::ValuesIn(rows()), title_of);

}  // namespace
}  // namespace mgtd::calib::criticism::search
