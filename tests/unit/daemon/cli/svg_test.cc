// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/svg.h"

#include <gmock/gmock.h>

#include "daemon/cli/html.h"

namespace mgtd::daemon::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(Svg, NamesOfColumnsCannotBecomeMarkup) {
  EXPECT_EQ(escaped("a<b>&\"c\""), "a&lt;b&gt;&amp;&quot;c&quot;");
  const std::string plot =
      svg_series({.y = {1, -1}, .from = 0, .to = 1, .x_label = "<script>", .unit = "nT", .scale = 1});
  EXPECT_THAT(plot, Not(HasSubstr("<script>")));
  EXPECT_THAT(html_table({"x"}, {{"<img>"}}, true), Not(HasSubstr("<img>")));
}

TEST(Svg, APointStandsWhereItsValueIs) {
  const std::string plot =
      svg_series({.y = {1, 0, -1}, .from = 0, .to = 3, .x_label = "t_h", .unit = "nT", .scale = 1});
  EXPECT_THAT(plot, HasSubstr("cy=\"16.0\""));  // top
  EXPECT_THAT(plot, HasSubstr("cy=\"45.0\""));  // the line of zero
  EXPECT_THAT(plot, HasSubstr("cy=\"74.0\""));  // bottom
}

TEST(Svg, NothingToShowIsNoDivisionByZero) {
  EXPECT_THAT(svg_series({.y = {0, 0}, .from = 0, .to = 0, .x_label = "", .unit = "", .scale = 0}),
              Not(HasSubstr("nan")));
  EXPECT_THAT(svg_bars({{"a", 0, "0", 0}}, std::nullopt, ""), Not(HasSubstr("nan")));
}

TEST(Svg, BarsShareOneScaleWithTheirMark) {
  const std::string bars = svg_bars({{"a", 2, "2 nT", 0}, {"b", 1, "1 nT", 1}}, 4, "limit");
  EXPECT_THAT(bars, HasSubstr("width=\"210.0\""));
  EXPECT_THAT(bars, HasSubstr("width=\"105.0\""));
  EXPECT_THAT(bars, HasSubstr("x1=\"750.0\""));
}

}  // namespace
}  // namespace mgtd::daemon::cli
