// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/known_field_section.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace mgtd::rig {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::vector<std::string> errors(const std::string& text) { return parse_scenario(text, "s.toml").error(); }

TEST(KnownFieldSection, AnglesAndTotalFieldGoWithTheKind) {
  const auto read = [](const std::string& text) { return parse_scenario(text, "s.toml").value(); };
  const auto told = [&](const std::string& text) {
    const Scenario s = read(text);
    return std::pair(s.angles, s.scalar);
  };
  EXPECT_EQ(told(""), std::pair(true, true));
  EXPECT_EQ(told("[reference]\nvector = true\n"), std::pair(false, true));
  EXPECT_EQ(told("[reference]\nvector = true\nframe = 'site'\nscalar = false\n"), std::pair(true, false));
  EXPECT_EQ(told("[reference]\nvector = true\n[cage]\n"), std::pair(false, false));
  EXPECT_EQ(told("[reference]\nvector = true\nscalar = true\n[cage]\n"), std::pair(false, true));
  EXPECT_EQ(told("[recording]\n"), std::pair(false, true));
  EXPECT_EQ(told("[recording]\nangles = true\nscalar = false\n"), std::pair(true, false));
  const Scenario recording = read("[recording]\nmotion = 'one-axis'\nrate_hz = 25\nar = 0.5\n");
  EXPECT_EQ(recording.recording->motion, MotionKind::one_axis);
  EXPECT_EQ(recording.rate_hz, 25);
  EXPECT_EQ(recording.noise.ar1_rho, 0.5);
  EXPECT_EQ(truth_json(recording)["recording"]["motion"], "one-axis");
}

TEST(KnownFieldSection, WhatCannotBeIsToldWithItsLine) {
  EXPECT_THAT(errors("[cage]\nfields = 'cube'\n"),
              ElementsAre(HasSubstr("s.toml:1: [cage] the fields of a cage are known by the reference"),
                          HasSubstr("s.toml:2: [cage] fields = 'cube' must be sphere or random")));
  EXPECT_THAT(errors("[reference]\nvector = true\nframe = 'moon'\nmisalignment_deg = [1, 2]\n"),
              ElementsAre(HasSubstr("s.toml:3: [reference] frame = 'moon' must be platform or site"),
                          HasSubstr("s.toml:4: [reference] misalignment_deg must be a list of 3 numbers")));
  EXPECT_THAT(errors("[reference]\nvector = true\nframe = 'site'\nangles = false\n"),
              ElementsAre(HasSubstr("s.toml:4: [reference] a reference in the site frame says nothing")));
  EXPECT_THAT(errors("[reference]\nvector = true\nat_m = [1, 0, 0]\n"),
              ElementsAre(HasSubstr("s.toml:3: [reference] only a reference beside the table has a place")));
  EXPECT_THAT(errors("[reference]\nvector = true\nframe = 'site'\n[cage]\n"),
              ElementsAre(HasSubstr("s.toml:3: [reference] a cage stands round the array")));
  EXPECT_THAT(errors("[reference]\nvector = true\n[cage]\n[recording]\nmotion = 'swim'\nduration_s = 12\n"),
              ElementsAre(HasSubstr("s.toml:4: [recording] a recording is of an array in motion"),
                          HasSubstr("s.toml:5: [recording] motion = 'swim'; there are: hand"),
                          HasSubstr("s.toml:6: [recording] duration_s = 12 leaves less than 5 s of motion")));
}

}  // namespace
}  // namespace mgtd::rig
