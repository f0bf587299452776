// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "calib/criticism/search/explain.h"
#include "calib/criticism/search/improve.h"
#include "calib/criticism/tests/comparison.h"
#include "calib/report/comparison_report.h"
#include "calib/report/explain_json.h"
#include "calib/report/verdict_text.h"
#include "tests/unit/calib/criticism/hidden.h"

/// The library's effects on runs whose physics is written here once more.
namespace mgtd::calib::criticism::tests {
namespace {

using testing::Hidden;
using testing::hidden_run;

search::ExplainReport must_explain(const PoseTable& table) {
  auto report = search::explain(table, {});
  if (!report) throw std::runtime_error(report.error().text());
  return std::move(*report);
}

Hidden on(int sensor, int axis, std::function<double(const Pose&, const Eigen::Vector3d&)> law) {
  return [=](const Pose& p, int i, int a, const Eigen::Vector3d& v) {
    return i == sensor && a == axis ? law(p, v) : 0;
  };
}

TEST(LibraryCandidates, CleanRunPassesAndSaysWhatItCouldHaveSeen) {
  const search::ExplainReport r = must_explain(hidden_run({}, 7));
  EXPECT_EQ(r.finding, search::Finding::pass) << report::sentence(r);
  EXPECT_GT(r.detectable.size(), 15U);
  const auto absorbed = std::count_if(r.untestable.begin(), r.untestable.end(), [](const Untestable& u) {
    return u.effect == "platform.hard-iron" || u.effect == "platform.soft-iron" ||
           u.effect == "platform.crosstalk";
  });
  EXPECT_EQ(absorbed, 3);
}

TEST(LibraryCandidates, ALawOfOneAxisIsNamedWithItsPlace) {
  const std::vector<std::pair<std::string, Hidden>> cases{
      {"axis.cubic",
       on(1, 0, [](const Pose&, const Eigen::Vector3d& v) { return 8 * std::pow(v[0] / 5e4, 3); })},
      {"axis.offset.temperature",
       on(1, 0, [](const Pose& p, const Eigen::Vector3d&) { return *p.T_degC[1] - 20; })},
      {"axis.gain.temperature",
       on(1, 0, [](const Pose& p, const Eigen::Vector3d& v) { return 30e-6 * (*p.T_degC[1] - 20) * v[0]; })}};
  for (const auto& [name, hidden] : cases) {
    const search::ExplainReport r = must_explain(hidden_run({.hidden = hidden}, 11));
    EXPECT_EQ(r.finding, search::Finding::explained) << report::sentence(r);
    EXPECT_EQ(r.named, std::vector<std::string>{name});
    EXPECT_EQ(r.rounds.front().added.where, "s2.x");
  }
}

TEST(LibraryCandidates, OwnSquareAgainstTransverseSquaresIsNeverDecided) {
  // In one field strength v_b^2 + v_c^2 is F^2 less v_a^2.
  const Hidden quadratic =
      on(2, 1, [](const Pose&, const Eigen::Vector3d& v) { return 4 * std::pow(v[1] / 5e4, 2); });
  const Hidden transverse =
      on(2, 1, [](const Pose&, const Eigen::Vector3d& v) { return -4 * (v[0] * v[0] + v[2] * v[2]) / 25e8; });
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const search::ExplainReport r =
        must_explain(hidden_run({.hidden = seed % 2 == 0 ? quadratic : transverse}, 20 + seed));
    EXPECT_EQ(r.finding, search::Finding::ambiguous) << report::sentence(r);
    for (const char* name : {"axis.quadratic", "axis.transverse"})
      EXPECT_NE(std::find(r.named.begin(), r.named.end(), name), r.named.end()) << name;
  }
}

TEST(LibraryCandidates, WhatIsInNoLibraryIsNotNamed) {
  // A lamp that nobody wrote down, on for a part of the run: it reaches two axes of one sensor.
  const Hidden lamp = [](const Pose& p, int i, int a, const Eigen::Vector3d& v) {
    return i == 3 && a != 1 ? 1.2 * std::sin(7 * std::atan2(v[1], v[0])) * (p.number % 3 == 0 ? 2.0 : 1.0)
                            : 0.0;
  };
  const search::ExplainReport r = must_explain(hidden_run({.hidden = lamp}, 31));
  EXPECT_TRUE(r.finding == search::Finding::unknown || r.finding == search::Finding::partial)
      << report::sentence(r);
}

TEST(LibraryCandidates, TheJsonHasItsKeys) {
  const nlohmann::json j = report::to_json(must_explain(hidden_run({}, 8)));
  for (const char* key : {"schema", "verdict", "candidates", "named", "maps", "lack_of_fit",
                          "detectable_above", "untestable", "next", "text"})
    EXPECT_TRUE(j.contains(key)) << key;
  EXPECT_TRUE(j["lack_of_fit"].is_null());
  for (const char* key :
       {"effect", "where", "log10_p", "p", "d", "share", "coefficients", "rivals", "plausible"})
    EXPECT_TRUE(j["candidates"][0].contains(key)) << key;
}

TEST(LibraryCandidates, ImproveAddsWhatIsMissingAndUnseenPosesAgree) {
  const Hidden hidden = [](const Pose& p, int i, int a, const Eigen::Vector3d& v) {
    if (i == 0 && a == 2) return 1.5 * (*p.T_degC[0] - 20);
    return i == 3 && a == 1 ? 12 * std::pow(v[1] / 5e4, 3) : 0.0;
  };
  const auto r = search::improve(hidden_run({.hidden = hidden}, 12), {});
  ASSERT_TRUE(r) << r.error().text();
  ASSERT_EQ(r->rounds.size(), 2U);
  EXPECT_EQ(r->finding, search::Finding::pass);
  for (const search::ImproveRound& round : r->rounds) {
    EXPECT_LT(*round.held_out_after_nT, *round.held_out_before_nT);
    // As predicted without a fit, roughly: while the model is far off the weights follow the residual.
    EXPECT_NEAR(round.realised_fall / round.predicted_fall, 1, 0.5);
  }
  EXPECT_EQ(r->fit.calibration.effects.size(), 2U);
}

TEST(Comparison, SaysWhichChannelFollowsWhat) {
  const auto clean = compare(hidden_run({}, 14), {});
  ASSERT_TRUE(clean) << clean.error().text();
  EXPECT_TRUE(clean->fits);
  EXPECT_EQ(clean->channels.size(), 5U);
  const auto r = compare(
      hidden_run(
          {.hidden = on(2, 0, [](const Pose& p, const Eigen::Vector3d&) { return *p.T_degC[2] - 20; })}, 14),
      {});
  ASSERT_TRUE(r);
  EXPECT_FALSE(r->fits);
  const Dependence& d = r->channels.front().against.front();
  EXPECT_NE(d.covariate.find("T_degC"), std::string::npos);
  EXPECT_EQ(d.component, "s3.x");
  EXPECT_EQ(report::to_json(*r)["schema"], "mgt.compare/1");
}

TEST(Comparison, WhatOrdersThePosesAlikeIsShownOnce) {
  PoseTable table = hidden_run({}, 14);
  for (Pose& pose : table.poses) {
    for (auto& T : pose.T_degC) T = 20 + *pose.t_s / 3600;
    pose.covariates["battery_V"] = 13 - *pose.t_s / 36'000;
  }
  const auto r = compare(table, {});
  ASSERT_TRUE(r);
  EXPECT_EQ(r->channels.front().against.size(), 3U) << "time, azimuth, and the battery, which falls";
  EXPECT_THAT(r->alike, ::testing::Contains(std::pair<std::string, std::string>("s3_T_degC", "time_h")));
}

}  // namespace
}  // namespace mgtd::calib::criticism::tests
