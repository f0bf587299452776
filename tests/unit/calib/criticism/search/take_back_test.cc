// SPDX-License-Identifier: Apache-2.0
// Runs of the rig with a law of no library that several effects of the library describe together, or one of
// them but for a few hundredths. None of them may be named.
#include "calib/criticism/search/take_back.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

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
