// SPDX-License-Identifier: Apache-2.0
#include "proto/slot.h"

#include <gtest/gtest.h>

#include <set>

namespace mgtd {
namespace {

TEST(Slot, TheNumbersOfOldJournalsStay) {
  for (int i = 0; i < 4; ++i) EXPECT_EQ(Slot::sensor(i).number(), i);
  EXPECT_EQ(Slot::table().number(), 4);
  EXPECT_EQ(Slot::scalar().number(), 5);
  EXPECT_EQ(Slot::auxiliary(0).number(), 6);
  EXPECT_EQ(Slot::auxiliary(2).name(), "aux3");
}

TEST(Slot, EveryInstrumentHasANumberAndANameOfItsOwn) {
  std::set<int> numbers{Slot::table().number(), Slot::scalar().number()};
  std::set<std::string> names{Slot::table().name(), Slot::scalar().name()};
  for (int i = 0; i < kMostSensors; ++i) {
    EXPECT_EQ(Slot::sensor(i).sensor_index(), i);
    EXPECT_EQ(Slot::sensor(i).name(), "s" + std::to_string(i + 1));
    EXPECT_EQ(Slot::numbered(Slot::sensor(i).number()), Slot::sensor(i));
    numbers.insert(Slot::sensor(i).number());
    names.insert(Slot::sensor(i).name());
  }
  for (int i = 0; i < Slot::kMostAuxiliary; ++i) {
    EXPECT_FALSE(Slot::auxiliary(i).sensor_index());
    numbers.insert(Slot::auxiliary(i).number());
    names.insert(Slot::auxiliary(i).name());
  }
  const std::size_t all = 2 + static_cast<std::size_t>(kMostSensors + Slot::kMostAuxiliary);
  EXPECT_EQ(numbers.size(), all);
  EXPECT_EQ(names.size(), all);
}

}  // namespace
}  // namespace mgtd
