// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>

#include "calib/criticism/search/explain.h"
#include "calib/fit/joint/joint_findings.h"
#include "calib/fit/joint/joint_fit.h"
#include "calib/fit/joint/reference_turn.h"
#include "calib/report/fit_reasons.h"
#include "calib/validity/validity_check.h"
#include "tests/support/checkout.h"
#include "tests/support/child_process.h"
#include "tests/support/whole_file.h"
#include "tests/unit/calib/fit/fitted_arrays.h"

/// A vector reference that stands still beside the table, which turns the sensors.
namespace mgtd::calib {
namespace {

using testing::band;
using ::testing::Contains;
using testing::fitted;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::options_of;
using testing::Places;
using testing::squared_error;

constexpr const char* kBeside =
    "[reference]\nvector = true\nframe = \"site\"\nscalar = false\nsd_nT = 0.2\nmisalignment_deg = [4, -7, "
    "130]\n";
/// The field moves by a third of a degree and half a percent, slowly enough to stand still in a dwell.
constexpr const char* kStorm =
    "[[effect]]\nname = \"hidden.site-oscillation\"\nnT = [520, -360, 280]\nperiod_s = 30000\n"
    "[[effect]]\nname = \"hidden.site-oscillation\"\nnT = [-60, 100, 50]\nperiod_s = 6000\n";
constexpr const char* kGoodTable = "[table]\naccuracy_deg = 0.005\n";

PoseTable run_beside(const Places& places, std::uint64_t seed, const std::string& more = kStorm) {
  return testing::turned_run(places, seed, kBeside + more);
}

fit::joint::JointFit joint_fit(const PoseTable& table, const Places& places) {
  fit::joint::JointOptions options;
  options.geometry = testing::geometry_of(places);
  auto fit = fit::joint::fit_joint(table, options);
  if (!fit) throw std::runtime_error(fit.error().text());
  return *std::move(fit);
}

std::string refusal(const PoseTable& table) {
  const auto report = fit::method_choice::fit(table, options_of(testing::one_sensor()));
  return report ? "fitted" : report.error().text();
}

/// The vector is measured where the field is 18 nT smaller; a scalar magnetometer, 0.2 nT good, is at the
/// array.
constexpr const char* kElsewhere =
    "[reference]\nvector = true\nframe = \"site\"\nscalar = true\nsd_nT = 0.2\nat_m = [8, -3, 0.5]\n"
    "misalignment_deg = [4, -7, 130]\n[scalar]\nnoise_nT = 0.2\n"
    "[[effect]]\nname = \"site.gradient\"\nnT_per_m = [6, -2, 1.5, -3, 2]\n";

PoseTable run_elsewhere(std::uint64_t seed, std::size_t scalar_every) {
  PoseTable table = testing::turned_run(testing::one_sensor(), seed, kElsewhere + std::string(kStorm));
  for (std::size_t k = 0; k < table.poses.size(); ++k)
    if (k % scalar_every != 0) table.poses[k].f_nT = table.poses[k].f_sd_nT = std::nullopt;
  return table;
}

/// Without the vector, what a scalar magnetometer at the same place would have read.
PoseTable with_its_size_alone(PoseTable table) {
  for (Pose& pose : table.poses) {
    pose.f_nT = pose.ref_nT->norm();
    pose.f_sd_nT = pose.ref_sd_nT;
    pose.ref_nT = std::nullopt, pose.ref_sd_nT = std::nullopt;
  }
  return table;
}

/// Mean over the runs.
double mean_squared_error(const Places& places, int runs, const std::string& more) {
  double sum = 0;
  for (int seed = 1; seed <= runs; ++seed) {
    const auto at = static_cast<std::uint64_t>(seed);
    sum += squared_error(fitted(run_beside(places, at, more), places).calibration,
                         testing::scenario_of(places, at, kBeside + more).truth);
  }
  return sum / runs;
}

TEST(ReferenceBeside, TheUncertaintiesAreHonestInAStorm) {
  EXPECT_NEAR(mean_squared_error(testing::one_sensor(), 40, kStorm), 12, band(12, 40));
  EXPECT_NEAR(mean_squared_error(testing::tetrahedron(), 12, kStorm), 48, band(48, 12));
}

TEST(ReferenceBeside, TheUncertaintiesAreHonestInAQuietField) {
  EXPECT_NEAR(mean_squared_error(testing::one_sensor(), 40, ""), 12, band(12, 40));
}

TEST(ReferenceBeside, AStormIsTakenOut) {
  const Places one = testing::one_sensor();
  const PoseTable table = run_beside(one, 3, kStorm + std::string(kGoodTable));
  const fit::joint::JointFit with = joint_fit(table, one),
                             without = joint_fit(with_its_size_alone(table), one);
  EXPECT_LT(with.table_sd_rad, to_rad(0.01));
  EXPECT_GT(without.table_sd_rad, 4 * with.table_sd_rad);
  // What is known about the common rotation is known better.
  for (std::size_t a = 0; a < 3; ++a)
    EXPECT_GT(without.common_rotation_sd_rad.at(a), 4 * with.common_rotation_sd_rad.at(a));
  EXPECT_NEAR(with.chi2 / with.dof, 1, 5 * std::sqrt(2 / with.dof));
}

/// The turn of the reference, the direction of the field in it, and the rest of the misalignment.
TEST(ReferenceBeside, HowItStandsIsFoundWhereTheFieldMoves) {
  const Places one = testing::one_sensor();
  const std::string more = kStorm + std::string(kGoodTable);
  const auto scenario = testing::scenario_of(one, 4, kBeside + more);
  const fit::joint::JointFit fit = joint_fit(run_beside(one, 4, more), one);
  const Eigen::Matrix3d off = *fit.state.R_SR * scenario.reference->R().transpose();
  ASSERT_TRUE(fit.gauge.reference_turn_sd_rad.has_value());
  const double sd_rad = *fit.gauge.reference_turn_sd_rad;
  EXPECT_LT(sd_rad, to_rad(1));
  EXPECT_LT(Eigen::AngleAxisd(off).angle(), 5 * sd_rad);
}

/// The noise of the reference is no movement of the field, however small the errors of the table are.
TEST(ReferenceBeside, ATurnThatNothingTellsHasNoUncertainty) {
  const Places one = testing::one_sensor();
  for (const char* noise : {"", "[table]\naccuracy_deg = 0\n"}) {
    const PoseTable table = run_beside(one, 5, noise);
    EXPECT_FALSE(joint_fit(table, one).gauge.reference_turn_sd_rad.has_value());
    EXPECT_THAT(fitted(table, one).calibration.gauge,
                HasSubstr("its turn about the field not known and without effect"));
  }
  EXPECT_THAT(fitted(run_beside(one, 5, kStorm + std::string(kGoodTable)), one).calibration.gauge,
              HasSubstr("takes the variations of the field out, its turn about the field known to "));
}

/// Eight metres away the field is another; its size at the array is that of the scalar magnetometer.
TEST(ReferenceBeside, TheScenarioIsFittedDownToTheNoise) {
  const std::string path = mgtd::testing::source_path("tests/scenarios/reference_beside.toml");
  const rig::Scenario scenario = rig::parse_scenario(mgtd::testing::whole_file(path), path).value();
  const PoseTable table = rig::simulated_table(scenario, rig::run_of_157({}, scenario.seed), scenario.seed);
  EXPECT_GT(std::abs(*table.poses[0].f_nT - table.poses[0].ref_nT->norm()), 5);
  const fit::FitReport report = fitted(table, testing::one_sensor());
  EXPECT_TRUE(report.calibration.accepted_by_checks);
  EXPECT_NEAR(report.chi2 / report.dof, 1, 5 * std::sqrt(2 / report.dof));
  EXPECT_LT(squared_error(report.calibration, scenario.truth), 12 + band(12, 1));
}

/// In every fortieth pose: the difference of the two places is known to a tenth of a nanotesla, and that
/// error is common to the total fields of all the other poses.
TEST(ReferenceBeside, ATotalFieldInSomePosesCountsForAll) {
  constexpr int kRuns = 20;
  double sum = 0;
  for (int seed = 1; seed <= kRuns; ++seed) {
    const auto at = static_cast<std::uint64_t>(seed);
    const PoseTable table = run_elsewhere(at, 40);
    EXPECT_GT(std::abs(*table.poses[0].f_nT - table.poses[0].ref_nT->norm()), 5);
    const fit::FitReport report = fitted(table, testing::one_sensor());
    EXPECT_TRUE(report.calibration.accepted_by_checks);
    EXPECT_LT(report.after.total_field_rmse_nT[0], 0.5);
    sum += squared_error(
        report.calibration,
        testing::scenario_of(testing::one_sensor(), at, kElsewhere + std::string(kStorm)).truth);
  }
  EXPECT_NEAR(sum / kRuns, 12, band(12, kRuns));
}

TEST(ReferenceBeside, ACalibrationIsCheckedByARunWithSomeTotalFields) {
  const calibration::Calibration c = fitted(run_elsewhere(8, 1), testing::one_sensor()).calibration;
  PoseTable later = run_elsewhere(8, 5);
  later.poses.resize(40);
  const auto valid = validity::check(c, later, options_of(testing::one_sensor()));
  ASSERT_TRUE(valid) << valid.error().text();
  EXPECT_TRUE(valid->valid);
}

std::string reasons_of(const PoseTable& table) {
  std::string out;
  for (const std::string& reason : report::fit_reasons(fitted(table, testing::one_sensor())))
    out += reason + "\n";
  return out;
}

/// The samples of a dwell have a noise of 0.3 nT, and the field moves by more than that meanwhile.
TEST(ReferenceBeside, WhatTheFieldDoesInADwellIsNoNoise) {
  const std::string fast =
      "[[effect]]\nname = \"hidden.site-oscillation\"\nnT = [360, 300, 600]\nperiod_s = 6000\n";
  const Places one = testing::one_sensor();
  const fit::FitReport report = fitted(run_beside(one, 6, fast), one);
  EXPECT_NEAR(calibration::root_mean_square(report.calibration.sample_noise_nT), 0.3, 0.03);
  EXPECT_NEAR(report.chi2 / report.dof, 1, 5 * std::sqrt(2 / report.dof));
  EXPECT_THAT(report::fit_reasons(report), Contains(HasSubstr("is taken off the spread of the samples")));
  const fit::FitReport scalar = fitted(with_its_size_alone(run_beside(one, 6, fast)), one);
  EXPECT_GT(calibration::root_mean_square(scalar.calibration.sample_noise_nT), 0.4);
  EXPECT_THAT(report::fit_reasons(scalar), Contains(HasSubstr("the spread of the samples contains it")));
  EXPECT_THAT(report::fit_reasons(fitted(run_beside(one, 6, ""), one)),
              Not(Contains(HasSubstr("within a dwell"))));
}

/// Against the sensors where the table has no f_nT, else against that.
TEST(ReferenceBeside, AVectorThatScattersOtherThanStatedIsTold) {
  const Places one = testing::one_sensor();
  for (const PoseTable& honest : {run_beside(one, 3), run_elsewhere(3, 1)}) {
    EXPECT_THAT(reasons_of(honest), Not(HasSubstr("the vector reference scatters")));
    PoseTable overstated = honest, understated = honest;
    for (Pose& pose : overstated.poses) pose.ref_sd_nT = 5;
    for (Pose& pose : understated.poses) pose.ref_sd_nT = 0.02;
    EXPECT_THAT(reasons_of(overstated), HasSubstr("and ref_sd_nT says 5 nT: the fit trusts it too little"));
    EXPECT_THAT(reasons_of(overstated), HasSubstr("give ref_sd_nT = 0.2"));
    EXPECT_THAT(reasons_of(understated), HasSubstr("and ref_sd_nT says 0.02 nT: either its noise"));
  }
  PoseTable assumed = run_beside(one, 3);
  for (Pose& pose : assumed.poses) pose.ref_sd_nT = std::nullopt;
  EXPECT_THAT(reasons_of(assumed), HasSubstr("and 0.05 nT is assumed, since ref_sd_nT is not given"));
}

TEST(ReferenceBeside, AVectorThatScattersLessThanTheScalarIsGivenNoScatterOfZero) {
  PoseTable table = run_elsewhere(3, 1);
  for (Pose& pose : table.poses) pose.ref_sd_nT = 5, pose.f_sd_nT = 1;
  EXPECT_THAT(reasons_of(table), HasSubstr("scatters no more against f_nT than that itself does"));
  EXPECT_THAT(reasons_of(table), HasSubstr("give a smaller ref_sd_nT"));
}

/// One reading of the reference that is off changes neither what is said of it nor the noise of the samples.
TEST(ReferenceBeside, AGrossReadingOfTheReferenceSpoilsNothing) {
  const Places one = testing::one_sensor();
  for (const std::size_t every : {1U, 4U}) {
    const PoseTable honest = run_elsewhere(7, every);
    PoseTable vector = honest, scalar = honest;
    vector.poses[40].ref_nT->x() += 1000;
    *scalar.poses[40].f_nT += 400;
    const fit::FitReport clean = fitted(honest, one);
    for (const PoseTable& table : {vector, scalar}) {
      const fit::FitReport report = fitted(table, one);
      EXPECT_TRUE(report.calibration.accepted_by_checks);
      EXPECT_NEAR(calibration::root_mean_square(report.calibration.sample_noise_nT),
                  calibration::root_mean_square(clean.calibration.sample_noise_nT), 0.005);
      EXPECT_NEAR(report.chi2 / report.dof, 1, 5 * std::sqrt(2 / report.dof));
      EXPECT_THAT(report::fit_reasons(report), Not(Contains(HasSubstr("scatters"))));
      EXPECT_LT(squared_error(report.calibration,
                              testing::scenario_of(one, 7, kElsewhere + std::string(kStorm)).truth),
                12 + band(12, 1));
    }
  }
}

PoseTable caged(const rig::Scenario& scenario) {
  return rig::simulated_table(scenario, rig::cage_fields(*scenario.cage, 4), 4);
}

/// In a cage all three components are compared.
TEST(ReferenceBeside, TheScatterInACageIsMeasured) {
  const Places one = testing::one_sensor();
  PoseTable table = caged(testing::scenario_of(
      one, 4, "[reference]\nvector = true\nscalar = false\nsd_nT = 0.5\n[cage]\nposes = 200\n"));
  const auto told = fitted(table, one).joint->reference_scatter;
  ASSERT_TRUE(told.has_value());
  EXPECT_NEAR(told->measured_nT, 0.5, 0.1);  // 3 % one sigma
  EXPECT_FALSE(told->differs);
  for (Pose& pose : table.poses) pose.ref_sd_nT = 0.05;
  EXPECT_TRUE(fitted(table, one).joint->reference_scatter->more());
}

/// In a cage the vector stands for the total field in the poses that have none.
TEST(ReferenceBeside, SomeTotalFieldsInACageAreUsed) {
  const Places one = testing::one_sensor();
  const std::string text = "[reference]\nvector = true\nscalar = true\nsd_nT = 0.5\n[cage]\nposes = 100\n";
  PoseTable table = caged(testing::scenario_of(one, 4, text));
  for (std::size_t k = 0; k < 50; ++k) table.poses[k].f_nT = table.poses[k].f_sd_nT = std::nullopt;
  const fit::FitReport report = fitted(table, one);
  EXPECT_NEAR(report.chi2 / report.dof, 1, 5 * std::sqrt(2 / report.dof));
  EXPECT_LT(squared_error(report.calibration, testing::scenario_of(one, 4, text).truth), 12 + band(12, 1));
}

TEST(ReferenceBeside, ALawIsNamedAndACleanStormPasses) {
  const Places one = testing::one_sensor();
  const auto explained = [&](const std::string& more) {
    criticism::search::ExplainOptions options{.fit = options_of(one), .rounds = 3, .candidate_effects = {}};
    auto report = criticism::search::explain(run_beside(one, 5, kStorm + more), options);
    if (!report) throw std::runtime_error(report.error().text());
    return *std::move(report);
  };
  EXPECT_EQ(explained("").left, criticism::search::Finding::pass);
  const auto found = explained("[[effect]]\nname = \"axis.cubic\"\nwhere = \"s1.y\"\nnT_at_F0 = 4\n");
  ASSERT_FALSE(found.rounds.empty());
  EXPECT_EQ(found.rounds.front().added.effect, "axis.cubic");
}

TEST(ReferenceBeside, ACalibrationIsCheckedBySuchARun) {
  const Places one = testing::one_sensor();
  const calibration::Calibration c = fitted(run_beside(one, 8), one).calibration;
  PoseTable later = run_beside(one, 8);
  later.poses.resize(30);
  const auto valid = validity::check(c, later, options_of(one));
  ASSERT_TRUE(valid) << valid.error().text();
  EXPECT_TRUE(valid->valid);
  for (Pose& pose : later.poses) pose.y_nT[0][1] += 20;
  const auto moved = validity::check(c, later, options_of(one));
  ASSERT_TRUE(moved) << moved.error().text();
  EXPECT_FALSE(moved->valid);
}

TEST(ReferenceBeside, WhatCannotBeIsRefused) {
  const PoseTable table = run_beside(testing::one_sensor(), 9);
  PoseTable partly = table;
  for (std::size_t k = 0; k < 57; ++k)
    partly.poses[k].azimuth_rad = partly.poses[k].pitch_rad = partly.poses[k].roll_rad = std::nullopt;
  EXPECT_THAT(refusal(partly), HasSubstr("100 of 157 poses with the field as a vector have table angles"));
  PoseTable some = table;
  some.poses[4].ref_nT = std::nullopt;
  EXPECT_THAT(refusal(some), HasSubstr("156 of 157 poses have the field as a vector"));
  PoseTable weak = table;
  weak.poses[7].ref_nT = Eigen::Vector3d(3, 2, 1);
  EXPECT_THAT(refusal(weak),
              HasSubstr("pose 8: the vector of the reference, 3.742 nT long and known to 0.2 nT for each "
                        "component, has no direction (limit 30 times that, 6 nT)"));
  PoseTable microtesla = table;
  for (Pose& pose : microtesla.poses) pose.f_nT = pose.ref_nT->norm(), *pose.ref_nT /= 1000;
  EXPECT_THAT(refusal(microtesla), HasSubstr("(limit a factor of 2)"));
}

TEST(ReferenceBeside, OneThatTurnsWithTheSensorsIsRefused) {
  const std::string on_platform =
      "[reference]\nvector = true\nangles = true\nscalar = false\nmisalignment_deg = [1, 2, 3]\n";
  EXPECT_THAT(refusal(testing::turned_run(testing::one_sensor(), 9, on_platform)),
              HasSubstr("the vector of the reference turns with the table"));
}

/// The sensor of this rig stands along the platform's axes, so the angle itself is named.
TEST(ReferenceBeside, AnAngleCountedBackwardsIsNamed) {
  const PoseTable table = run_beside(testing::one_sensor(), 9);
  PoseTable turned = table;
  for (Pose& pose : turned.poses) *pose.azimuth_rad *= -1;
  EXPECT_THAT(refusal(turned), HasSubstr("the table's azimuth turns against the vector reference"));
  EXPECT_THAT(refusal(turned), HasSubstr("(rms; limit 1 deg), with that angle of the other sign 0."));
  EXPECT_THAT(refusal(turned), HasSubstr("change the sign of azimuth_deg in every pose"));
  turned = table;
  for (Pose& pose : turned.poses) *pose.pitch_rad *= -1;
  EXPECT_THAT(refusal(turned), HasSubstr("the table's pitch turns against the vector reference"));
  turned = table;
  for (Pose& pose : turned.poses) *pose.roll_rad *= -1;
  EXPECT_THAT(refusal(turned), HasSubstr("the table's roll turns against the vector reference"));
}

/// Half a turn about X, azimuth and pitch of the other sign: the same run. So a sensor that hangs upside down
/// makes the azimuth look like the pitch, and one that stands on edge leaves all three open.
TEST(ReferenceBeside, WhichAngleIsCountedBackwardsIsSaidWhereTheMountingTells) {
  PoseTable table = run_beside(testing::one_sensor(), 9);
  for (Pose& pose : table.poses) *pose.azimuth_rad *= -1;
  PoseTable hanging = table, on_edge = table;
  for (Pose& pose : hanging.poses) pose.y_nT[0] = Eigen::Vector3d(1, -1, -1).cwiseProduct(pose.y_nT[0]);
  EXPECT_THAT(refusal(hanging), HasSubstr("the table's pitch turns against"));
  EXPECT_THAT(refusal(hanging), HasSubstr("half a turn round, it would be about X azimuth_deg"));
  for (Pose& pose : on_edge.poses)
    pose.y_nT[0] = Eigen::Vector3d(pose.y_nT[0].y(), pose.y_nT[0].z(), pose.y_nT[0].x());
  EXPECT_THAT(refusal(on_edge), HasSubstr("one of the table's angles turns against"));
}

/// The error of a table, rough as scales read by hand, is no wrong sense, and neither are a few poses that
/// are gross.
TEST(ReferenceBeside, ARoughTableIsNotTakenForOneThatCountsBackwards) {
  const Places one = testing::one_sensor();
  EXPECT_EQ(refusal(run_beside(one, 9, kStorm + std::string("[table]\naccuracy_deg = 3\n"))), "fitted");
  PoseTable gross = run_beside(one, 9);
  for (std::size_t k = 0; k < 8; ++k) *gross.poses[20 * k].azimuth_rad += 2;
  EXPECT_THAT(refusal(gross), Not(HasSubstr("turns against")));
}

TEST(ReferenceBeside, TheSmallestTurnBringsOneDirectionToAnother) {
  const Eigen::Vector3d from = Eigen::Vector3d(1, 2, 3).normalized(),
                        to = Eigen::Vector3d(-2, 0, 1).normalized();
  const Eigen::Matrix3d turn = fit::joint::turn_between(from, to);
  EXPECT_LT((turn * from - to).norm(), 1e-14);
  EXPECT_LT((turn * from.cross(to) - from.cross(to)).norm(), 1e-14);
}

}  // namespace
}  // namespace mgtd::calib
