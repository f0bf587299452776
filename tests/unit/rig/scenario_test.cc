// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/scenario.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/checkout.h"
#include "tests/support/child_process.h"
#include "tests/support/whole_file.h"

namespace mgtd::rig {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Scenario, EveryFileOfTheRepositoryIsOne) {
  int files = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(mgtd::testing::source_path("tests/scenarios"))) {
    const auto scenario =
        parse_scenario(mgtd::testing::whole_file(entry.path()), entry.path().filename().string());
    EXPECT_TRUE(scenario.has_value()) << (scenario ? "" : scenario.error().front());
    ++files;
  }
  EXPECT_GE(files, 8);
}

TEST(Scenario, TellsEveryMistakeWithItsLine) {
  const auto scenario = parse_scenario(
      "[site]\nrecord = 'usgs-bou-1816-01-01'\n[temperature]\nlaw = 'linear'\n[sensors]\nwiring = [1, 1, 3, "
      "4]\n[[effect]]\nname = 'platform.current'\nof = 'lamp_A'\nnT_per_A = [1, 2, 3]\n",
      "s.toml");
  ASSERT_FALSE(scenario.has_value());
  EXPECT_THAT(scenario.error(),
              ElementsAre(HasSubstr("s.toml:2: [site] record = 'usgs-bou-1816-01-01'"),
                          HasSubstr("s.toml:4: [temperature] law = 'linear'"),
                          HasSubstr("s.toml:6: [sensors] wiring must be 1 to 4"),
                          HasSubstr("s.toml:9: [effect] of = 'lamp_A': there is no [[covariate]]")));
}

TEST(Scenario, AWordForNoiseGivesWayToItsKey) {
  const auto noise = [](const std::string& keys) {
    return parse_scenario("[sensors]\n" + keys, "s.toml").value().noise;
  };
  EXPECT_EQ(noise("noise = 'walk'").walk_nT_per_sqrt_h, 1);
  EXPECT_EQ(noise("noise = 'walk'\nwalk_nT_per_sqrt_h = 0.2").walk_nT_per_sqrt_h, 0.2);
  EXPECT_EQ(noise("noise = 'ar'").ar1_rho, 0.9);
  EXPECT_EQ(noise("noise = 'flicker'").flicker_nT_per_sqrt_hz, 0.02);
  EXPECT_EQ(noise("noise = 'quantised'").mean_step_nT, 0.1);
  EXPECT_EQ(noise("noise = 'gaussian'").mean_step_nT, 0);
}

TEST(Scenario, WhatDisturbsIsReadAndStandsInTheTruth) {
  const auto scenario = parse_scenario(
      "[sensors]\ncopied = 2\nflicker_nT_per_sqrt_hz = 0.01\n[[magnet]]\nat_s = 900\nmoment_Am2 = [1, 2, "
      "3]\nat_m = [2, 0, 1]\n[[gross]]\npose = 57\nwhere = 's2.y'\ndo = 'stuck'\n[[vehicle]]\nat_s = 100\n",
      "s.toml");
  ASSERT_TRUE(scenario.has_value()) << scenario.error().front();
  const auto truth = truth_json(*scenario);
  EXPECT_EQ(truth["copied"], 2);
  EXPECT_EQ(truth["more_noise"]["flicker_nT_per_sqrt_hz"], 0.01);
  EXPECT_EQ(truth["magnets"][0]["moment_Am2"][2], 3);
  EXPECT_FALSE(truth["magnets"][0].contains("until_s"));
  EXPECT_EQ(truth["gross"][0]["where"], "s2.y");
  EXPECT_EQ(truth["vehicles"][0]["at_s"], 100);
}

TEST(Scenario, ExchangedPlugsStandInTheTruth) {
  const auto scenario = parse_scenario(
      "[sensors]\nplugs = [1, 4, 3, 2]\ntells_serial = false\n[[fault]]\nat_s = 60\ndo = 'exchange "
      "fluxgate1 fluxgate3'\n",
      "s.toml");
  ASSERT_TRUE(scenario.has_value()) << scenario.error().front();
  const auto truth = truth_json(*scenario);
  EXPECT_EQ(truth["plugs"], (std::vector<int>{1, 4, 3, 2}));
  EXPECT_EQ(truth["tells_serial"], false);
  EXPECT_EQ(truth["faults"][0]["do"], "exchange fluxgate1 fluxgate3");
}

TEST(Scenario, DisturbancesThatCannotBeAreNamed) {
  const auto scenario = parse_scenario(
      "[[magnet]]\nat_m = [0.1, 0, 0]\n[[gross]]\npose = 0\n[[gross]]\ndo = 'lost'\n[sensors]\nnoise = "
      "'pink'\ncopied = 5\n",
      "s.toml");
  ASSERT_FALSE(scenario.has_value());
  EXPECT_THAT(scenario.error(),
              ElementsAre(HasSubstr("s.toml:2: [magnet] at_m is 0.1 m"), HasSubstr("s.toml:4: [gross] poses"),
                          HasSubstr("s.toml:6: [gross] do = 'lost'"), HasSubstr("s.toml:8: [sensors] noise"),
                          HasSubstr("s.toml:9: [sensors] copied")));
}

}  // namespace
}  // namespace mgtd::rig
