// SPDX-License-Identifier: Apache-2.0
#include "calib/report/law_pages.h"

#include <gmock/gmock.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "calib/report/discovery_report.h"

namespace mgtd::calib::report {
namespace {

using discovery::DiscoveryReport;
using discovery::LawFinding;
using ::testing::Contains;
using ::testing::HasSubstr;

/// A LAW-SET of two formulas over the temperature, with its curve.
DiscoveryReport found(LawFinding finding) {
  discovery::FoundLaw law{.more = 3, .log10_p = -20, .stands_out = true, .d = 12, .walk_P = 0.01};
  law.covariates = {{"T", 0.99}, {"t_h", 0.01}};
  law.where = {{"s3.z", 1.0}};
  law.formulas = {{.formula = "T^2", .where = "s3.z", .P = 0.7, .S = 150, .size_nT = 0.4, .k = 1},
                  {.formula = "exp(T)", .where = "s3.z", .P = 0.25, .S = 148, .size_nT = 0.39, .k = 1}};
  law.halves_ratio = 1.1;
  law.held_out_fall = 140;
  law.shape = discovery::LawShape{.covariate = "s3_T_degC",
                                  .where = "s3.z",
                                  .x = {18, 19, 20},
                                  .y_nT = {0, 0.3, 1},
                                  .sd_nT = {0.1, 0.1, 0.1},
                                  .simultaneous = 2.5,
                                  .formulas = {{"T^2", {0, 0.31, 1.4}}}};
  return {.finding = finding, .laws = {law}};
}

TEST(LawPages, SayTheFormulaWhatElseItCouldBeAndHowSureThatIs) {
  const auto pages = law_pages(to_json(found(LawFinding::law_set), "run.mgtrun"));
  ASSERT_TRUE(pages) << pages.error().text();
  ASSERT_EQ(pages->size(), 1U);
  const LawPage& page = pages->front();
  EXPECT_EQ(page.title, "LAW-SET: T^2 at s3.z");
  ASSERT_EQ(page.formulas.rows.size(), 2U);
  EXPECT_EQ(page.formulas.rows[1][0], "exp(T)");
  EXPECT_EQ(page.formulas.rows[1][2], "0.25");
  EXPECT_THAT(page.notes, Contains("Depends on T 0.99, t_h 0.01; acts on s3.z 1.00."));
  EXPECT_THAT(page.notes, Contains(HasSubstr("has 3 more")));
  EXPECT_THAT(page.notes, Contains(HasSubstr("an offset that walks 0.01")));
  EXPECT_THAT(page.notes, Contains(HasSubstr("1.10 times the size")));
  EXPECT_THAT(page.notes, Contains(HasSubstr("falls by 140")));
}

TEST(LawPages, DrawTheCurveAndWhereTheFormulaLeavesItsBand) {
  const auto pages = law_pages(to_json(found(LawFinding::law), "run.mgtrun"));
  ASSERT_TRUE(pages && pages->front().curve);
  const figures::Figure& curve = *pages->front().curve;
  EXPECT_THAT(curve.svg, HasSubstr("temperature of s3, °C"));
  EXPECT_THAT(curve.good, HasSubstr("T^2 leaves it at 1 of 3 points"));
  EXPECT_TRUE(curve.stands_out);
  EXPECT_EQ(curve.data.rows.size(), 3U);
}

TEST(LawPages, GiveNoFormulaToAShape) {
  const auto pages = law_pages(to_json(found(LawFinding::shape_only), "run.mgtrun"));
  ASSERT_TRUE(pages);
  EXPECT_EQ(pages->front().title, "SHAPE-ONLY on s3.z");
  EXPECT_TRUE(law_pages(to_json(found(LawFinding::pass), "run.mgtrun"))->empty());
}

TEST(LawPages, RefuseWhatIsNoSearch) {
  nlohmann::json other = to_json(found(LawFinding::law), "run.mgtrun");
  EXPECT_FALSE(law_pages(nlohmann::json::object()));
  other["schema"] = "mgt.discover/9";
  EXPECT_FALSE(law_pages(other));
  other["schema"] = "mgt.discover/1";
  other["laws"][0].erase("formulas");
  EXPECT_FALSE(law_pages(other));
}

}  // namespace
}  // namespace mgtd::calib::report
