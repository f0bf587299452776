// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "calib/calibration/apply.h"
#include "calib/criticism/search/explain.h"
#include "calib/effects/library/library.h"
#include "calib/fit/joint/joint_fit.h"
#include "calib/fit/joint/sample_correlation.h"
#include "calib/report/fit_report_text.h"
#include "calib/report/verdict_text.h"
#include "tests/unit/calib/fit/fitted_arrays.h"

namespace mgtd::calib {
namespace {

using testing::band;
using testing::fitted;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Places;
using testing::squared_error;

criticism::search::ExplainReport explained(const PoseTable& table, const Places& places) {
  const criticism::search::ExplainOptions options{
      .fit = testing::options_of(places), .rounds = 3, .candidate_effects = {}};
  auto report = criticism::search::explain(table, options);
  if (!report) throw std::runtime_error(report.error().text());
  return *std::move(report);
}

/// Errors of the nine parameters of one sensor that need no frame, over their covariance.
double nine_squared_errors(const calibration::Calibration& c, const rig::SensorTruth& truth) {
  const sensor::SensorModel& s = c.sensors[0];
  Eigen::Matrix<double, 9, 1> off;
  off << s.theta_rad - to_rad(truth.theta_deg), s.phi_rad - to_rad(truth.phi_deg),
      s.psi_rad - to_rad(truth.psi_deg), s.scale - truth.scale, s.offset_nT - truth.offset_nT;
  const Eigen::Matrix<double, 9, 9> C = c.covariance.topLeftCorner<9, 9>();
  return off.dot(C.ldlt().solve(off));
}

struct Honest {
  const char* name;
  Places places;
  int runs;
};

/// MGTD_ARRAY_RUNS=200 takes more runs and prints the table of docs/arrays.md.
TEST(ArraysOfAnySize, TheUncertaintiesAreHonest) {
  const char* const more = std::getenv("MGTD_ARRAY_RUNS");
  for (const auto& [name, places, few] : {Honest{"one sensor", testing::one_sensor(), 40},
                                          {"two", testing::two_along_x(), 30},
                                          {"four in a plane", testing::cross_of_four(), 15},
                                          {"four as a tetrahedron", testing::tetrahedron(), 15},
                                          {"eight in a cube", testing::cube_of_eight(), 8}}) {
    const int runs = more != nullptr ? std::max(few, std::atoi(more)) : few;
    double sum = 0;
    for (int seed = 1; seed <= runs; ++seed) {
      const auto at = static_cast<std::uint64_t>(seed);
      sum += squared_error(fitted(testing::turned_run(places, at), places).calibration,
                           testing::scenario_of(places, at).truth);
    }
    const double unknowns = 12.0 * static_cast<double>(places.size());
    EXPECT_NEAR(sum / runs, unknowns, band(unknowns, runs)) << name;
    if (more != nullptr)
      fmt::print("| {} | {} | {:.2f} of {:.0f} | {:.2f} |\n", name, runs, sum / runs, unknowns,
                 std::sqrt(2 * unknowns / runs));
  }
}

/// Errors of all parameters and of the five components of the gradient at the site over their joint
/// covariance.
double squared_error_with_gradient(const calibration::Calibration& c, const rig::RigTruth& truth,
                                   const std::array<double, 5>& gradient_nT_per_m) {
  const Eigen::Index parameters = c.covariance.rows();
  Eigen::VectorXd off(parameters + 5);
  off << testing::parameter_errors(c, truth), Eigen::VectorXd::Zero(5);
  for (std::size_t j = 0; j < 5; ++j)
    off[parameters + static_cast<Eigen::Index>(j)] =
        c.effects.at(0).coefficients.at(j).value - gradient_nT_per_m.at(j);
  Eigen::MatrixXd C(parameters + 5, parameters + 5);
  C.topLeftCorner(parameters, parameters) = c.covariance;
  C.bottomRows(5) = c.effect_covariance;
  C.topRightCorner(parameters, 5) = c.effect_covariance.leftCols(parameters).transpose();
  return off.dot(C.ldlt().solve(off));
}

/// In a field that is not uniform it matters where the sensors stand.
TEST(ArraysOfAnySize, TheUncertaintiesAreHonestBesideAGradientOfTheSite) {
  const std::array<double, 5> gradient_nT_per_m{30, -20, 10, -15, 25};  // xx, yy, xy, xz, yz
  const std::string planted = "[[effect]]\nname = \"site.gradient\"\nnT_per_m = [30, -20, 10, -15, 25]\n";
  const char* const more = std::getenv("MGTD_ARRAY_RUNS");
  for (const auto& [name, places, few] : {Honest{"four in a plane", testing::cross_of_four(), 12},
                                          Honest{"four as a tetrahedron", testing::tetrahedron(), 12}}) {
    const int runs = more != nullptr ? std::max(few, std::atoi(more)) : few;
    fit::FitOptions options = testing::options_of(places);
    options.effects = {*effects::library::make_effect("site.gradient")};
    double sum = 0;
    for (int seed = 1; seed <= runs; ++seed) {
      const auto at = static_cast<std::uint64_t>(seed);
      const auto report = fit::method_choice::fit(testing::turned_run(places, at, planted), options);
      ASSERT_TRUE(report) << report.error().text();
      sum += squared_error_with_gradient(report->calibration, testing::scenario_of(places, at, planted).truth,
                                         gradient_nT_per_m);
    }
    const double unknowns = 53;
    EXPECT_NEAR(sum / runs, unknowns, band(unknowns, runs)) << name;
    if (more != nullptr)
      fmt::print("| {} | {} | {:.2f} of {:.0f} | {:.2f} |\n", name, runs, sum / runs, unknowns,
                 std::sqrt(2 * unknowns / runs));
  }
}

TEST(ArraysOfAnySize, WhatTheArrayCannotTellIsAbsent) {
  const PoseTable table = testing::turned_run(testing::two_along_x(), 3);
  const fit::FitReport report = fitted(table, testing::two_along_x());
  const Gradient& g = report.after.tensor_rmse_nT_per_m;
  EXPECT_LT(g.xx, 0.2);
  EXPECT_LT(g.xy, 0.2);
  EXPECT_LT(g.xz, 0.2);
  for (const double absent : {g.yy, g.zz, g.yz}) EXPECT_TRUE(std::isnan(absent));
  const auto rows = calibration::apply(report.calibration, table);
  ASSERT_TRUE(rows) << rows.error().text();
  EXPECT_TRUE(std::isnan(rows->front().sample.g_nT_per_m.yy));
  EXPECT_EQ(rows->front().sample.closure.dof, 0);
  const std::string csv = calibration::format_applied(*rows);
  const std::string header = csv.substr(0, csv.find('\n')), row = csv.substr(header.size() + 1);
  EXPECT_EQ(std::count(header.begin(), header.end(), ','),
            std::count(row.begin(), row.begin() + static_cast<std::ptrdiff_t>(row.find('\n')), ','));
  EXPECT_THAT(header, HasSubstr("s2_bz_nT,Bx_nT"));
  EXPECT_THAT(header, HasSubstr("Gxx_nT_per_m,Gxy_nT_per_m,Gxz_nT_per_m,dBx_nT_per_m"));
  EXPECT_THAT(csv, Not(HasSubstr("nan")));
  const fit::FitReport one = fitted(testing::turned_run(testing::one_sensor(), 3), testing::one_sensor());
  EXPECT_THAT(report::to_text(one), Not(HasSubstr("tensor, nT/m")));
  EXPECT_THAT(report::to_text(one), HasSubstr("array: field only: one sensor sees no gradient"));
}

TEST(ArraysOfAnySize, ClosureHasItsDegreesOfFreedom) {
  const Places cube = testing::cube_of_eight();
  const PoseTable table = testing::turned_run(cube, 4);
  const auto rows = calibration::apply(fitted(table, cube).calibration, table);
  ASSERT_TRUE(rows) << rows.error().text();
  double chi2 = 0;
  for (const auto& row : *rows) {
    ASSERT_EQ(row.sample.closure.dof, 16);
    chi2 += row.sample.closure.chi2 / static_cast<double>(rows->size());
  }
  EXPECT_NEAR(chi2, 16, 5 * std::sqrt(32.0 / static_cast<double>(rows->size())));
}

TEST(ArraysOfAnySize, ACalibrationIsReadBackAsItWasWritten) {
  for (const Places& places : {testing::one_sensor(), testing::cube_of_eight()}) {
    const calibration::Calibration c = fitted(testing::turned_run(places, 5), places).calibration;
    const auto again = calibration::calibration_from_json_text(calibration::to_json_text(c));
    ASSERT_TRUE(again) << again.error().text();
    EXPECT_EQ(again->id, c.id);
    EXPECT_EQ(again->geometry, c.geometry);
    // The upper triangle is what is written.
    EXPECT_EQ(Eigen::MatrixXd(again->covariance.triangularView<Eigen::Upper>()),
              Eigen::MatrixXd(c.covariance.triangularView<Eigen::Upper>()));
  }
}

TEST(ArraysOfAnySize, CleanRunsPassAndAHiddenLawIsNamed) {
  const std::string cubic = "[[effect]]\nname = \"axis.cubic\"\nwhere = \"s1.y\"\nnT_at_F0 = 3\n";
  for (const Places& places : {testing::one_sensor(), testing::two_along_x(), testing::cube_of_eight()}) {
    EXPECT_EQ(explained(testing::turned_run(places, 5), places).left, criticism::search::Finding::pass)
        << places.size();
    const auto found = explained(testing::turned_run(places, 5, cubic), places);
    ASSERT_FALSE(found.rounds.empty()) << places.size();
    EXPECT_EQ(found.rounds.front().added.effect, "axis.cubic") << places.size();
  }
}

/// A gross reading can draw the attitude of its pose half a turn away, and the whole fit with it; other
/// sensors of the pose, which would say so, are not there.
TEST(ArraysOfAnySize, OneSensorLosesNoMoreThanTheGrossReading) {
  const PoseTable clean = testing::turned_run(testing::one_sensor(), 1);
  struct Gross {
    std::size_t pose;
    int axis;
    double shift_nT;
  };
  for (const Gross& gross :
       {Gross{1, 0, 2e5}, {1, 2, -1.2e5}, {1, 0, 9.9e6}, {130, 2, 9.9e6}, {130, 2, -9.9e6}}) {
    PoseTable table = clean;
    table.poses[gross.pose - 1].y_nT[0][gross.axis] += gross.shift_nT;
    const fit::FitReport report = fitted(table, testing::one_sensor());
    EXPECT_TRUE(report.calibration.accepted_by_checks) << gross.pose << ", " << gross.shift_nT;
    ASSERT_EQ(report.outliers.size(), 1U) << gross.pose << ", " << gross.shift_nT;
    EXPECT_EQ(report.outliers.front().where, fmt::format("s1.{}", "xyz"[gross.axis]));
    EXPECT_LT(report.residual_nT, 2 * report.noise_nT);
  }
}

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

/// As of a magnetometer on a chip.
constexpr const char* kLargeNoise = "[sensors]\nnoise_nT = 20\n";

TEST(Recording, CorrelatedSamplesCountForLess) {
  constexpr double kRho = 0.9;
  double sum = 0;
  constexpr int kRuns = 12;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const PoseTable table = testing::recorded("hand", kRho, seed);
    const fit::FitReport report = fitted(table, testing::one_sensor());
    sum +=
        nine_squared_errors(report.calibration, testing::scenario_of(testing::one_sensor(), seed).truth[0]) /
        kRuns;
  }
  // A hand turns faster than white noise would need: the correlation is a bound, three times at the most.
  EXPECT_LT(sum, 9 + band(9, kRuns));
  EXPECT_GT(sum, 2);
}

/// Two thirds of the samples stand still and repeat two attitudes: they are no two thirds of what is known.
TEST(Recording, LongRestsMakeNothingSurer) {
  double sum = 0;
  constexpr int kRuns = 12;
  for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
    const auto scenario = testing::scenario_of(
        testing::one_sensor(), seed,
        "[recording]\nmotion = \"hand\"\nrate_hz = 20\nduration_s = 150\nrest_s = 50\nar = 0.9\n");
    const fit::FitReport report =
        fitted(rig::pose_table_of(rig::simulated_recording(scenario)), testing::one_sensor());
    sum += nine_squared_errors(report.calibration, scenario.truth[0]) / kRuns;
  }
  EXPECT_LT(sum, 9 + band(9, kRuns));
  EXPECT_GT(sum, 2);
}

/// Its fit starts from a share of the samples, among which are gross ones.
TEST(Recording, ALongOneIsFittedWithAllItsSamples) {
  constexpr std::size_t kSamples = 12'000, kGrossEvery = 97;
  const auto scenario = testing::scenario_of(
      testing::one_sensor(), 5, "[recording]\nmotion = \"hand\"\nrate_hz = 80\nduration_s = 150\nar = 0\n");
  PoseTable table = rig::pose_table_of(rig::simulated_recording(scenario));
  ASSERT_GE(table.poses.size(), kSamples);
  std::size_t gross = 0;
  for (std::size_t k = 0; k < table.poses.size(); k += kGrossEvery, ++gross)
    table.poses[k].y_nT[0][static_cast<int>(gross % 3)] += 500;
  fit::joint::JointOptions options;
  options.geometry = testing::geometry_of(testing::one_sensor());
  const auto fit = fit::joint::fit_joint(table, options);
  ASSERT_TRUE(fit) << fit.error().text();
  EXPECT_EQ(fit->problem.poses.size(), table.poses.size());
  // Across the field 500 nT change its size by two or three only.
  EXPECT_GT(fit->outliers.size(), gross * 9 / 10);
  for (const auto& node : fit->outliers) EXPECT_EQ(node.place % kGrossEvery, 0U);
  const auto again = fit::joint::fit_joint(table, options, fit->state);
  ASSERT_TRUE(again) << again.error().text();
  const Eigen::VectorXd sd = fit->covariance.diagonal().head<sensor::kSensorParameters>().cwiseSqrt();
  const Eigen::VectorXd moved = again->state.sensors[0].parameters() - fit->state.sensors[0].parameters();
  EXPECT_LT((moved.array() / sd.array()).head<9>().abs().maxCoeff(), 0.05);
  EXPECT_LT(nine_squared_errors(fitted(table, testing::one_sensor()).calibration, scenario.truth[0]), 28);
}

TEST(Recording, CleanOnesPass) {
  for (const double ar : {0.0, 0.9})
    EXPECT_EQ(explained(testing::recorded("hand", ar, 2), testing::one_sensor()).left,
              criticism::search::Finding::pass)
        << ar;
}

/// Readings that large noise moves are bent about the residual: no law hides in that.
TEST(Recording, CleanOnesOfLargeNoisePass) {
  for (const char* motion : {"hand", "flight"})
    EXPECT_EQ(explained(testing::recorded(motion, 0, 2, kLargeNoise), testing::one_sensor()).left,
              criticism::search::Finding::pass)
        << motion;
}

TEST(Recording, ALawInLargeNoiseIsNamed) {
  const auto found = explained(
      testing::recorded(
          "hand", 0, 2,
          std::string(kLargeNoise) + "[[effect]]\nname = \"axis.cubic\"\nwhere = \"s1.x\"\nnT_at_F0 = 100\n"),
      testing::one_sensor());
  ASSERT_EQ(found.rounds.size(), 1U);
  EXPECT_EQ(found.rounds.front().added.effect, "axis.cubic");
  EXPECT_EQ(found.left, criticism::search::Finding::pass);
}

/// Beside a disturbance of no library, steps that follow it are not named.
TEST(Recording, LawsThatOnlyDescribeAreNotNamed) {
  const auto found =
      explained(testing::recorded("hand", 0, 2,
                                  "scalar = false\n[[effect]]\nname = \"hidden.site-oscillation\"\nnT "
                                  "= [30, 20, 10]\nperiod_s = 60\n"),
                testing::one_sensor());
  EXPECT_TRUE(found.rounds.empty());
  EXPECT_EQ(found.finding, criticism::search::Finding::unknown);
}

/// Steps enough leave nothing; what they followed is no less unknown.
TEST(Recording, LawsThatDescribeEverythingDoNotMakeItPass) {
  const auto scenario = testing::scenario_of(
      testing::one_sensor(), 2,
      "[sensors]\nnoise_nT = 0.2\n[recording]\nmotion = \"flight\"\nrate_hz = 10\nduration_s = 120\n"
      "scalar = false\n[[effect]]\nname = \"hidden.site-oscillation\"\nnT = [10, -20, 15]\nperiod_s = 300\n");
  const auto found = explained(rig::pose_table_of(rig::simulated_recording(scenario)), testing::one_sensor());
  EXPECT_TRUE(found.rounds.empty());
  EXPECT_EQ(found.finding, criticism::search::Finding::unknown);
}

TEST(Recording, TheReportSaysThatNeighboursAreAlike) {
  const std::string text = report::to_text(fitted(testing::recorded("hand", 0.9, 2), testing::one_sensor()));
  EXPECT_THAT(text, HasSubstr("count as one in the uncertainties"));
  EXPECT_THAT(text, HasSubstr("no table angles: alpha = beta = gamma = 0, relative to the mounting;"));
  EXPECT_THAT(text, Not(HasSubstr("nan")));
}

TEST(Recording, WhatDoesNotExciteIsRefused) {
  for (const char* motion : {"level", "one-axis"}) {
    const auto report =
        fit::method_choice::fit(testing::recorded(motion, 0, 2), testing::options_of(testing::one_sensor()));
    EXPECT_TRUE(!report || !report->calibration.accepted_by_checks) << motion;
  }
}

}  // namespace
}  // namespace mgtd::calib
