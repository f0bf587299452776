// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/seal.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace mgtd::rig {
namespace {

TEST(Seal, KeepsTheTruthAndTellsWhenItWasChanged) {
  std::mt19937_64 random(1);
  Scenario scenario;
  scenario.truth = *rig_named("table6", 1);
  const Scenario hidden = with_hidden(scenario, 2, random);
  EXPECT_EQ(hidden.effects.size(), 2U);
  const Seal sealed = seal(truth_json(hidden), random);
  EXPECT_EQ(sealed.content.find("effect"), std::string::npos);
  const auto opened = open_seal(sealed.content);
  ASSERT_TRUE(opened.has_value());
  EXPECT_EQ(opened->at("effects"), truth_json(hidden).at("effects"));

  std::string changed = sealed.content;
  char& digit = changed[changed.find("sealed\": \"") + 30];
  digit = digit == '6' ? '7' : '6';
  EXPECT_FALSE(open_seal(changed).has_value());
  EXPECT_FALSE(open_seal("{}").has_value());
}

TEST(Seal, TheSameTruthHasAnotherHashEachTime) {
  std::mt19937_64 random(1);
  const nlohmann::json truth{{"effects", nlohmann::json::array()}};
  EXPECT_NE(seal(truth, random).sha256, seal(truth, random).sha256);
}

}  // namespace
}  // namespace mgtd::rig
