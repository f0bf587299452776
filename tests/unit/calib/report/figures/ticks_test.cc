// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/ticks.h"

#include <gmock/gmock.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace mgtd::calib::report::figures {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> labels(const Ticks& ticks) {
  std::vector<std::string> out;
  for (const Tick& t : ticks.ticks)
    if (!t.label.empty()) out.push_back(t.label);
  return out;
}

TEST(Ticks, AreHandyNumbersWithTheSameDecimals) {
  EXPECT_THAT(labels(ticks_of({-2.6, 2.6}, ScaleKind::linear, 5)), ElementsAre("−2", "−1", "0", "1", "2"));
  EXPECT_THAT(labels(ticks_of({0, 0.5}, ScaleKind::linear, 5)),
              ElementsAre("0.0", "0.1", "0.2", "0.3", "0.4", "0.5"));
  EXPECT_THAT(labels(ticks_of({17.9, 21.05}, ScaleKind::linear, 3)), ElementsAre("18", "19", "20", "21"));
}

TEST(Ticks, NumbersTooLongForAnAxisShareAPower) {
  const Ticks small = ticks_of({-2e-5, 2e-5}, ScaleKind::linear, 4);
  EXPECT_EQ(small.power, -5);
  EXPECT_THAT(labels(small), ElementsAre("−2", "−1", "0", "1", "2"));
  EXPECT_EQ(power_label(small.power), "×10⁻⁵");
  EXPECT_EQ(ticks_of({0, 53'908}, ScaleKind::linear, 4).power, 0);
}

TEST(Ticks, OfALogAxisArePowersOfTen) {
  EXPECT_THAT(labels(ticks_of({0.008, 200}, ScaleKind::log, 6)),
              ElementsAre("0.01", "0.1", "1", "10", "100"));
  EXPECT_THAT(labels(ticks_of({0.015, 0.7}, ScaleKind::log, 6)),
              ElementsAre("0.02", "0.05", "0.1", "0.2", "0.5"));
  EXPECT_THAT(labels(ticks_of({1e-12, 1e3}, ScaleKind::log, 4)), ElementsAre("10⁻¹²", "10⁻⁸", "10⁻⁴", "10⁰"));
}

TEST(Ticks, OfAnglesArePartsOfATurn) {
  EXPECT_THAT(labels(angle_ticks_of({0, 360}, 6)), ElementsAre("0", "90", "180", "270", "360"));
  EXPECT_THAT(labels(angle_ticks_of({-180, 180}, 8)),
              ElementsAre("−180", "−135", "−90", "−45", "0", "45", "90", "135", "180"));
}

RC_GTEST_PROP(Ticks, LieInTheRangeAndGrow, ()) {
  const double from = *rc::gen::inRange(-1'000'000, 1'000'000) * 1e-3,
               span = *rc::gen::inRange(1, 1'000'000) * 1e-4;
  const int about = *rc::gen::inRange(2, 12);
  const Range range{from, from + span};
  const std::vector<Tick> ticks = ticks_of(range, ScaleKind::linear, about).ticks;
  RC_ASSERT(ticks.size() >= 1U);
  RC_ASSERT(ticks.size() <= static_cast<std::size_t>(2 * about + 2));
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    RC_ASSERT(Scale(range, 0, 1).holds(ticks[i].value));
    if (i > 0) RC_ASSERT(ticks[i].value > ticks[i - 1].value);
    if (i > 0) RC_ASSERT(ticks[i].label != ticks[i - 1].label);
  }
}

TEST(ShortNumber, HasThreeDigits) {
  EXPECT_EQ(short_number(0.019), "0.0190");
  EXPECT_EQ(short_number(53'908.2), "53908");
  EXPECT_EQ(short_number(-2.5), "−2.50");
  EXPECT_EQ(short_number(2.1e-64), "2.1e-64");
  EXPECT_EQ(short_number(std::nan("")), "unknown");
  EXPECT_EQ(number_label(-0.0001, 2), "0.00");
}

}  // namespace
}  // namespace mgtd::calib::report::figures
