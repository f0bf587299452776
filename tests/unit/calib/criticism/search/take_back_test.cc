// SPDX-License-Identifier: Apache-2.0
// Runs of the rig with a law of no library that several effects of the library describe together, or one of
// them but for a few hundredths. None of them may be named.
#include "calib/criticism/search/take_back.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <set>
#include <vector>

#include "calib/criticism/search/explain.h"
#include "calib/report/verdict_text.h"
#include "tests/blind/hidden_run.h"
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

struct AddedRound {
  const char* effect;
  double before_nT, after_nT, d;
};

ExplainReport report_of(const std::vector<AddedRound>& rounds, double noise_inflation) {
  ExplainReport report;
  report.noise.known = true;
  report.noise_nT = 0.02;
  auto fit = std::make_shared<fit::joint::JointFit>();
  fit->noise_inflation = noise_inflation;
  for (const AddedRound& added : rounds) {
    Round& round = report.rounds.emplace_back();
    round.added.effect = added.effect;
    round.added.d = added.d;
    round.rms_before_nT = added.before_nT, round.rms_after_nT = added.after_nT;
    round.fit = fit;
  }
  return report;
}

/// Two dipoles a metre and a half away: what gradient and curvature leave of them fits some instant.
TEST(TakeBack, WhatTookNextToNothingIsNotNamed) {
  const AddedRound gradient{"site.gradient", 40, 1.51, 39};
  const auto kept = [&](const AddedRound& last, double noise_inflation = 75) {
    return rounds_that_count(report_of({gradient, last}, noise_inflation), {});
  };
  EXPECT_EQ(kept({"site.step", 1.51, 1.49, 6.4}), 1U);
  EXPECT_EQ(kept({"site.step", 1.51, 1.2, 6.4}), 2U) << "it took much";
  EXPECT_EQ(kept({"axis.offset.step", 1.51, 1.49, 8.6}), 2U) << "one of twelve axes can take no more";
  EXPECT_EQ(kept({"site.step", 0.05, 0.049, 6.4}, 1), 2U) << "the noise is that of the dwells";
  ExplainReport unknown_noise = report_of({gradient, {"site.step", 1.51, 1.49, 6.4}}, 75);
  unknown_noise.noise.known = false;
  EXPECT_EQ(rounds_that_count(unknown_noise, {}), 2U);
  tests::NoiseModel wandering;
  wandering.wandering.evidence = 10;
  ASSERT_TRUE(wandering.wandering.any());
  EXPECT_EQ(rounds_that_count(report_of({gradient, {"site.step", 1.51, 1.49, 6.4}}, 75), wandering), 2U);
}

/// Of a law that all axes follow at the size of sixty times the noise, one effect or other takes a hundredth.
TEST(TakeBack, ALawOfAllAxesIsNotExplainedByWhatTakesAHundredth) {
  PoseTable run = testing::hidden_run({.noise_nT = 0.02}, 3);
  for (Pose& pose : run.poses)
    for (std::size_t i = 0; i < kSensors; ++i)
      for (int a = 0; a < 3; ++a) {
        const int channel = 3 * static_cast<int>(i + 1) + a;
        pose.y_nT[i][a] += 1.5 * std::sin((4 + channel % 3) * *pose.azimuth_rad + 3 * *pose.pitch_rad +
                                          2 * *pose.roll_rad + 1.3 * channel);
      }
  const auto r = explain(run, {});
  ASSERT_TRUE(r) << r.error().text();
  EXPECT_EQ(r->finding, Finding::unknown) << report::sentence(*r);
  EXPECT_TRUE(r->named.empty()) << report::sentence(*r);
}

/// Noise twenty times that of the dwells has no shape either, but the revisits of an attitude show it.
TEST(TakeBack, NoiseThatTheRevisitsShowIsNoLaw) {
  PoseTable run = testing::hidden_run({.noise_nT = 0.02}, 3);
  ASSERT_GE(run.poses.size(), 100U);
  for (std::size_t k = 40; k < 60; ++k) {
    const Pose& first = run.poses[k - 40];
    Pose& again = run.poses[k];
    again.y_nT = first.y_nT, again.f_nT = first.f_nT;
    again.azimuth_rad = first.azimuth_rad, again.pitch_rad = first.pitch_rad, again.roll_rad = first.roll_rad;
  }
  std::mt19937_64 rng(7);
  std::normal_distribution<double> noise(0, 0.4);
  for (Pose& pose : run.poses)
    for (std::size_t i = 0; i < kSensors; ++i)
      for (int a = 0; a < 3; ++a) pose.y_nT[i][a] += noise(rng);
  const auto r = explain(run, {});
  ASSERT_TRUE(r) << r.error().text();
  EXPECT_EQ(r->finding, Finding::pass) << report::sentence(*r);
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
