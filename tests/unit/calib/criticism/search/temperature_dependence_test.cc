// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/temperature_dependence.h"

#include <gtest/gtest.h>

namespace mgtd::calib::criticism::search {
namespace {

Round round_of(const char* effect, double d) {
  Round out;
  out.added.effect = effect;
  out.added.d = d;
  return out;
}

TEST(TemperatureDependence, BothTermsAreOne) {
  EXPECT_EQ(temperature_dependence("axis.gain.temperature"), "axis.gain.temperature");
  EXPECT_EQ(temperature_dependence("axis.gain.temperature2"), "axis.gain.temperature");
  EXPECT_EQ(temperature_dependence("axis.gain.drift"), std::nullopt);
}

TEST(TemperatureDependence, IsFoundByEitherTermOfTheSizeThatIsAskedFor) {
  const std::vector<Round> rounds{round_of("axis.gain.temperature", 9), round_of("axis.gain.drift", 20)};
  EXPECT_TRUE(added_term_of_dependence(rounds, "axis.gain.temperature2"));
  EXPECT_TRUE(added_term_of_dependence(rounds, "axis.gain.temperature2", 8));
  EXPECT_FALSE(added_term_of_dependence(rounds, "axis.gain.temperature2", 10));
  EXPECT_FALSE(added_term_of_dependence(rounds, "axis.offset.temperature"));
  EXPECT_FALSE(added_term_of_dependence(rounds, "axis.gain.drift")) << "is no dependence on temperature";
}

}  // namespace
}  // namespace mgtd::calib::criticism::search
