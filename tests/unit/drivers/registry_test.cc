// SPDX-License-Identifier: Apache-2.0
#include "drivers/registry.h"

#include <gtest/gtest.h>

#include <set>

namespace mgtd::drivers {
namespace {

TEST(Registry, EveryDriverIsFoundByItsOwnName) {
  std::set<std::string_view> names;
  for (const DriverEntry& entry : drivers()) {
    EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
    EXPECT_EQ(find_driver(entry.name), &entry);
    EXPECT_FALSE(entry.summary.empty());
  }
  EXPECT_EQ(find_driver("bartington"), nullptr) << "the sensor is analogue: what speaks is the digitiser";
}

TEST(Registry, ADeviceIsMadeEvenFromWrongSettings) {
  for (const DriverEntry& entry : drivers()) {
    Settings settings("section", 1);
    settings.set("baud", std::string("fast"), 2);
    const auto device = entry.make(0, settings);
    ASSERT_NE(device, nullptr);
    const bool wired = entry.name != "hand";  // a table without a port has no line speed to be wrong
    EXPECT_EQ(device->baud() > 0, wired) << entry.name;
    EXPECT_EQ(!settings.errors().empty(), wired) << entry.name;
    EXPECT_EQ(dynamic_cast<Turntable*>(device.get()) != nullptr, entry.role == Role::table);
  }
}

}  // namespace
}  // namespace mgtd::drivers
