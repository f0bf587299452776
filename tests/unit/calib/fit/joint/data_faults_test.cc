// SPDX-License-Identifier: Apache-2.0
// What is wrong with a table before any fit is tried: `fit` and `explain` give the same true reason.
#include "calib/fit/joint/data_faults.h"

#include <gmock/gmock.h>

#include "calib/criticism/search/explain.h"
#include "calib/fit/method_choice/fit.h"
#include "calib/report/explain_note_text.h"
#include "calib/report/fit_reasons.h"
#include "calib/report/verdict_text.h"
#include "tests/blind/hidden_run.h"

namespace mgtd::calib::fit::joint {
namespace {

using ::testing::HasSubstr;
using testing::hidden_run;
using testing::simulate;

struct Row {
  std::string title;
  void (*damage)(PoseTable& run);
  std::string message, remedy;
};

void PrintTo(const Row& row, std::ostream* out) { *out << row.title; }

void scale_sensors(PoseTable& run, std::size_t from, double factor) {
  for (Pose& pose : run.poses) {
    for (std::size_t i = from; i < pose.y_nT.size(); ++i) pose.y_nT[i] *= factor;
  }
}

std::vector<Row> rows() {
  return {
      {"readings_in_microtesla", [](PoseTable& run) { scale_sensors(run, 0, 1e-3); },
       "the readings of all sensors look like uT", "by 1000"},
      {"readings_in_millitesla", [](PoseTable& run) { scale_sensors(run, 0, 1e-6); },
       "the readings of all sensors look like mT", "by 1000000"},
      {"readings_in_gauss", [](PoseTable& run) { scale_sensors(run, 0, 1e-5); },
       "the readings of all sensors look like G", "by 100000"},
      {"one_sensor_in_microtesla", [](PoseTable& run) { scale_sensors(run, 3, 1e-3); },
       "the readings of s4 look like uT", "by 1000"},
      {"readings_in_picotesla", [](PoseTable& run) { scale_sensors(run, 0, 1e3); },
       "the readings of all sensors look like pT", "by 0.001"},
      {"total_field_in_microtesla",
       [](PoseTable& run) {
         for (Pose& pose : run.poses) *pose.f_nT *= 1e-3;
       },
       "the total field looks like uT", "f_nT"},
      {"vector_reference_in_microtesla",
       [](PoseTable& run) {
         for (Pose& pose : run.poses) {
           pose.ref_nT = 1e-3 * Eigen::Vector3d(*pose.f_nT, 0, 0);
           pose.ref_sd_nT = 1e-6;
           pose.f_nT.reset();
         }
       },
       "the vector reference looks like uT", "ref_x_nT, ref_y_nT and ref_z_nT (and ref_sd_nT) by 1000"},
      {"microtesla_without_a_field",
       [](PoseTable& run) {
         scale_sensors(run, 0, 1e-3);
         for (Pose& pose : run.poses) pose.f_nT.reset();
       },
       "the readings of all sensors look like uT", "by 1000"},
      {"one_sensor_copied_four_times",
       [](PoseTable& run) {
         for (Pose& pose : run.poses) pose.y_nT[1] = pose.y_nT[2] = pose.y_nT[3] = pose.y_nT[0];
       },
       "s2, s3 and s4 read digit for digit what s1 reads: one sensor was copied, 4 are needed",
       "taken twice"},
      {"two_sensors_on_one_port",
       [](PoseTable& run) {
         for (Pose& pose : run.poses) pose.y_nT[3] = pose.y_nT[1];
       },
       "s4 reads digit for digit what s2 reads", "taken twice"},
      {"four_sensors_turned_one_by_one",
       [](PoseTable& run) {
         const PoseTable as_it_was = run;
         const std::size_t n = run.poses.size();
         for (std::size_t k = 0; k < n; ++k) {
           for (std::size_t i = 1; i < 4; ++i)
             run.poses[k].y_nT[i] = as_it_was.poses[(k + 41 * i) % n].y_nT[i];
         }
       },
       "s2, s3 and s4 did not turn together with s1", "one attitude of one platform"},
  };
}

std::string title_of(const ::testing::TestParamInfo<Row>& info) { return info.param.title; }

class DataFault : public ::testing::TestWithParam<Row> {};

TEST_P(DataFault, IsNamedByFitAndExplainAlike) {
  PoseTable run = hidden_run({}, 3);
  GetParam().damage(run);
  const auto fitted = method_choice::fit(run, {});
  const auto explained = criticism::search::explain(run, {});
  ASSERT_FALSE(fitted);
  ASSERT_FALSE(explained);
  EXPECT_THAT(fitted.error().message, HasSubstr(GetParam().message));
  EXPECT_THAT(fitted.error().remedy, HasSubstr(GetParam().remedy));
  EXPECT_EQ(explained.error().message, fitted.error().message);
}

INSTANTIATE_TEST_SUITE_P(Fit, DataFault, ::testing::ValuesIn(rows()), &title_of);

TEST(DataFaults, AMirroredSensorIsRefusedByTheFitInTheWordsOfExplain) {
  PoseTable run = hidden_run({}, 3);
  for (Pose& pose : run.poses) pose.y_nT[1][2] *= -1;
  const auto fitted = method_choice::fit(run, {});
  const auto explained = criticism::search::explain(run, {});
  ASSERT_TRUE(fitted && explained);
  EXPECT_FALSE(fitted->calibration.accepted_by_checks);
  EXPECT_EQ(explained->finding, criticism::search::Finding::bad_data);
  const std::string words =
      "sensor 2 is mirrored: left-handed axes, two leads are swapped or one is inverted";
  EXPECT_THAT(report::fit_reasons(*fitted), ::testing::Contains(HasSubstr(words)));
  EXPECT_THAT(report::note_texts(explained->notes), ::testing::Contains(HasSubstr(words)));
}

TEST(DataFaults, ATableSetByHandPassesAndItsUncertaintyIsTold) {
  testing::Simulation sim{.noise_nT = 0.3, .table_sd_rad = to_rad(2), .f_sd_nT = 0.05};
  const PoseTable run = simulate(sim, 36, 121, 1);
  const auto untold = criticism::search::explain(run, {});
  ASSERT_TRUE(untold) << untold.error().text();
  EXPECT_EQ(untold->finding, criticism::search::Finding::pass) << report::sentence(*untold);
  EXPECT_THAT(report::note_texts(untold->notes),
              ::testing::Contains(HasSubstr("the table angles are good to")));
  const auto untold_fit = method_choice::fit(run, {});
  ASSERT_TRUE(untold_fit) << untold_fit.error().text();
  EXPECT_TRUE(untold_fit->calibration.accepted_by_checks) << report::fit_reasons(*untold_fit).front();
  EXPECT_THAT(report::fit_reasons(*untold_fit),
              ::testing::Contains(HasSubstr("the table angles are good to")));
  FitOptions told;
  told.table_sd_rad = to_rad(2);
  const auto fitted = method_choice::fit(run, told);
  const auto explained = criticism::search::explain(run, {.fit = told});
  ASSERT_TRUE(fitted && explained);
  EXPECT_TRUE(fitted->calibration.accepted_by_checks) << report::fit_reasons(*fitted).front();
  EXPECT_EQ(explained->finding, criticism::search::Finding::pass) << report::sentence(*explained);
  EXPECT_TRUE(explained->notes.empty());
}

/// Ten degrees, the most that can be stated, is no answer that a table of a tenth of a degree must keep.
TEST(DataFaults, AGoodTableStatedAsThePoorestIsFoundGood) {
  const PoseTable run = simulate({.noise_nT = 0.3, .table_sd_rad = to_rad(0.1), .f_sd_nT = 0.05}, 36, 121, 1);
  const auto fit = fit_joint(run, {.table_sd_rad = to_rad(10)});
  ASSERT_TRUE(fit) << fit.error().text();
  EXPECT_NEAR(to_deg(fit->table_sd_rad), 0.1, 0.02);
}

/// Angles that are typed wrong are left out, and then neither their size nor their number counts.
TEST(DataFaults, WrongAnglesAreInNoChiSquare) {
  PoseTable run = simulate({.noise_nT = 0.3, .table_sd_rad = to_rad(0.1), .f_sd_nT = 0.05}, 36, 121, 1);
  const auto right = fit_joint(run, {});
  ASSERT_TRUE(right) << right.error().text();
  constexpr double kWrong = 16;
  for (std::size_t k = 40; k < 152; k += 7) *run.poses[k].azimuth_rad += to_rad(40);
  const auto fit = fit_joint(run, {});
  ASSERT_TRUE(fit) << fit.error().text();
  EXPECT_EQ(fit->outliers.size(), static_cast<std::size_t>(kWrong));
  EXPECT_NEAR(to_deg(fit->table_sd_rad), 0.1, 0.02);
  EXPECT_NEAR(fit->chi2_table / fit->dof_table, 1, 0.05);
  // Each of these attitudes told two of its four unknowns; the third, about the field, is still the table's.
  EXPECT_NEAR(fit->dof, right->dof, 0.5 * kWrong);
  EXPECT_NEAR(fit->chi2, fit->dof, 3 * std::sqrt(2 * fit->dof));
}

}  // namespace
}  // namespace mgtd::calib::fit::joint
