// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/table_track.h"

#include <gtest/gtest.h>

#include "proto/units.h"

namespace mgtd::daemon::run {
namespace {

TableReading reading(double t_s, double azimuth_deg, bool moving) {
  return {Stamp{Instant{from_seconds(t_s)}, WallTime{}}, {to_rad(azimuth_deg), 0, 0}, true, moving, !moving};
}
Instant at(double t_s) { return Instant{from_seconds(t_s)}; }

TEST(TableTrack, ARestBeginsWhenItStopsAndNotWhenItIsToldToStayThere) {
  TableTrack table;
  table.add(reading(1, 10, true), std::nullopt);
  EXPECT_EQ(table.rests_since(), std::nullopt);
  table.add(reading(2, 20, false), std::nullopt);
  table.add(reading(3, 20.001, false), std::nullopt);
  EXPECT_EQ(table.rests_since(), at(2));
  table.add(reading(4, 30, false), std::nullopt);  // moved between two reports
  EXPECT_EQ(table.rests_since(), at(4));
  table.lost();
  EXPECT_EQ(table.rests_since(), std::nullopt);
}

TEST(TableTrack, ThePathHoldsWhatChanges) {
  TableTrack table;
  const TableAngles tilted{0, to_rad(90), 0};
  table.add(reading(1, 10, true), tilted);
  table.add(reading(2, 10, true), tilted);
  table.add(reading(3, 10, false), tilted);
  table.add(reading(4, 11, false), std::nullopt);  // the attitude is not known
  const auto path = table.take_path();
  ASSERT_EQ(path.size(), 2U);
  EXPECT_EQ(path[0].arrival.mono, at(1));
  EXPECT_EQ(path[1].arrival.mono, at(3));
  EXPECT_EQ(path[1].angles.pitch_rad, to_rad(90));
  EXPECT_TRUE(table.take_path().empty());
}

TEST(TableTrack, AReferenceIsGoneWithTheReportOrTheCable) {
  TableTrack table;
  table.set_referenced(true);
  table.add(reading(1, 0, false), std::nullopt);
  EXPECT_TRUE(table.referenced());
  TableReading without = reading(2, 0, false);
  without.referenced = false;
  table.add(without, std::nullopt);
  EXPECT_FALSE(table.referenced());
  table.set_referenced(true);
  table.lost();
  EXPECT_FALSE(table.referenced());
  EXPECT_FALSE(table.reported_after(at(0)));
}

}  // namespace
}  // namespace mgtd::daemon::run
