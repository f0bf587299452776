// SPDX-License-Identifier: Apache-2.0
// Runs of the rig with a law of no library that several effects of the library describe together, or one of
// them but for a few hundredths. None of them may be named.
#include "calib/criticism/search/take_back.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <tuple>

#include "calib/criticism/search/explain.h"
#include "calib/report/verdict_text.h"
#include "tests/blind/real_kind.h"

namespace mgtd::calib::criticism::search {
namespace {

PoseTable run_of(const std::string& name, std::uint64_t seed) {
  const auto& kinds = testing::real_kinds();
  const auto kind =
      std::find_if(kinds.begin(), kinds.end(), [&](const testing::RealKind& k) { return k.name == name; });
  return kind->make(seed).table;
}

TEST(TakeBack, NoEffectIsNamedForALawOfNoLibrary) {
  const std::pair<const char*, std::uint64_t> runs[] = {
      {"neighbour-squared", 705}, {"azimuth-3", 601}, {"motor-unrecorded", 601}};
  for (const auto& [kind, seed] : runs) {
    const PoseTable run = run_of(kind, seed);
    const auto r = explain(run, {});
    ASSERT_TRUE(r) << kind << ": " << r.error().text();
    EXPECT_EQ(r->finding, Finding::unknown) << kind << ": " << report::sentence(*r);
    EXPECT_TRUE(r->named.empty()) << kind << ": " << report::sentence(*r);
  }
}

/// What the tests see beside a walk of which they know the size to a fifth, and no fit confirms.
TEST(TakeBack, NothingIsNamedThatTheWanderingMayMake) {
  const std::pair<const char*, std::uint64_t> runs[] = {{"walk-1", 820}, {"walk-1-once", 814}};
  for (const auto& [kind, seed] : runs) {
    const PoseTable run = run_of(kind, seed);
    const auto r = explain(run, {});
    ASSERT_TRUE(r) << kind << ": " << r.error().text();
    EXPECT_EQ(r->finding, Finding::pass) << kind << ": " << report::sentence(*r);
    EXPECT_TRUE(std::any_of(r->notes.begin(), r->notes.end(), [](const ExplainNote& n) {
      return std::holds_alternative<LostInWandering>(n);
    })) << kind;
  }
}

/// Two dipoles a metre and a half away: what gradient and curvature leave of them fits some instant.
TEST(TakeBack, AStepThatTookNextToNothingIsNotNamed) {
  const auto rounds_with = [](double step_after_nT) {
    ExplainReport report;
    report.noise.known = true;
    report.noise_nT = 0.02;
    for (const auto& [effect, before_nT, after_nT] :
         {std::tuple{"site.gradient", 40.0, 1.51}, std::tuple{"site.step", 1.51, step_after_nT}}) {
      Round& round = report.rounds.emplace_back();
      round.added.effect = effect;
      round.rms_before_nT = before_nT, round.rms_after_nT = after_nT;
    }
    return report;
  };
  tests::Criticism last;
  last.omnibus_log10_p = -30;
  ASSERT_TRUE(last.rejects());
  ExplainReport little = rounds_with(1.49);
  take_back_steps_that_took_little(last, little);
  ASSERT_EQ(little.rounds.size(), 1U);
  EXPECT_EQ(little.rounds.front().added.effect, "site.gradient");
  EXPECT_EQ(std::get<StepTookLittle>(little.notes.front()).effect, "site.step");
  ExplainReport much = rounds_with(1.2);
  take_back_steps_that_took_little(last, much);
  EXPECT_EQ(much.rounds.size(), 2U);
  ExplainReport all = rounds_with(0.02);
  take_back_steps_that_took_little(last, all);
  EXPECT_EQ(all.rounds.size(), 2U);
}

TEST(TakeBack, ANameThatIsFoundAgainIsNotInTheNotes) {
  ExplainReport report;
  report.rounds.emplace_back();
  report.rounds.back().added.effect = "axis.cubic";
  report.notes.emplace_back(LawOfNoLibrary{"s3.z", {"axis.cubic", "axis.gain.step"}});
  keep_names_found_again(report);
  EXPECT_EQ(std::get<LawOfNoLibrary>(report.notes.front()).effects, std::set<std::string>{"axis.gain.step"});
}

}  // namespace
}  // namespace mgtd::calib::criticism::search
