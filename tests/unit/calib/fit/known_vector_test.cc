// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "calib/report/verdict_text.h"
#include "tests/unit/calib/fit/fitted_arrays.h"

namespace mgtd::calib {
namespace {

using testing::band;
using testing::explained;
using testing::fitted;
using ::testing::HasSubstr;
using testing::nine_squared_errors;

PoseTable in_a_cage(const std::string& more, std::uint64_t seed) {
  const auto scenario = testing::scenario_of(
      testing::one_sensor(), seed,
      "[reference]\nvector = true\nsd_nT = 0.2\nmisalignment_deg = [1, -2, 3]\n[cage]\nfields = \"random\"\n"
      "max_nT = 60000\nposes = 120\n" +
          more);
  return rig::simulated_table(scenario, rig::cage_fields(*scenario.cage, seed), seed);
}

/// A scale factor that drifts by more than occurs is not named, and the temperature, which drifts too, not in
/// its place: in these runs its evidence is that of the drift.
TEST(KnownVector, WhatLooksLikeSomethingAbsurdIsNotNamedInItsPlace) {
  struct Run {
    std::uint64_t seed;
    const char* axis;
    double ppm_per_h;
  };
  for (const auto& [seed, axis, ppm_per_h] :
       {Run{102, "s1.z", 280}, Run{109, "s1.x", -280}, Run{114, "s1.z", 280}}) {
    const auto scenario = testing::scenario_of(
        testing::one_sensor(), seed,
        fmt::format(
            "[temperature]\nstart_degC = 17.5\nramp_degC_per_h = 2\npulse_degC = 7\npulse_at_s = 400\n"
            "pulse_tau_s = 350\n[reference]\nvector = true\nscalar = false\nsd_nT = 0.2\n"
            "misalignment_deg = [1, -2, 3]\n[cage]\nfields = \"random\"\nmax_nT = 60000\nposes = 120\n"
            "[[effect]]\nname = \"axis.gain.drift\"\nwhere = \"{}\"\nppm_per_h = {}\n",
            axis, ppm_per_h));
    const auto report = explained(
        rig::simulated_table(scenario, rig::cage_fields(*scenario.cage, seed), seed), testing::one_sensor());
    EXPECT_TRUE(report.rounds.empty()) << seed << ": " << report.rounds.front().added.effect;
    EXPECT_THAT(report.notes, ::testing::Not(::testing::IsEmpty())) << seed;
  }
}

TEST(KnownVector, TheFieldOfACageGivesEveryParameterAndTheMisalignment) {
  double sum = 0;
  constexpr int kRuns = 40;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const auto scenario = testing::scenario_of(testing::one_sensor(), seed);
    const fit::FitReport report = fitted(in_a_cage("", seed), testing::one_sensor());
    sum += nine_squared_errors(report.calibration, scenario.truth[0]) / kRuns;
    EXPECT_THAT(report.calibration.gauge, HasSubstr("vector reference"));
    EXPECT_LT(std::sqrt(report.calibration.covariance(sensor::alpha, sensor::alpha)), to_rad(0.001));
  }
  EXPECT_NEAR(sum, 9, band(9, kRuns));
}

TEST(KnownVector, ALawIsNamedInACage) {
  EXPECT_EQ(explained(in_a_cage("", 3), testing::one_sensor()).left, criticism::search::Finding::pass);
  const auto found =
      explained(in_a_cage("[[effect]]\nname = \"axis.cubic\"\nwhere = \"s1.z\"\nnT_at_F0 = 5\n", 3),
                testing::one_sensor());
  ASSERT_FALSE(found.rounds.empty());
  EXPECT_EQ(found.rounds.front().added.effect, "axis.cubic");
}

TEST(KnownVector, AReferenceOfUnknownScatterIsNotTakenForNoiseOfTheSensors) {
  PoseTable table = in_a_cage("", 3);
  for (Pose& pose : table.poses) pose.ref_sd_nT.reset();
  EXPECT_THAT(report::sentence(explained(table, testing::one_sensor())), HasSubstr("give ref_sd_nT = 0.2"));
}

/// One field strength does not tell the square of the own axis from those of the other two: together they are
/// constant. Fields from zero to full scale do.
TEST(KnownVector, SquaresOfTheOwnAndOfTheOtherAxesAreToldApartInACage) {
  for (const auto& [law, size] : {std::pair{"axis.quadratic", "5"}, {"axis.transverse", "[5, 0]"}}) {
    const auto found = explained(
        in_a_cage(fmt::format("[[effect]]\nname = \"{}\"\nwhere = \"s1.y\"\nnT_at_F0 = {}\n", law, size), 3),
        testing::one_sensor());
    EXPECT_EQ(found.finding, criticism::search::Finding::explained) << law;
    ASSERT_EQ(found.rounds.size(), 1U) << law;
    EXPECT_EQ(found.rounds.front().added.effect, law);
    EXPECT_TRUE(found.rounds.front().possible.empty()) << law;
    EXPECT_EQ(found.left, criticism::search::Finding::pass) << law;
  }
}

}  // namespace
}  // namespace mgtd::calib
