// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figure_words.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace mgtd::calib::report {
namespace {

TEST(FigureWords, AreThoseOfTheFigureWithoutItsPicture) {
  const figures::Figure figure{.name = "qq",
                               .title = "Are they normal?",
                               .svg = "<svg/>",
                               .caption = "All residuals.",
                               .good = "in the band. Here 3 of 4 are.",
                               .stands_out = true};
  const nlohmann::json words = words_json(figure);
  EXPECT_EQ(words, nlohmann::json({{"name", "qq"},
                                   {"title", "Are they normal?"},
                                   {"caption", "All residuals."},
                                   {"good", "in the band. Here 3 of 4 are."},
                                   {"stands_out", true}}));
}

TEST(FigureWords, AreFollowedByThePictureAndItsDataWhereTheWholeIsAskedFor) {
  const figures::Figure figure{.name = "skies",
                               .svg = "<svg/>",
                               .data = {.head = {"sensor", "pose", "residual, nT"},
                                        .rows = {{"s1", "7", "\u22120.25"}, {"s2", "8", "unknown"}},
                                        .note = "One row a pose."}};
  const nlohmann::json whole = figures_json({figure}).at("skies");
  EXPECT_EQ(whole.at("svg"), "<svg/>");
  EXPECT_EQ(whole.at("points"), nlohmann::json({{"head", {"sensor", "pose", "residual, nT"}},
                                                {"rows", {{"s1", 7, -0.25}, {"s2", 8, "unknown"}}},
                                                {"note", "One row a pose."}}));
  EXPECT_EQ(words_by_name({figure}).at("skies"), words_json(figure));
}

}  // namespace
}  // namespace mgtd::calib::report
