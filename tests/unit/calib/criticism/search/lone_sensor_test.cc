// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <algorithm>

#include "calib/criticism/search/explain.h"
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

}  // namespace
}  // namespace mgtd::calib::criticism::search
