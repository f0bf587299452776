// SPDX-License-Identifier: Apache-2.0
#include "calib/report/parameter_history.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tests/support/sealed_calibration.h"

namespace mgtd::calib::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// An offset that moved by ten standard errors of the difference is named with its size and that error.
TEST(ParameterHistory, TellsWhichParameterMovedAndHowFar) {
  const auto march = mgtd::testing::sealed_calibration("2026-03-02T08:00:00Z");
  auto may = mgtd::testing::sealed_calibration("2026-05-11T08:00:00Z");
  may.sensors[2].offset_nT.z() += 10 * std::sqrt(2.0) * mgtd::testing::kOffsetSd_nT;
  may.seal();
  const ParameterMoves moves = moves_between(march, may);
  EXPECT_TRUE(moves.diff.changed);
  const nlohmann::json told = to_json(moves);
  EXPECT_EQ(told.at("to"), may.id);
  const auto& parameters = told.at("parameters");
  ASSERT_EQ(parameters.size(), 48U);
  EXPECT_EQ(parameters.at(0).at("name"), "s3 iz");
  EXPECT_NEAR(parameters.at(0).at("moved").get<double>(), 10 * std::sqrt(2.0) * mgtd::testing::kOffsetSd_nT,
              1e-9);
  EXPECT_NEAR(parameters.at(0).at("moved_sd").get<double>(), std::sqrt(2.0) * mgtd::testing::kOffsetSd_nT,
              0.005);
  for (std::size_t i = 1; i < parameters.size(); ++i)
    EXPECT_NEAR(parameters.at(i).at("moved").get<double>(), 0, 1e-9) << parameters.at(i).dump();
  const std::string text = moves_text(moves);
  EXPECT_THAT(text, HasSubstr("iz +1.4 ± 0.1"));
  EXPECT_THAT(text, HasSubstr("measured 2026-05-11T08:00Z"));
}

TEST(ParameterHistory, NoLineOfATableIsWiderThanATerminal) {
  auto later = mgtd::testing::sealed_calibration("2026-05-11T08:00:00Z");
  for (auto& sensor : later.sensors) {
    sensor.offset_nT *= -1;
    sensor.theta_rad -= 1e-5;
    sensor.gamma_rad -= 1e-5;
  }
  const std::string text =
      moves_text(moves_between(mgtd::testing::sealed_calibration("2026-03-02T08:00:00Z"), later));
  std::size_t rows = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    const std::string line = text.substr(at, end - at);
    if (line.starts_with("s") && ++rows > 0) {
      const auto marks = std::count(line.begin(), line.end(), '\xc2');  // "±" is two bytes
      EXPECT_LE(line.size() - static_cast<std::size_t>(marks), 80U) << line;
    }
    at = end + 1;
  }
  EXPECT_EQ(rows, 4U);
}

/// In the order of time, whatever the order of the files; another array and one without a date are left out.
TEST(ParameterHistory, GoesThroughTheCalibrationsInTheOrderOfTime) {
  const auto a = mgtd::testing::sealed_calibration("2026-03-02T08:00:00Z"),
             b = mgtd::testing::sealed_calibration("2026-05-11T08:00:00Z"),
             c = mgtd::testing::sealed_calibration("2026-09-20T08:00:00Z"),
             undated = mgtd::testing::sealed_calibration("");
  auto wider = mgtd::testing::sealed_calibration("2026-07-01T08:00:00Z");
  wider.geometry = sensor::Geometry(0.6);
  const auto moves = moves_among({c, a, undated, wider, b});
  ASSERT_EQ(moves.size(), 2U);
  EXPECT_EQ(moves[0].from, a.id);
  EXPECT_EQ(moves[0].to, b.id);
  EXPECT_EQ(moves[1].to, c.id);
  const auto figure = history_of(moves);
  ASSERT_TRUE(figure);
  EXPECT_EQ(figure->data.rows.size(), 96U);
  EXPECT_THAT(figure->svg, HasSubstr("2026-09-20<"));
  EXPECT_FALSE(history_of({}));
}

/// A date alone does not tell two calibrations of one day apart.
TEST(ParameterHistory, SaysTheHourWhereAllAreOfOneDay) {
  const auto figure = history_of(moves_among({mgtd::testing::sealed_calibration("2026-03-02T08:00:00Z"),
                                              mgtd::testing::sealed_calibration("2026-03-02T10:00:00Z"),
                                              mgtd::testing::sealed_calibration("2026-03-02T16:30:00Z")}));
  ASSERT_TRUE(figure);
  EXPECT_THAT(figure->svg, HasSubstr("2026-03-02 16:30"));
}

}  // namespace
}  // namespace mgtd::calib::report
