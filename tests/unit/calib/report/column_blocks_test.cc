// SPDX-License-Identifier: Apache-2.0
#include "calib/report/column_blocks.h"

#include <gtest/gtest.h>

#include "calib/report/seen_width.h"

namespace mgtd::calib::report {
namespace {

const std::vector<NamedRow> kRows{{"", {"s1", "s2", "s3"}}, {"alpha", {"1", "2", "3"}}};

TEST(ColumnBlocks, WithRoomAllColumnsStandBesideEachOther) {
  EXPECT_EQ(column_blocks(kRows, 6, 4, kAnyWidth), "        s1  s2  s3\nalpha    1   2   3\n");
}

TEST(ColumnBlocks, WhatDoesNotFitStandsBelowWithTheNamesOfTheRows) {
  EXPECT_EQ(column_blocks(kRows, 6, 4, 14), "        s1  s2\nalpha    1   2\n\n        s3\nalpha    3\n");
}

TEST(ColumnBlocks, OneColumnStandsEvenWhereItDoesNotFit) {
  EXPECT_EQ(column_blocks({{"x", {"1", "2"}}}, 6, 4, 3), "x        1\n\nx        2\n");
}

TEST(ColumnBlocks, EachColumnIsAsWideAsTheWidestThatStandsInIt) {
  const std::vector<NamedRow> rows{{"", {"by", "smallest"}}, {"s1 ± 0", {"12 ppm", "3"}}};
  EXPECT_EQ(column_blocks(rows, kAnyWidth), "            by  smallest\ns1 ± 0  12 ppm         3\n");
  EXPECT_EQ(column_blocks(rows, 23),
            "            by\ns1 ± 0  12 ppm\n\n        smallest\ns1 ± 0         3\n");
}

}  // namespace
}  // namespace mgtd::calib::report
