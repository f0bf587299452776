// SPDX-License-Identifier: Apache-2.0
// Every figure, with few poses, with many and with none. The drawings themselves stand in golden/: what
// changes there has to be looked at. MGTD_NEW_GOLDEN=1 writes them anew.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <regex>

#include "calib/report/figures/text_width.h"
#include "tests/support/checkout.h"
#include "tests/support/whole_file.h"
#include "tests/unit/calib/report/figures/examples.h"

namespace mgtd::calib::report::figures {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

double number(const std::string& tag, const std::string& name) {
  const std::size_t at = tag.find(" " + name + "=\"");
  return at == std::string::npos ? 0 : std::stod(tag.substr(at + name.size() + 3));
}

/// Elements in order: what stands between "<" and ">", and the text behind it.
struct Element {
  std::string tag, text;
};
std::vector<Element> elements(const std::string& xml) {
  std::vector<Element> out;
  for (std::size_t at = xml.find('<'); at != std::string::npos;) {
    const std::size_t end = xml.find('>', at), next = xml.find('<', at + 1);
    if (end == std::string::npos || next < end) {
      ADD_FAILURE() << "a tag does not end: " << xml.substr(at, 80);
      return out;
    }
    out.push_back({xml.substr(at + 1, end - at - 1),
                   xml.substr(end + 1, next == std::string::npos ? next : next - end - 1)});
    at = next;
  }
  return out;
}

/// Names of elements open and close in pairs.
void expect_balanced(const std::string& xml) {
  std::vector<std::string> open;
  for (const Element& e : elements(xml)) {
    if (e.tag.ends_with('/')) continue;
    const std::string name = e.tag.substr(0, e.tag.find(' '));
    if (!name.starts_with('/')) {
      open.push_back(name);
      continue;
    }
    ASSERT_FALSE(open.empty());
    ASSERT_EQ("/" + open.back(), name);
    open.pop_back();
  }
  EXPECT_TRUE(open.empty());
}

/// Texts that are written from left to right lie in the picture.
void expect_texts_inside(const Figure& f) {
  const std::vector<Element> all = elements(f.svg);
  const std::string& head = all.front().tag;
  std::istringstream box(head.substr(head.find("viewBox=\"") + 9));
  double zero = 0, width = 0, height = 0;
  box >> zero >> zero >> width >> height;
  ASSERT_GT(height, 0);
  for (const Element& e : all) {
    if (!e.tag.starts_with("text ") || e.tag.find("transform") != std::string::npos) continue;
    const double size = e.tag.find("font-size") == std::string::npos ? 11 : number(e.tag, "font-size");
    const double wide = text_width(e.text, size), x = number(e.tag, "x"), y = number(e.tag, "y");
    const double left = e.tag.find("\"end\"") != std::string::npos      ? x - wide
                        : e.tag.find("\"middle\"") != std::string::npos ? x - wide / 2
                                                                        : x;
    EXPECT_GE(left, -1) << f.name << ": " << e.text;
    EXPECT_LE(left + wide, width + 1) << f.name << ": " << e.text;
    EXPECT_GE(y, 5) << f.name << ": " << e.text;
    EXPECT_LE(y, height) << f.name << ": " << e.text;
  }
}

class Figures : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Figures, AreWholeAndSayWhatTheyShow) {
  for (const Figure& f : testing::examples(GetParam())) {
    SCOPED_TRACE(f.name);
    expect_balanced(f.svg);
    expect_texts_inside(f);
    EXPECT_THAT(f.svg, Not(HasSubstr("nan")));
    EXPECT_THAT(f.svg, Not(HasSubstr("inf\"")));
    EXPECT_THAT(f.svg, Not(HasSubstr("style=")));
    EXPECT_THAT(f.svg, Not(HasSubstr("href")));
    EXPECT_THAT(f.svg, HasSubstr("role=\"img\""));
    EXPECT_THAT(f.svg, HasSubstr("<desc"));
    EXPECT_FALSE(f.title.empty());
    EXPECT_FALSE(f.caption.empty());
    EXPECT_THAT(f.good, HasSubstr("Here "));
    EXPECT_THAT(f.good, ::testing::ContainsRegex("[0-9]")) << "a number of this run";
    EXPECT_LT(f.svg.size(), 300'000U);
    for (const auto& row : f.data.rows) EXPECT_EQ(row.size(), f.data.head.size());
    const std::string page = figure_html(f);
    expect_balanced(page);
    EXPECT_THAT(page, HasSubstr("<figcaption>"));
    EXPECT_LT(page.size(), 420'000U);
  }
}
INSTANTIATE_TEST_SUITE_P(Poses, Figures, ::testing::Values(1, 2, 24, 157, 6000));

TEST(Figures, AreThoseThatWereLookedAt) {
  const std::filesystem::path folder = mgtd::testing::source_path("tests/unit/calib/report/figures/golden");
  const bool anew = std::getenv("MGTD_NEW_GOLDEN") != nullptr;
  for (const Figure& f : testing::examples(24)) {
    const std::filesystem::path path = folder / (f.name + ".svg");
    if (anew) std::ofstream(path, std::ios::binary) << f.svg << '\n';
    EXPECT_TRUE(f.svg + "\n" == mgtd::testing::whole_file(path))
        << f.name << " is drawn otherwise: look at it, then MGTD_NEW_GOLDEN=1";
  }
}

TEST(Figures, ManyPointsAreDensity) {
  const Figure few = residual_figure(testing::residual_example(157)),
               many = residual_figure(testing::residual_example(6000));
  EXPECT_THAT(few.svg, HasSubstr("<circle data-p=\"157\""));
  EXPECT_THAT(many.svg, Not(HasSubstr("<circle")));
  EXPECT_THAT(many.svg, HasSubstr("class=\"density"));
  EXPECT_THAT(many.data.note, HasSubstr("means"));
}

TEST(Figures, APlantedNanIsNotDrawn) {
  ResidualValues values = testing::residual_example(24);
  values.before.series[0].y[5] = std::nan("");
  values.before.series[0].x[6] = std::numeric_limits<double>::infinity();
  const Figure f = residual_figure(values);
  EXPECT_THAT(f.svg, Not(HasSubstr("nan")));
  const auto drawn = [&](const std::string& pose) {
    std::size_t out = 0;
    const std::string mark = "data-p=\"" + pose + "\"";
    for (std::size_t at = f.svg.find(mark); at != std::string::npos; at = f.svg.find(mark, at + 1)) ++out;
    return out;
  };
  EXPECT_EQ(drawn("5"), 2U);
  EXPECT_EQ(drawn("6"), 1U);  // on the right only
  EXPECT_EQ(drawn("7"), 1U);
}

TEST(Figures, BeforeAndAfterHaveEqualAxes) {
  // One value that is the same on both sides stands at the same height.
  ResidualValues values = testing::residual_example(24);
  values.before.series[0].y[20] = values.after.series[0].y[20] = 1.25;
  const std::string svg = residual_figure(values).svg;
  const std::regex mark("data-p=\"21\" cx=\"([0-9.]+)\" cy=\"([0-9.]+)\"");
  std::vector<std::string> heights;
  for (std::sregex_iterator it(svg.begin(), svg.end(), mark), end; it != end; ++it)
    heights.push_back((*it)[2]);
  ASSERT_EQ(heights.size(), 2U);
  EXPECT_EQ(heights[0], heights[1]);
}

TEST(Figures, NamesOfTheDataAreNoMarkup) {
  ResidualValues values = testing::residual_example(3);
  values.x_label = "<script>alert(1)</script>";
  values.before.series[0].name = "\"><img onerror=x>";
  const std::string page = figure_html(residual_figure(values));
  EXPECT_THAT(page, Not(HasSubstr("<script")));
  EXPECT_THAT(page, Not(HasSubstr("<img")));
}

TEST(Figures, TheWaterfallEndsAtTheNoise) {
  const Figure f = waterfall_figure(testing::waterfall_example());
  EXPECT_THAT(f.good, HasSubstr("ends at 0.0190 nT with a noise of 0.0190 nT"));
  EXPECT_THAT(f.good, HasSubstr("0.0205 nT on poses"));
  EXPECT_EQ(f.data.rows.size(), 5U);
}

TEST(Figures, TheWaterfallNamesAFormulaThatIsTooLongForItsRowByItsShortName) {
  WaterfallValues values = testing::waterfall_example();
  const std::string formula = "user.drying(axis; a*exp(-3600*t_h/382.328) + b*sind(3*azimuth_deg))";
  values.short_names = values.effects;
  values.effects[0] = formula;
  values.short_names[0] = "user.drying";
  const Figure f = waterfall_figure(values);
  EXPECT_THAT(f.svg, HasSubstr(">user.drying<"));
  EXPECT_THAT(f.svg, Not(HasSubstr("exp(-3600")));
  EXPECT_EQ(f.data.rows[1].front(), formula) << "the table has room for it";
}

TEST(Figures, TheWaterfallOfAnArrayWithoutAGradientIsOfTheReadingsAlone) {
  WaterfallValues values = testing::waterfall_example();
  values.tensor.reset();
  const Figure f = waterfall_figure(values);
  EXPECT_THAT(f.svg, Not(HasSubstr("tensor")));
  EXPECT_EQ(f.data.head.size(), 3U);
  for (const auto& row : f.data.rows) EXPECT_EQ(row.size(), 3U);
}

TEST(Figures, EffectsThatLookAlikeStandTogether) {
  const ConfusionValues v = testing::confusion_example();
  const std::vector<std::size_t> order = order_by_likeness(v.correlation);
  const auto place = [&](std::size_t i) { return std::find(order.begin(), order.end(), i) - order.begin(); };
  EXPECT_EQ(std::abs(place(0) - place(2)), 1);
  EXPECT_EQ(std::abs(place(3) - place(4)), 1);
  EXPECT_THAT(confusion_figure(v).good, HasSubstr("2 of 10 pairs"));
}

TEST(Figures, TheLargestShiftOfAYearIsNamed) {
  const Figure f = history_figure(testing::history_example());
  EXPECT_THAT(f.good, HasSubstr("+9.0 of s2.gamma on 2026-05-11"));
  EXPECT_TRUE(f.stands_out);
}

}  // namespace
}  // namespace mgtd::calib::report::figures
