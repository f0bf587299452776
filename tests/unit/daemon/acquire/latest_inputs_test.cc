// SPDX-License-Identifier: Apache-2.0
#include "daemon/acquire/latest_inputs.h"

#include <gtest/gtest.h>

#include <cmath>

namespace mgtd::daemon::acquire {
namespace {

Stamp at(double t_s) { return {Instant{from_seconds(t_s)}, {}}; }

TEST(LatestInputs, ShowsTheLastReadingAsLongAsItIsFresh) {
  LatestInputs inputs({"motor_A", "s2_T_degC"});
  EXPECT_TRUE(std::isnan(inputs.values()[0].value)) << "not measured yet";
  inputs.push(AuxiliaryReading{at(1), {{"motor_A", 0.5}, {"lamp_A", 3}}});
  inputs.push(TemperatureReading{1, at(1), 21.5, 30.0, 12.0});
  inputs.push(TemperatureReading{0, at(1), std::nullopt, 30.0, 12.0});
  inputs.push(AuxiliaryReading{at(2), {{"motor_A", 0.75}}});
  inputs.advance(at(3).mono);
  ASSERT_EQ(inputs.values().size(), 2U) << "columns of the configuration";
  EXPECT_EQ(inputs.values()[0].value, 0.75);
  EXPECT_EQ(inputs.values()[1].value, 21.5);
  EXPECT_EQ(inputs.covariates(), (std::map<std::string, double>{{"lamp_A", 3}, {"motor_A", 0.75}}));
  EXPECT_EQ(inputs.heard("motor_A"), at(2).mono);
  EXPECT_FALSE(inputs.heard("s1_T_degC"));

  inputs.advance(at(121.5).mono);
  EXPECT_TRUE(std::isnan(inputs.values()[1].value));
  EXPECT_EQ(inputs.covariates(), (std::map<std::string, double>{{"motor_A", 0.75}}));
  inputs.advance(at(123).mono);
  EXPECT_TRUE(std::isnan(inputs.values()[0].value));
  EXPECT_TRUE(inputs.covariates().empty());
  EXPECT_EQ(inputs.heard("motor_A"), at(2).mono) << "how long it has not been heard of";
}

}  // namespace
}  // namespace mgtd::daemon::acquire
