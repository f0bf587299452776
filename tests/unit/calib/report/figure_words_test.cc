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

}  // namespace
}  // namespace mgtd::calib::report
