// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/judgement.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "calib/criticism/search/explain.h"
#include "calib/linear/parts.h"
#include "calib/report/explain_json.h"
#include "calib/report/verdict_text.h"
#include "tests/blind/wandering_offsets.h"
#include "tests/support/one_processor.h"
#include "tests/unit/calib/criticism/hidden.h"

namespace mgtd::calib::criticism::tests {
namespace {

using testing::few_candidates;
using testing::hidden_run;
using testing::HiddenRun;
using testing::wandering_offsets;

search::ExplainReport must_explain(const PoseTable& table) {
  auto report = search::explain(table, {.fit = {}, .candidate_effects = few_candidates()});
  if (!report) throw std::runtime_error(report.error().text());
  return std::move(*report);
}

TEST(Judgement, OffsetsThatWanderAreNoiseAndGetNoName) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    HiddenRun run{.noise_nT = 0.2};
    run.hidden = wandering_offsets({.step_nT = 0.1}, seed);
    const search::ExplainReport r = must_explain(hidden_run(run, seed));
    EXPECT_EQ(r.finding, search::Finding::pass) << report::sentence(r);
    EXPECT_TRUE(r.noise.wandering.any());
    EXPECT_THAT(report::sentence(r), ::testing::HasSubstr("slow wandering of all offsets"));
  }
}

TEST(Judgement, SaysTheSameOnOneProcessorToTheLastDigit) {
  if (linear::threads() < 2) GTEST_SKIP() << "one processor";
  HiddenRun run{.noise_nT = 0.2};
  const auto walk = wandering_offsets({.step_nT = 0.1}, 7);
  run.hidden = [walk](const Pose& p, int i, int a, const Eigen::Vector3d& y) {
    return walk(p, i, a, y) + (i == 1 && a == 0 ? 0.9 * (*p.T_degC[1] - 20) : 0);
  };
  const PoseTable table = hidden_run(run, 6);
  const std::string here = report::to_json(must_explain(table)).dump();
  const test::OneProcessor one;
  EXPECT_EQ(report::to_json(must_explain(table)).dump(), here);
}

/// A straight line is not what a walk does, however well a walk describes it.
TEST(Judgement, ADriftOfOneAxisIsADrift) {
  HiddenRun run;
  run.hidden = [](const Pose& p, int i, int a, const Eigen::Vector3d&) {
    return i == 2 && a == 1 ? 1.5 * *p.t_s / 3600 : 0;
  };
  const search::ExplainReport r = must_explain(hidden_run(run, 5));
  EXPECT_EQ(r.finding, search::Finding::explained) << report::sentence(r);
  EXPECT_EQ(r.named, std::vector<std::string>{"offset.drift"});
  EXPECT_FALSE(r.noise.wandering.any());
}

TEST(Judgement, ALawIsNamedBesideOffsetsThatWander) {
  HiddenRun run{.noise_nT = 0.2};
  const auto walk = wandering_offsets({.step_nT = 0.1}, 7);
  run.hidden = [walk](const Pose& p, int i, int a, const Eigen::Vector3d& v) {
    return walk(p, i, a, v) + (i == 0 && a == 2 ? 20 * std::pow(v[2] / 50'000, 3) : 0);
  };
  const search::ExplainReport r = must_explain(hidden_run(run, 7));
  EXPECT_EQ(r.finding, search::Finding::explained) << report::sentence(r);
  EXPECT_EQ(r.named, std::vector<std::string>{"cubic"});
}

/// Samples within the dwells are correlated, and the table does not say so.
TEST(Judgement, NoiseThatIsLargerThanTheDwellsSayGetsNoName) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    PoseTable table = hidden_run({}, seed);
    for (Pose& pose : table.poses)
      for (auto& sensor : pose.sd_nT)
        for (auto& sd : sensor) *sd /= 2;
    const search::ExplainReport r = must_explain(table);
    EXPECT_EQ(r.finding, search::Finding::pass) << report::sentence(r);
    EXPECT_NEAR(r.noise.beyond_dwells, 2, 0.1);
    EXPECT_THAT(report::sentence(r), ::testing::HasSubstr("successive samples are correlated"));
  }
}

/// Where one channel alone is beyond its noise something is with that channel.
TEST(Judgement, OneChannelBeyondItsNoiseIsNotTheNoiseOfTheDwells) {
  std::mt19937_64 rng(3);
  std::normal_distribution<double> normal;
  HiddenRun run;
  run.hidden = [&](const Pose&, int i, int a, const Eigen::Vector3d&) {
    return i == 1 && a == 0 ? 1.5 * normal(rng) : 0;
  };
  const search::ExplainReport r = must_explain(hidden_run(run, 6));
  EXPECT_EQ(r.finding, search::Finding::unknown) << report::sentence(r);
}

}  // namespace
}  // namespace mgtd::calib::criticism::tests
