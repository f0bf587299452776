// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "calib/criticism/search/explain.h"
#include "calib/criticism/search/waterfall.h"
#include "calib/effects/library/library.h"
#include "calib/report/explain_figures.h"
#include "calib/report/waterfall_report.h"
#include "tests/unit/calib/fit/fitted_arrays.h"

/// One sensor whose attitude nothing tells.
namespace mgtd::calib::criticism::search {
namespace {

ExplainReport explained(const PoseTable& table) {
  ExplainOptions options{
      .fit = testing::options_of(testing::one_sensor()), .rounds = 3, .candidate_effects = {}};
  auto report = explain(table, options);
  if (!report) throw std::runtime_error(report.error().text());
  return *std::move(report);
}

/// A turn with the temperature is one of the attitude, and what is left of it rounding.
TEST(LoneSensor, ATurnOfItCannotBeTested) {
  PoseTable table = testing::turned_run(
      testing::one_sensor(), 3, "[temperature]\npulse_degC = 12\npulse_at_s = 600\npulse_tau_s = 900\n");
  for (Pose& pose : table.poses) pose.azimuth_rad = pose.pitch_rad = pose.roll_rad = std::nullopt;
  const ExplainReport report = explained(table);
  constexpr const char* kTurn = "platform.thermal-bending";
  const auto tested = [&](const tests::Candidate& c) { return c.effect == kTurn; };
  EXPECT_TRUE(std::none_of(report.candidates.begin(), report.candidates.end(), tested));
  EXPECT_TRUE(std::any_of(report.untestable.begin(), report.untestable.end(),
                          [&](const tests::Untestable& u) { return u.effect == kTurn; }));
  EXPECT_EQ(report.finding, Finding::pass);
}

/// It has no tensor, and so nothing is taken out of its error.
TEST(LoneSensor, TheWaterfallIsOfTheReadingsAlone) {
  const PoseTable table = testing::turned_run(
      testing::one_sensor(), 3, "[[effect]]\nname = \"axis.cubic\"\nwhere = \"s1.z\"\nnT_at_F0 = 5\n");
  fit::FitOptions options = testing::options_of(testing::one_sensor());
  options.effects = {*effects::library::make_effect("axis.cubic@s1.z", 1)};
  const auto w = waterfall(table, options);
  ASSERT_TRUE(w) << w.error().text();
  ASSERT_EQ(w->steps.size(), 1U);
  EXPECT_GT(w->steps[0].last_nT, 0.1);
  EXPECT_TRUE(std::isnan(w->steps[0].first_nT_per_m) && std::isnan(w->steps[0].last_nT_per_m));
  const auto written = nlohmann::json::parse(report::to_json(*w).dump());
  EXPECT_TRUE(written.at("steps")[0].at("dropped_last_nT_per_m").is_null());
  EXPECT_EQ(report::to_text(*w).find("nT/m"), std::string::npos) << report::to_text(*w);
  EXPECT_EQ(report::waterfall_of(*w, {}).svg.find("tensor"), std::string::npos);
}

}  // namespace
}  // namespace mgtd::calib::criticism::search
