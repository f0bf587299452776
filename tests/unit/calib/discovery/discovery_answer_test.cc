// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tests/discovery/answer.h"

namespace mgtd::calib::testing {
namespace {

Answer some_answer() {
  return {.finding = discovery::LawFinding::law_set,
          .log10_p = -12.1,  // has no finite binary expansion
          .P = 0.7,
          .found = true,
          .place = false,
          .covariate = true,
          .first = false,
          .alike = true,
          .in_set = false,
          .set = 3,
          .gain = 0.9,
          .formula = "u^3",
          .reason = "two formulas",
          .effects = {"user.law: k*u^3", "user.other"}};
}

/// Each member, so that one that is neither written nor read shows.
TEST(DiscoveryAnswer, ComesBackFromItsJsonAsItWas) {
  const Answer back = nlohmann::json::parse(nlohmann::json(some_answer()).dump()).get<Answer>();
  const Answer a = some_answer();
  EXPECT_EQ(back.finding, a.finding);
  EXPECT_EQ(back.log10_p, a.log10_p);
  EXPECT_EQ(back.P, a.P);
  EXPECT_EQ(back.found, a.found);
  EXPECT_EQ(back.place, a.place);
  EXPECT_EQ(back.covariate, a.covariate);
  EXPECT_EQ(back.first, a.first);
  EXPECT_EQ(back.alike, a.alike);
  EXPECT_EQ(back.in_set, a.in_set);
  EXPECT_EQ(back.set, a.set);
  EXPECT_EQ(back.gain, a.gain);
  EXPECT_EQ(back.formula, a.formula);
  EXPECT_EQ(back.reason, a.reason);
  EXPECT_EQ(back.effects, a.effects);
}

TEST(DiscoveryAnswer, WithoutAGainHasNone) {
  Answer none = some_answer();
  none.gain.reset();
  Answer back = some_answer();
  nlohmann::json(none).get_to(back);
  EXPECT_EQ(back.gain, std::nullopt);
}

TEST(DiscoveryAnswer, OfAnUnknownVerdictIsRefused) {
  nlohmann::json j = some_answer();
  j["verdict"] = "MAYBE";
  EXPECT_THROW(static_cast<void>(j.get<Answer>()), std::runtime_error);
}

}  // namespace
}  // namespace mgtd::calib::testing
