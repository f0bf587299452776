// SPDX-License-Identifier: Apache-2.0
// A core that remembers, in a table of poses that does not tell the way between them.
#include <gtest/gtest.h>

#include <algorithm>

#include "calib/criticism/search/explain.h"
#include "calib/report/verdict_text.h"
#include "tests/blind/planted.h"
#include "tests/support/parameter_name.h"

namespace mgtd::calib::criticism::search {
namespace {

struct Row {
  std::string where;
  double width;
  double sigmas;     ///< by the law that knows the way
  bool bare{false};  ///< nor times, senses and dwells
};

void PrintTo(const Row& row, std::ostream* out) {
  *out << row.where << " w " << row.width << ", " << row.sigmas << " sigmas";
}

bool named_or_possible(const ExplainReport& r) {
  const auto in = [](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), "axis.hysteresis") != names.end();
  };
  return in(r.named) ||
         std::any_of(r.rounds.begin(), r.rounds.end(), [&](const Round& x) { return in(x.possible); });
}

class WithoutPath : public ::testing::TestWithParam<Row> {};

TEST_P(WithoutPath, AMemoryIsNotGivenAnotherName) {
  const Row& row = GetParam();
  constexpr std::uint64_t kSeed = 60;
  const testing::Stage stage = testing::full_stage(kSeed);
  const testing::Sized planted =
      testing::sized(stage, {"axis.hysteresis", row.where, {1, row.width}, {}}, row.sigmas, kSeed);
  PoseTable run = testing::planted_run(stage, {planted.effect}, kSeed);
  run.path.clear();
  if (row.bare) {
    for (Pose& pose : run.poses) {
      pose.t_s.reset(), pose.sense.reset(), pose.dwell_s.reset(), pose.since_stop_s.reset();
    }
  }
  const auto r = explain(run, {});
  ASSERT_TRUE(r) << r.error().text();
  const std::vector<std::string> memory{"axis.hysteresis"};
  if (r->finding == Finding::explained) {
    EXPECT_EQ(r->named, memory) << report::sentence(*r);
  }
  if (row.sigmas < 30) return;  // a sketch of so little may be missed
  EXPECT_NE(r->finding, Finding::pass);
  EXPECT_TRUE(named_or_possible(*r) || r->named.empty()) << report::sentence(*r);
  EXPECT_TRUE(std::any_of(r->notes.begin(), r->notes.end(), [](const ExplainNote& note) {
    return std::holds_alternative<TablePathUnknown>(note);
  }));
}

std::vector<Row> rows() {
  return {{"s1.x", 0.05, 300}, {"s1.x", 0.1, 30}, {"s1.x", 0.4, 10},       {"s3.z", 0.1, 300},
          {"all", 0.05, 10},   {"all", 0.2, 100}, {"s2.y", 0.2, 100, true}};
}

INSTANTIATE_TEST_SUITE_P(Explain, WithoutPath, ::testing::ValuesIn(rows()), [](const auto& info) {
  return mgtd::testing::parameter_name(::testing::PrintToString(info.param));
});

}  // namespace
}  // namespace mgtd::calib::criticism::search
