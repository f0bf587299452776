// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/discover.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "calib/linear/parts.h"
#include "calib/report/discovery_report.h"
#include "tests/rig/effect_list.h"
#include "tests/rig/scenario.h"
#include "tests/rig/simulated_table.h"
#include "tests/support/one_processor.h"
#include "tests/unit/calib/discovery/discovery_scene.h"

namespace mgtd::calib::discovery {
namespace {

using calib::testing::Hidden;
using ::testing::HasSubstr;
using testing::must;

DiscoveryReport found_in(const Hidden& hidden, std::uint64_t seed, bool checks = false, int looks = 1) {
  const PoseTable table = testing::run_with({.noise_nT = 0.05, .hidden = hidden}, seed);
  return testing::must(discover(table, {.fit = {}, .draws = 300, .looks = looks, .checks = checks}));
}

using Rule = LawFindingReason::Rule;

/// Added to one channel.
Hidden on(int channel, const std::function<double(const Pose&)>& law) {
  return [channel, law](const Pose& p, int i, int a, const Eigen::Vector3d&) {
    return 3 * i + a == channel ? law(p) : 0.0;
  };
}

TEST(Discover, NoiseHasNoLaw) {
  for (const std::uint64_t seed : {4U, 5U, 6U}) {
    const DiscoveryReport r = found_in({}, seed);
    EXPECT_EQ(r.finding, LawFinding::pass) << report::to_text(r, "run.csv");
    EXPECT_EQ(r.reason.rule, Rule::nothing_found);
    EXPECT_EQ(r.reason.measured, r.laws.front().log10_p);
    EXPECT_GT(r.hypotheses, 15'000U);
  }
}

TEST(Discover, SaysTheSameOnOneProcessorToTheLastDigit) {
  if (linear::threads() < 2) GTEST_SKIP() << "one processor";
  const Hidden law = on(8, [](const Pose& p) { return 2 * std::sin(3 * *p.azimuth_rad); });
  const std::string here = report::to_json(found_in(law, 7, true), "run.csv").dump();
  const test::OneProcessor one;
  EXPECT_EQ(report::to_json(found_in(law, 7, true), "run.csv").dump(), here);
}

/// Draws are scored in single precision: the unit of a column must not matter.
TEST(Discover, AsksAsManyQuestionsWhateverTheUnitOfAColumn) {
  PoseTable table = testing::run_with({.noise_nT = 0.05}, 4);
  std::vector<double> questions;
  for (const double size : {1.0, 1e9, 1e-9}) {
    for (Pose& pose : table.poses) pose.covariates["lamp"] = size * (1 + std::sin(*pose.t_s / 500));
    questions.push_back(must(discover(table, {.fit = {}, .draws = 100, .checks = false})).questions);
  }
  EXPECT_NEAR(questions[1], questions[0], 1e-3 * questions[0]);
  EXPECT_NEAR(questions[2], questions[0], 1e-3 * questions[0]);
}

TEST(Discover, NamesAHarmonicOfTheAzimuth) {
  const DiscoveryReport r =
      found_in(on(5, [](const Pose& p) { return 0.12 * std::sin(3 * *p.azimuth_rad + 0.6); }), 4, true);
  ASSERT_EQ(r.finding, LawFinding::law) << report::to_text(r, "run.csv");
  const FoundLaw& law = r.laws.front();
  EXPECT_EQ(law.formulas.front().formula, "a*sind(3*azimuth_deg) + b*cosd(3*azimuth_deg)");
  EXPECT_EQ(law.formulas.front().where, "s2.z");
  ASSERT_EQ(law.formulas.front().coefficients.size(), 2U);
  const auto& c = law.formulas.front().coefficients;
  EXPECT_NEAR(std::hypot(c[0].value, c[1].value), 0.12, 4 * c[0].sd);
  EXPECT_GT(law.formulas.front().P, 0.99) << "an offset beside the law says nothing against it";
  EXPECT_EQ(r.reason.rule, Rule::none);
  ASSERT_TRUE(law.halves_ratio && law.held_out_fall && r.after);
  EXPECT_NEAR(*law.halves_ratio, 1, 0.4);
  EXPECT_GT(*law.held_out_fall, 50);
  EXPECT_LT(*r.after->unseen_after_nT, *r.after->unseen_before_nT);
}

/// The table's angles are good to a tenth of a degree: a law of 5 nT scatters by them as much as the readings
/// do, and that is nothing that the law leaves open.
TEST(Discover, ALargeLawOfAnglesMayScatterAsTheyDo) {
  for (const std::uint64_t seed : {4U, 5U}) {
    std::mt19937_64 rng(seed);
    std::normal_distribution<double> by_rad(0, to_rad(0.1));
    const DiscoveryReport r = found_in(
        on(5, [&](const Pose& p) { return 8 * std::sin(3 * (*p.azimuth_rad + by_rad(rng)) + 0.6); }), seed);
    EXPECT_EQ(r.finding, LawFinding::law) << report::to_text(r, "run.csv");
  }
}

/// What comes once in a run is any curve: no period was seen twice.
TEST(Discover, AnOscillationNeedsTwoPeriods) {
  for (const double period_s : {2800.0, 900.0}) {
    const DiscoveryReport r = found_in(
        on(4, [&](const Pose& p) { return 0.5 * std::sin(2 * std::numbers::pi * *p.t_s / period_s + 0.4); }),
        4);
    EXPECT_THAT(r.laws.front().formulas.front().formula, HasSubstr("sin(2*pi*t_h/"));
    if (period_s > 1000) {
      EXPECT_EQ(r.reason.rule, Rule::few_periods) << report::to_text(r, "run.csv");
      EXPECT_EQ(r.finding, LawFinding::shape_only);
      EXPECT_NEAR(r.reason.measured, 4680 / period_s, 0.05);
      EXPECT_THAT(report::to_json(r, "run.csv").at("reason").at("text").get<std::string>(),
                  HasSubstr("a law needs 2"));
    } else {
      EXPECT_EQ(r.finding, LawFinding::law) << report::to_text(r, "run.csv");
    }
  }
}

/// Its centre is not that of the run's temperatures.
TEST(Discover, NamesACubeWhereverItsCentreIs) {
  const DiscoveryReport r =
      found_in(on(8, [](const Pose& p) { return 0.02 * std::pow(*p.T_degC[2] - 22.5, 3); }), 4);
  EXPECT_THAT(r.laws.front().formulas.front().formula, ::testing::MatchesRegex("\\(T-22\\.[0-9]*\\)\\^3"))
      << report::to_text(r, "run.csv");
}

/// A law of each sensor's own temperature, on all axes: the role is found, not one of four columns.
TEST(Discover, FindsTheRoleOfATemperature) {
  const DiscoveryReport r = found_in(
      [](const Pose& p, int i, int a, const Eigen::Vector3d&) {
        return (0.1 + 0.03 * (3 * i + a)) * std::pow(*p.T_degC[static_cast<std::size_t>(i)] - 21, 3) / 9;
      },
      5);
  ASSERT_FALSE(r.laws.empty());
  const FoundLaw& law = r.laws.front();
  EXPECT_EQ(law.formulas.front().where, "each-axis") << report::to_text(r, "run.csv");
  EXPECT_EQ(law.covariates.front().name, "T_degC") << report::to_text(r, "run.csv");
}

TEST(Discover, NamesTwoLawsOnOneAxis) {
  const DiscoveryReport r =
      found_in(on(1,
                  [](const Pose& p) {
                    return 0.15 * std::sin(3 * *p.azimuth_rad) + 0.5 * (testing::motor_A(p) - 0.5);
                  }),
               6);
  ASSERT_EQ(r.laws.size(), 2U) << report::to_text(r, "run.csv");
  std::map<std::string, int> covariates;
  for (const FoundLaw& law : r.laws) ++covariates[law.covariates.front().name];
  EXPECT_EQ(covariates["motor_A"], 1);
  EXPECT_EQ(covariates["azimuth_deg"], 1);
}

/// A third power is in the library, a fourth is not; whichever of the two laws comes second.
TEST(Discover, SaysOfEachLawWhichEffectOfTheLibraryDescribesItAsWell) {
  for (const double third_nT : {3.0, 0.8}) {
    const DiscoveryReport r = found_in(
        [=](const Pose&, int i, int a, const Eigen::Vector3d& v) {
          if (i == 1 && a == 2) return 2 * std::pow(v[a] / 50'000, 4);
          return i == 0 && a == 0 ? third_nT * std::pow(v[a] / 50'000, 3) : 0.0;
        },
        12);
    ASSERT_EQ(r.laws.size(), 2U) << report::to_text(r, "run.csv");
    for (const FoundLaw& law : r.laws) {
      if (law.formulas.front().where == "s1.x") {
        ASSERT_EQ(law.as_well.size(), 1U);
        EXPECT_EQ(law.as_well.front().name, "axis.cubic");
        EXPECT_EQ(law.as_well.front().where, "s1.x");
      } else {
        EXPECT_TRUE(law.as_well.empty()) << law.as_well.front().name;
      }
    }
  }
}

/// A gradient of the site that swings, in the frame of the site: what each sensor reads of it turns with the
/// table.
TEST(Discover, NamesAnOscillationOfTheGradient) {
  rig::Scenario scenario =
      rig::parse_scenario("[rig]\nparameters = \"random\"\nseed = 59\n", "s.toml").value();
  scenario.effects.push_back(
      rig::effect_of("name = 'hidden.gradient-oscillation'\nnT_per_m = 25\nperiod_s = 540").value());
  const PoseTable run = rig::simulated_table(scenario, rig::run_of_157({.senses = true}, 59), 59);
  const DiscoveryReport r = must(discover(run, {.fit = {}, .draws = 300, .checks = true}));
  ASSERT_EQ(r.finding, LawFinding::law) << report::to_text(r, "run.csv");
  const FoundFormula& first = r.laws.front().formulas.front();
  EXPECT_EQ(first.where, "site gradient");
  EXPECT_NEAR(*first.inner, 540 / 3600.0, 1e-4);
  ASSERT_EQ(first.specs.size(), 1U);
  ASSERT_EQ(first.coefficients.size(), 10U);
  EXPECT_EQ(first.coefficients.front().where, "Gxx.a");
  EXPECT_EQ(first.coefficients.front().unit, "nT/m");
  EXPECT_NEAR(std::hypot(first.coefficients[0].value, first.coefficients[1].value), 25, 0.1);
  // What a sensor reads of it: 25 nT/m over the arm, a half of that in the mean over time and attitudes.
  EXPECT_GT(first.size_nT, 1);
  EXPECT_LT(first.size_nT, 5);
  ASSERT_TRUE(r.after) << "the formula is an effect";
  EXPECT_LT(r.after->residual_nT, 1.1 * r.noise_nT);
  EXPECT_THAT(report::to_text(r, "run.csv"), HasSubstr("--level gradient --unit nT/m"));
}

/// The curve has no formula in it: the knee must lie within its band, up to a constant.
TEST(Discover, DrawsTheShape) {
  const auto knee = [](double T) { return 0.3 * std::max(0.0, T - 21.5); };
  const DiscoveryReport r = found_in(on(7, [&](const Pose& p) { return knee(*p.T_degC[2]); }), 9, true);
  ASSERT_TRUE(!r.laws.empty() && r.laws.front().shape) << report::to_text(r, "run.csv");
  const LawShape& shape = *r.laws.front().shape;
  EXPECT_EQ(shape.covariate, "s3_T_degC");
  EXPECT_EQ(shape.where, "s3.y");
  ASSERT_FALSE(shape.formulas.empty());
  double constant = 0;
  for (std::size_t i = 0; i < shape.x.size(); ++i)
    constant += (shape.y_nT[i] - knee(shape.x[i])) / static_cast<double>(shape.x.size());
  int outside = 0;
  for (std::size_t i = 0; i < shape.x.size(); ++i) {
    EXPECT_LT(shape.sd_nT[i], 0.1);
    const double off = std::abs(shape.y_nT[i] - knee(shape.x[i]) - constant);
    if (off > shape.simultaneous * shape.sd_nT[i] + 0.02) ++outside;
  }
  EXPECT_LE(outside, 4);
  const auto j = report::to_json(r, "run.csv");
  EXPECT_EQ(j["curve"]["x"].size(), shape.x.size());
}

/// Nothing that was recorded goes with it: no formula is named.
TEST(Discover, AnUnrecordedLoadIsNoLaw) {
  const DiscoveryReport r = found_in(on(8,
                                        [](const Pose& p) {
                                          std::mt19937_64 rng(static_cast<std::uint64_t>(p.number) * 104729);
                                          return rng() % 2 == 0 ? 0.15 : 0.0;
                                        }),
                                     7);
  EXPECT_EQ(r.finding, LawFinding::noise_like) << report::to_text(r, "run.csv");
  EXPECT_LT(r.laws.front().over_jumps, 0);
  EXPECT_GT(r.laws.front().jumps_P, 0.99);
  EXPECT_LT(r.laws.front().formulas.front().P, 0.01) << "jumps stand in its place";
  EXPECT_EQ(r.reason.rule, Rule::random_instead);
  const std::string text = report::to_text(r, "run.csv");
  EXPECT_THAT(text, HasSubstr("why: 2 ln of the odds of all formulas against an offset that jumps"));
}

TEST(Discover, AnOffsetThatWalksIsNoLaw) {
  std::map<int, double> offset;
  double now = 0;
  std::mt19937_64 rng(8);
  std::normal_distribution<double> normal;
  for (int k = 0; k <= 200; ++k) offset[k] = now += 0.03 * normal(rng);
  const DiscoveryReport r = found_in(on(3, [offset](const Pose& p) { return offset.at(p.number); }), 8);
  EXPECT_EQ(r.finding, LawFinding::noise_like) << report::to_text(r, "run.csv");
}

/// A law a hundred times the noise hides the noise from the tests until it is in the model.
TEST(Discover, ALargeLawDoesNotHideTheNoise) {
  const DiscoveryReport r =
      found_in(on(5, [](const Pose& p) { return 12 * std::sin(3 * *p.azimuth_rad + 0.6); }), 4);
  EXPECT_EQ(r.finding, LawFinding::law) << report::to_text(r, "run.csv");
  EXPECT_GT(r.laws.front().d, 500);
}

/// One of two laws leaves the other, which a random offset would take up too.
TEST(Discover, ALawBesideAnUnrecordedLoadIsOnlyAShape) {
  const DiscoveryReport r =
      found_in(on(8,
                  [](const Pose& p) {
                    std::mt19937_64 rng(static_cast<std::uint64_t>(p.number) * 104729);
                    return (rng() % 2 == 0 ? 0.15 : 0.0) + 0.4 * std::sin(3 * *p.azimuth_rad);
                  }),
               7);
  EXPECT_EQ(r.finding, LawFinding::shape_only) << report::to_text(r, "run.csv");
  EXPECT_EQ(r.laws.front().covariates.front().name, "azimuth_deg");
  EXPECT_EQ(r.reason.rule, Rule::random_beside);
  EXPECT_GT(r.reason.measured, 0);
  const nlohmann::json reason = report::to_json(r, "run.csv").at("reason");
  EXPECT_EQ(reason.at("rule"), "random-beside");
  EXPECT_THAT(reason.at("text").get<std::string>(), HasSubstr("beside them is"));
}

/// In noise thousands of formulas are as good as each other: those that are not described are counted.
TEST(Discover, CountsTheWholeSet) {
  DiscoveryReport r = found_in({}, 4);
  FoundLaw& law = r.laws.front();
  ASSERT_EQ(law.formulas.size(), 40U);
  double P = 0;
  for (const FoundFormula& formula : law.formulas) P += formula.P;
  EXPECT_LT(P, 0.9);
  EXPECT_GT(law.more, 100U);
  r.finding = LawFinding::law_set, law.stands_out = true;
  EXPECT_THAT(report::to_text(r, "run.csv"), HasSubstr(fmt::format("and {} more in the", 32 + law.more)));
}

/// An offset may walk beside a law as well as in noise: that is nothing against the formula.
TEST(Discover, WhatIsLeftSaysNothingAgainstTheFormula) {
  const DiscoveryReport r =
      found_in(on(5, [](const Pose& p) { return 0.12 * std::sin(3 * *p.azimuth_rad + 0.6); }), 8);
  ASSERT_EQ(r.finding, LawFinding::law) << report::to_text(r, "run.csv");
  const FoundLaw& law = r.laws.front();
  EXPECT_LT(law.over_nothing_beside, 0);
  EXPECT_GT(law.over_nothing_beside, -10) << "chosen so that an offset beside the law has some probability";
  EXPECT_GT(law.over_walk, 100) << "in its place it has none";
  EXPECT_GT(law.formulas.front().P, 0.99);
}

/// Judgements of a growing run share the chance of a false name.
TEST(Discover, NamesLessAtEachOfSeveralLooks) {
  const Hidden weak = on(5, [](const Pose& p) { return 0.042 * std::sin(3 * *p.azimuth_rad + 0.6); });
  const DiscoveryReport once = found_in(weak, 4), often = found_in(weak, 4, false, 5);
  EXPECT_EQ(once.laws.front().log10_p, often.laws.front().log10_p);
  EXPECT_LT(once.laws.front().log10_p, -2.05);
  EXPECT_GT(once.laws.front().log10_p, -2.65);
  EXPECT_NE(once.finding, LawFinding::pass) << report::to_text(once, "run.csv");
  EXPECT_EQ(often.finding, LawFinding::pass) << report::to_text(often, "run.csv");
  EXPECT_FALSE(often.laws.front().stands_out);
}

TEST(Discover, TellsTheSameInWordsAndNumbers) {
  const DiscoveryReport r =
      found_in(on(5, [](const Pose& p) { return 0.12 * std::sin(3 * *p.azimuth_rad + 0.6); }), 4);
  const nlohmann::json j = report::to_json(r, "run.csv");
  EXPECT_EQ(j["schema"], "mgt.discover/1");
  EXPECT_EQ(j["verdict"], "LAW");
  EXPECT_EQ(j["formulas"][0]["where"], "s2.z");
  EXPECT_EQ(j["hypotheses"], r.hypotheses);
  for (const char* key : {"log10_p_search", "d", "covariates", "where", "stochastic", "curve", "after",
                          "extrapolation_spread", "next", "text"})
    EXPECT_TRUE(j.contains(key)) << key;
  const std::string text = report::to_text(r, "run.csv");
  EXPECT_THAT(text, HasSubstr("LAW: a*sind(3*azimuth_deg) + b*cosd(3*azimuth_deg) at s2.z."));
  EXPECT_THAT(text, ::testing::ContainsRegex("\nresidual [^\n]* questions with their places\n"));
}

}  // namespace
}  // namespace mgtd::calib::discovery
