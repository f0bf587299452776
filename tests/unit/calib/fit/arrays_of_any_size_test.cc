// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

#include "calib/calibration/apply.h"
#include "calib/effects/library/library.h"
#include "calib/report/fit_report_text.h"
#include "tests/unit/calib/fit/fitted_arrays.h"

namespace mgtd::calib {
namespace {

using testing::band;
using testing::explained;
using testing::fitted;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::Places;
using testing::squared_error;

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

}  // namespace
}  // namespace mgtd::calib
