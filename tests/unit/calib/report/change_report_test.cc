// SPDX-License-Identifier: Apache-2.0
#include "calib/report/change_report.h"

#include <gtest/gtest.h>

#include "proto/units.h"

namespace mgtd::calib::report {
namespace {

/// Each kind of parameter is seen worst in another sensor; three of them have numbers of two digits.
TEST(SeenText, TakesTheWorstOfAllSensorsOfALargeArray) {
  validity::Change change;
  for (const validity::ShownSlot& slot : validity::shown_slots(12, {}))
    change.parameters.push_back({.name = slot.name, .unit = slot.unit, .seen = 1e-6});
  for (validity::ParameterChange& p : change.parameters) {
    if (p.name == "s12 iy") p.seen = 7;
    if (p.name == "s10 cz") p.seen = 3e-4;
    if (p.name == "s11 psi") p.seen = 3;
    if (p.name == "s2 beta") p.seen = 4;
  }
  const std::string text = seen_text(change);
  EXPECT_NE(text.find("offset 7"), std::string::npos) << text;
  EXPECT_NE(text.find("scale factor 300 ppm"), std::string::npos) << text;
  EXPECT_NE(text.find("angle between axes 3"), std::string::npos) << text;
  EXPECT_NE(text.find("turn of a sensor 4"), std::string::npos) << text;
}

TEST(TurnText, HasNoZeroWithASign) {
  validity::CommonTurn turn;
  turn.about_rad = {-1e-9, to_rad(-0.5), 0};
  EXPECT_EQ(
      turn_text(turn),
      "turn of the whole array, which is no change of its calibration: 0.0000 ± 0.0000, -0.5000 ± 0.0000, "
      "0.0000 ± 0.0000 deg about X, Y, Z");
}

}  // namespace
}  // namespace mgtd::calib::report
