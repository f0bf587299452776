// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/law_round.h"

#include <gtest/gtest.h>

#include <stop_token>

#include "tests/unit/calib/discovery/discovery_scene.h"

namespace mgtd::calib::discovery {
namespace {

/// A daemon that ends does not wait for the rounds that are left.
TEST(LawRound, EndsWhenTheFitIsToldToStop) {
  const auto s = testing::scene({}, 8);
  const FormulaValues values = testing::must(FormulaValues::of(s->formulas, s->inputs));
  const FormulaProducts products(values, s->sums);
  fit::joint::JointProblem problem = s->fit.problem;
  std::stop_source stop;
  problem.stop = stop.get_token();
  const Workbench bench{.grammar = s->formulas,
                        .inputs = s->inputs,
                        .products = products,
                        .problem = problem,
                        .residual = s->residual,
                        .noise = {}};
  EXPECT_TRUE(law_round(bench, s->sums, false));
  stop.request_stop();
  const auto stopped = law_round(bench, s->sums, false);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::state);
}

}  // namespace
}  // namespace mgtd::calib::discovery
