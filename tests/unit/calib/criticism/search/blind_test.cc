// SPDX-License-Identifier: Apache-2.0
// A small part of the blind benchmark (docs/blind-benchmark.md has the whole): fixed seeds, limits that a
// rate at its aim passes in all but one of a thousand draws of seeds.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/blind/blind.h"
#include "tests/blind/unseen.h"

namespace mgtd::calib::testing {
namespace {

constexpr std::uint64_t kSeed = 3'000'000;

/// Hits that a rate of `aim` falls short of once in a thousand.
int at_least(int runs, double aim) {
  double chance = std::pow(1 - aim, runs), sum = chance;
  int hits = 0;
  while (sum < 1e-3) {
    chance *= aim / (1 - aim) * (runs - hits) / (hits + 1);
    sum += chance;
    ++hits;
  }
  return hits;
}

TEST(Blind, CleanRunsPass) {
  constexpr int kRuns = 24;
  for (const HiddenRun& run : {HiddenRun{}, HiddenRun{.rho = 0.8}, HiddenRun{.tail = Tail::student3},
                               HiddenRun{.tail = Tail::outliers}}) {
    const Answers a = clean(run, kRuns, kSeed);
    EXPECT_GE(a.of(criticism::search::Finding::pass), at_least(kRuns, 0.98)) << "rho " << run.rho;
  }
}

TEST(Blind, LawsOfOneAxisAreFoundAndNamed) {
  Answers sum;
  for (const HiddenLaw& law : hidden_laws())
    if (law.name != "axis.quadratic") sum += hidden(law, 10, 6, kSeed);
  EXPECT_GE(sum.detected, at_least(sum.runs, 0.99));
  EXPECT_GE(sum.named_first, at_least(sum.detected, 0.95));
  EXPECT_GE(sum.in_set, at_least(sum.detected, 0.985));
  EXPECT_LE(sum.wrong_single, sum.runs - at_least(sum.runs, 0.99));
}

TEST(Blind, OwnSquareAndTransverseSquaresStayAmbiguous) {
  for (const HiddenLaw& law : one_field_laws()) {
    const Answers a = hidden(law, 20, 4, kSeed);
    EXPECT_EQ(a.of(criticism::search::Finding::ambiguous), a.runs) << law.name;
    EXPECT_EQ(a.in_set, a.runs) << law.name;
    EXPECT_EQ(a.advised, a.runs) << law.name;
  }
}

TEST(Blind, WhatIsInNoLibraryIsNotExplained) {
  Answers sum;
  for (const HiddenLaw& law : unlisted_laws()) sum += hidden(law, 40, 3, kSeed);
  EXPECT_GE(sum.of(criticism::search::Finding::unknown) + sum.of(criticism::search::Finding::partial),
            at_least(sum.runs, 0.97));
}

/// A gain that drifts and one that follows the temperature are alike; only the other one is in the library.
TEST(Blind, ALawThatWasTakenOutIsNotExplainedByOneThatIsAlike) {
  Answers sum;
  for (const HiddenLaw& law : hidden_laws())
    if (law.name == "axis.gain.drift" || law.name == "axis.gain.temperature")
      sum += hidden(law, 40, 3, kSeed, true);
  EXPECT_EQ(sum.runs, 6);
  EXPECT_EQ(sum.of(criticism::search::Finding::explained), 0);
}

}  // namespace
}  // namespace mgtd::calib::testing
