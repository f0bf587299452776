// SPDX-License-Identifier: Apache-2.0
#include "proto/journal_note.h"

#include <gtest/gtest.h>

namespace mgtd {
namespace {

template <class Note>
Note through(const Note& note) {
  const auto back = parse_note(encode(JournalNote{note}));
  EXPECT_TRUE(back);
  return std::get<Note>(*back);
}

TEST(JournalNote, ALifeKeepsItsConfigurationAndWhatWasBefore) {
  const LifeNote life{"mgtd 1", "[rig]\nname = \"Größe\"\n", 600,
                      Gap{100, 599, {}, "the daemon was stopped"}};
  const LifeNote back = through(life);
  EXPECT_EQ(back.config, life.config);
  EXPECT_EQ(back.first_seq, 600U);
  ASSERT_TRUE(back.before);
  EXPECT_EQ(back.before->to_seq, 599U);
  EXPECT_EQ(back.before->why, life.before->why);
  EXPECT_FALSE(through(LifeNote{"mgtd 1", "", 0, {}}).before);
}

TEST(JournalNote, AnglesAndTimesLoseNothing) {
  TableNote note;
  note.reading.arrival = {Instant{Duration{123'456'789'012'345'678}}, WallTime{1'795'255'200'123'456'789}};
  note.reading.angles = {0.1 + 0.2, -1.0 / 3, 1e-300};
  note.reading.moving = true;
  const TableReading back = through(note).reading;
  EXPECT_EQ(back.angles, note.reading.angles);
  EXPECT_EQ(back.arrival.mono, note.reading.arrival.mono);
  EXPECT_EQ(back.arrival.wall, note.reading.arrival.wall);
  EXPECT_TRUE(back.moving);
  const TableOrder order = through(TableOrder{TableOrder::What::move, {0.1 + 0.2, 2, 3}});
  EXPECT_EQ(order.what, TableOrder::What::move);
  EXPECT_EQ(order.target.azimuth_rad, 0.1 + 0.2);
}

TEST(JournalNote, TheOthersComeBack) {
  EXPECT_EQ(through(CalibrationNote{R"({"id":"c1"})"}).json, R"({"id":"c1"})");
  EXPECT_EQ(through(CalibrationNote{}).json, "");
  EXPECT_TRUE(through(CalibratingNote{true}).on);
  EXPECT_EQ(through(ReopenedNote{3}).slot, 3);
  EXPECT_EQ(through(LostNote{77}).bytes, 77U);
}

TEST(JournalNote, WhatIsNotKnownIsRefused) {
  for (const char* text : {"", "{}", "[]", R"({"note":"weather"})", R"({"note":"reopened"})",
                           R"({"note":"order","what":"move","target_rad":[1]})"}) {
    EXPECT_FALSE(parse_note(text)) << text;
  }
}

}  // namespace
}  // namespace mgtd
