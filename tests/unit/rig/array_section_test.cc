// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/array_section.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/rig/config_text.h"
#include "tests/rig/scenario.h"

namespace mgtd::rig {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(ArraySection, WithoutItTheArrayIsTheCross) {
  const Scenario scenario = parse_scenario("[rig]\nbaseline_m = 0.6\n", "s.toml").value();
  const auto places_m = scenario.places_m();
  ASSERT_EQ(places_m.size(), 4U);
  EXPECT_EQ(places_m[1], Eigen::Vector3d(0, 0.3, 0));
  EXPECT_EQ(places_m[2], Eigen::Vector3d(-0.3, 0, 0));
  EXPECT_FALSE(truth_json(scenario).contains("positions_m"));
  EXPECT_THAT(config_text(scenario, "/r", "/r/state", 1, "x"), HasSubstr("baseline_m = 0.6\n"));
}

TEST(ArraySection, EverySensorHasItsPlaceItsSectionAndItsDevice) {
  const Scenario scenario =
      parse_scenario(
          "[rig]\nparameters = 'ideal'\n[array]\npositions_m = [[0.1, 0, 0], [0, 0.2, 0], [0, 0, 0.3], "
          "[0, 0, 0], [-0.1, 0, 0]]\n[s5]\ncx = 1.01\n[sensors]\nwiring = [1, 2, 3, 5, 4]\n"
          "[[fault]]\nat_s = 1\ndo = 'unplug fluxgate5'\n[[covariate]]\ninput = 's5.q'\n",
          "s.toml")
          .value();
  EXPECT_EQ(scenario.places_m()[2], Eigen::Vector3d(0, 0, 0.3));
  EXPECT_EQ(scenario.truth[4].scale[0], 1.01);
  EXPECT_EQ(scenario.covariates[0].input->slot, 4);
  const auto truth = truth_json(scenario);
  EXPECT_EQ(truth["sensors"].size(), 5U);
  EXPECT_EQ(truth["positions_m"][1], (std::vector<double>{0, 0.2, 0}));
  EXPECT_EQ(truth["wiring"], (std::vector<int>{1, 2, 3, 5, 4}));
  const std::string config = config_text(scenario, "/r", "/r/state", 1, "x");
  EXPECT_THAT(config, HasSubstr("port = \"/r/fluxgate5\""));
  EXPECT_THAT(config, Not(HasSubstr("fluxgate6")));
  EXPECT_THAT(config, Not(HasSubstr("baseline_m")));
}

TEST(ArraySection, WhatCannotBeIsToldWithItsLine) {
  const auto errors = [](const std::string& text) { return parse_scenario(text, "s.toml").error(); };
  EXPECT_THAT(
      errors("[rig]\nparameters = 'table6'\n[array]\npositions_m = [[0, 0, 0]]\n"),
      ElementsAre(HasSubstr("s.toml:2: [rig] parameters = 'table6' are of four sensors, the array has 1")));
  EXPECT_THAT(
      errors("[array]\npositions_m = [[0, 0, 0]]\n"),
      ElementsAre(HasSubstr("no parameters are given, and those of the default, 'table6', are of four "
                            "sensors, the array has 1; say parameters = ideal or random")));
  EXPECT_THAT(errors("[rig]\nparameters = 'ideal'\nbaseline_m = 0.4\n[array]\npositions_m = [[0, 0, 0]]\n"),
              ElementsAre(HasSubstr("s.toml:3: [rig] baseline_m is of the cross")));
  EXPECT_THAT(errors("[array]\npositions_m = []\n"),
              ElementsAre(HasSubstr("s.toml:2: [array] positions_m has 0 places")));
  EXPECT_THAT(errors("[array]\npositions_m = [[0, 0]]\n"),
              ElementsAre(HasSubstr("s.toml:2: [array] positions_m must be a list of places")));
  EXPECT_THAT(
      errors("[rig]\nparameters = 'ideal'\n[array]\npositions_m = [[1, 0, 0], [0, 0, 0], [1, 0, 0]]\n"),
      ElementsAre(HasSubstr("s.toml:4: [array] s1 and s3 are less than 0.001 m apart")));
  std::string seventeen = "[array]\npositions_m = [";
  for (int i = 0; i < 17; ++i) seventeen += "[0.1, 0, " + std::to_string(i) + "],";
  EXPECT_THAT(errors(seventeen + "]\n"), ElementsAre(HasSubstr("has 17 places; an array has 1 to 16")));
}

/// What addresses a sensor knows how many there are.
TEST(ArraySection, ASensorThatIsNotThereIsNamed) {
  EXPECT_THAT(
      parse_scenario(
          "[rig]\nparameters = 'ideal'\n[array]\npositions_m = [[0, 0, 0], [1, 0, 0]]\n[s3]\ncx = 1\n"
          "[temperature]\nhead_degC = [1, 2, 3]\n[sensors]\ncopied = 3\n[[effect]]\nname = "
          "'axis.cubic'\nwhere = 's3.x'\nnT_at_F0 = 1\n[[fault]]\ndo = 'unplug fluxgate3'\n",
          "s.toml")
          .error(),
      ElementsAre(HasSubstr("s.toml:5: unknown section 's3'"),
                  HasSubstr("s.toml:8: [temperature] head_degC must be a list of 2 numbers"),
                  HasSubstr("s.toml:10: [sensors] copied must be 1 .. 2"),
                  HasSubstr("s.toml:13: [effect] where = 's3.x' must be all, s1 .. s2 or s1.x .. s2.z"),
                  HasSubstr("s.toml:16: [fault] no port 'fluxgate3'")));
  EXPECT_FALSE(Where::parse("s5").has_value());
  EXPECT_FALSE(Where::parse("s01", 16).has_value());
  EXPECT_FALSE(Where::parse("s17.x", 16).has_value());
  const auto last = Where::parse("s16.z", 16);
  ASSERT_TRUE(last.has_value());
  EXPECT_TRUE(last->covers({.sensor = 15, .axis = 2}));
  EXPECT_FALSE(last->covers({.sensor = 0, .axis = 2}));
}

}  // namespace
}  // namespace mgtd::rig
