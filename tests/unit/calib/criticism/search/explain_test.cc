// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/explain.h"

#include <gtest/gtest.h>

#include "calib/report/explain_json.h"
#include "calib/report/verdict_text.h"
#include "tests/unit/calib/criticism/hidden.h"

namespace mgtd::calib::criticism::search {
namespace {

using testing::few_candidates;
using testing::hidden_run;
using testing::HiddenRun;

ExplainReport must_explain(const PoseTable& table) {
  auto report = explain(table, {.fit = {}, .candidate_effects = few_candidates()});
  if (!report) throw std::runtime_error(report.error().text());
  return std::move(*report);
}

TEST(Explain, CleanRunPasses) {
  const ExplainReport r = must_explain(hidden_run({}, 1));
  EXPECT_EQ(r.finding, Finding::pass) << report::sentence(r);
  EXPECT_TRUE(r.named.empty());
  EXPECT_EQ(r.detectable.size(), 5U);
  EXPECT_NEAR(r.chi2, r.dof, 4 * std::sqrt(2 * r.dof));
}

TEST(Explain, OffsetOfOneAxisThatFollowsTemperatureIsNamed) {
  HiddenRun run;
  run.hidden = [](const Pose& p, int i, int a, const Eigen::Vector3d&) {
    return i == 2 && a == 2 ? 0.42 * (*p.T_degC[2] - 20) : 0;
  };
  const ExplainReport r = must_explain(hidden_run(run, 2));
  EXPECT_EQ(r.finding, Finding::explained) << report::sentence(r);
  ASSERT_EQ(r.named, std::vector<std::string>{"offset.temperature"});
  const tests::Candidate& c = r.rounds.front().added;
  EXPECT_EQ(c.where, "s3.z");
  ASSERT_EQ(c.coefficients.size(), 1U);
  EXPECT_NEAR(c.coefficients[0].value, 0.42, 4 * c.coefficients[0].sd);
  // The fall that was predicted without a fit is the one that the fit brings.
  EXPECT_NEAR(r.rounds.front().chi2_before - r.rounds.front().chi2_after, c.fall, 0.05 * c.fall);
}

}  // namespace
}  // namespace mgtd::calib::criticism::search
