// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "calib/fit/method_choice/fit.h"
#include "calib/report/fit_report_json.h"
#include "calib/report/fit_report_text.h"
#include "tests/support/paper_rigs.h"

namespace mgtd::calib::fit {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

const FitReport& report() {
  static const FitReport kReport = [] {
    PoseTable table = mgtd::testing::measure(mgtd::testing::table6_rig(), {53'907.7, 60, -5},
                                             mgtd::testing::standard_run(121, 5), 36,
                                             {mgtd::testing::Noise::Kind::gaussian, 0.3, 0.1}, 17);
    for (std::size_t k = 150; k < table.poses.size(); ++k) table.poses[k].set = "check";
    FitOptions options;
    options.method = Method::two_step;
    return *method_choice::fit(table, options);
  }();
  return kReport;
}

TEST(FitReportJson, HoldsTheDocumentedKeys) {
  const nlohmann::json out = report::to_json(report());
  for (const char* key : {"schema", "method", "poses", "accepted", "reasons", "gauge", "chi2", "dof",
                          "noise_nT", "sensors", "effects", "before", "after", "held_out", "id"}) {
    EXPECT_TRUE(out.contains(key)) << key;
  }
  EXPECT_EQ(out["schema"], "mgt.fit/1");
  EXPECT_EQ(out["method"], "two-step");
  EXPECT_EQ(out["poses"], 150);
  ASSERT_EQ(out["sensors"].size(), 4U);
  for (const char* key : {"theta_deg", "phi_deg", "psi_deg", "cx", "cy", "cz", "ix_nT", "iy_nT", "iz_nT",
                          "alpha_deg", "beta_deg", "gamma_deg"}) {
    EXPECT_TRUE(out["sensors"][3][key]["value"].is_number()) << key;
    EXPECT_GT(out["sensors"][3][key]["sd"].get<double>(), 0) << key;
  }
  EXPECT_EQ(out["before"]["total_field_rmse_nT"].size(), 4U);
  EXPECT_TRUE(out["held_out"]["tensor_rmse_nT_per_m"]["yz"].is_number());
}

TEST(FitReportJson, TheTwoStepIsSolvedInClosedForm) {
  const nlohmann::json out = report::to_json(report())["summary"];
  EXPECT_EQ(out["termination"], "closed-form");
  EXPECT_EQ(out["converged"], true);
  EXPECT_EQ(out["iterations"], 0);
  EXPECT_GT(out["initial_cost"].get<double>(), out["final_cost"].get<double>());
  EXPECT_THAT(report::to_text(report()), HasSubstr("fit:   solved in closed form: chi-square fell from "));
}

TEST(FitReportJson, AnglesAreDegrees) {
  const nlohmann::json out = report::to_json(report());
  EXPECT_NEAR(out["sensors"][0]["gamma_deg"]["value"].get<double>(), -2.177,
              0.2);  // Table 6, a 0.1 deg table
  EXPECT_NEAR(out["site"]["inclination_deg"]["value"].get<double>(), 60, 0.2);
}

TEST(FitReportJson, BothHalvesOfTheStandardSetAreThere) {
  const nlohmann::json halves = report::to_json(report())["halves"];
  EXPECT_TRUE(halves["two_step_odd"]["tensor_rmse_nT_per_m"]["xy"].is_number());
  EXPECT_NEAR(halves["two_step_odd"]["sensors"][2]["beta_deg"].get<double>() -
                  halves["two_step_even"]["sensors"][2]["beta_deg"].get<double>(),
              halves["odd_less_even"][2]["beta_deg"].get<double>(), 1e-12);
}

TEST(FitReportJson, PosesOfTheCheckSetArePredictedAndNotFitted) {
  const nlohmann::json out = report::to_json(report());
  // No fit has seen them: noise of 0.3 nT, and a little more from the parameters.
  EXPECT_NEAR(out["check_poses"]["total_field_rmse_nT"][0].get<double>(), 0.3, 0.3);
}

TEST(FitReportText, TellsVerdictStagesAndParameters) {
  const std::string text = report::to_text(report());
  for (const char* part :
       {"two-step calibration c", "of 150 poses: accepted by its checks", "gauge: ", "before ", "simplified ",
        "step 1 ", "odd half", "held out", "theta deg", " ± ", "scale factors", "  ok "}) {
    EXPECT_THAT(text, HasSubstr(part));
  }
}

TEST(FitReportText, SaysWhichReadingsNoRowCounts) {
  FitReport some = report();
  EXPECT_THAT(report::rows_text(some), Not(HasSubstr("left out")));
  some.outliers = {{5, "s4.z", -50, "nT", 107}};
  EXPECT_THAT(report::rows_text(some),
              HasSubstr("no row counts the reading that the fit left out: s4.z of pose 5"));
  some.outliers.push_back({7, "angles", 1, "deg", 20});
  some.outliers.push_back({9, "s1.x", 30, "nT", 20});
  EXPECT_THAT(report::rows_text(some),
              HasSubstr("the 2 readings that the fit left out: s4.z of pose 5, s1.x of pose 9"));
}

TEST(FitReportText, AFailedCheckShowsItsRemedy) {
  FitReport bad = report();
  bad.calibration.accepted_by_checks = false;
  bad.calibration.checks.push_back({"residual", false, "90 nT", "54 nT", "look for iron near the rig"});
  const std::string text = report::to_text(bad);
  EXPECT_THAT(text, HasSubstr("NOT ACCEPTED"));
  EXPECT_THAT(text, HasSubstr("FAIL  residual"));
  EXPECT_THAT(text, HasSubstr("-> look for iron near the rig"));
}

}  // namespace
}  // namespace mgtd::calib::fit
