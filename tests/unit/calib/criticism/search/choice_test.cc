// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/choice.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "calib/criticism/search/explain.h"
#include "calib/criticism/search/model_change.h"
#include "calib/criticism/tests/comparison.h"
#include "calib/effects/library/library.h"
#include "calib/report/choice_json.h"
#include "calib/report/choice_text.h"
#include "tests/blind/hidden_run.h"

namespace mgtd::calib::criticism::search {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::hidden_run;
using testing::HiddenRun;

effects::EffectPtr effect(const std::string& spec) { return effects::library::make_effect(spec).value(); }

/// An offset that goes with temperature, on a run whose temperature goes with time (`monotone`) or does not.
PoseTable warm(bool monotone, std::uint64_t seed) {
  HiddenRun run;
  PoseTable out = hidden_run(run, seed);
  for (Pose& pose : out.poses) {
    const double hours = *pose.t_s / 3600;
    if (monotone) pose.T_degC[2] = 20 + 3 * hours;
    pose.y_nT[2][2] += 4.0 * (*pose.T_degC[2] - 20);
  }
  return out;
}

struct Chosen {
  PoseTable table;
  fit::FitOptions model;
  Choice choice;
};

Chosen chosen(PoseTable table, const std::string& spec) {
  const auto before = explain(table, {});
  if (!before) throw std::runtime_error(before.error().text());
  const effects::EffectPtr added = effect(spec);
  Chosen out{.table = std::move(table), .model = {}, .choice = {}};
  out.choice = choice_of(*before, out.table, added);
  out.model.effects = {added};
  return out;
}

TEST(Choice, KeepsWhatCouldStandInItsPlaceUntilOtherPosesSettleIt) {
  const Chosen c = chosen(warm(true, 1), "axis.offset.temperature@s3.z");
  EXPECT_EQ(c.choice.finding, "AMBIGUOUS");
  ASSERT_THAT(c.choice.alternatives, ElementsAre("axis.offset.drift@s3.z"));
  EXPECT_FALSE(c.choice.describes);
  EXPECT_THAT(report::to_text(c.choice), HasSubstr("axis.offset.drift@s3.z could stand in its place"));
  EXPECT_EQ(on_these_poses(c.choice, c.table, c.model).alternatives, c.choice.alternatives)
      << "the same poses";
  EXPECT_EQ(on_these_poses(c.choice, warm(true, 2), c.model).alternatives, c.choice.alternatives)
      << "other poses that do not tell them apart either";
  EXPECT_FALSE(on_these_poses(c.choice, warm(false, 2), c.model).open());
}

TEST(Choice, ANameThatStoodAloneLeavesNothingOpen) {
  const Chosen c = chosen(warm(false, 1), "axis.offset.temperature@s3.z");
  EXPECT_EQ(c.choice.finding, "EXPLAINED");
  EXPECT_FALSE(c.choice.open());
  EXPECT_EQ(report::to_text(c.choice), "");
}

/// Something that is in no library: a ninth harmonic of the azimuth.
TEST(Choice, ASurrogateDescribesAndDoesNotExplain) {
  HiddenRun run;
  run.hidden = [](const Pose& p, int i, int a, const Eigen::Vector3d&) {
    return i == 1 && a == 0 ? 8 * std::sin(9 * *p.azimuth_rad) : 0.0;
  };
  const Chosen c = chosen(hidden_run(run, 1), "axis.cubic@s2.x");
  EXPECT_TRUE(c.choice.describes);
  EXPECT_THAT(report::to_text(c.choice), HasSubstr("describes the readings, it does not explain them"));
}

TEST(Choice, ReadsBackAndAnEarlierFileHasNone) {
  const Choice choice{
      .spec = "a", .finding = "AMBIGUOUS", .alternatives = {"b", "c"}, .describes = true, .data = "d"};
  const Choice read = report::choice_from_json(report::to_json(choice));
  EXPECT_EQ(report::to_json(read), report::to_json(choice));
  EXPECT_FALSE(report::choice_from_json(nlohmann::json::object()).open());
}

/// The number that was found is part of what is kept, and all judges see the same residual with it.
TEST(Choice, ASearchedNumberIsKeptAsItWasFound) {
  HiddenRun run;
  run.hidden = [](const Pose& p, int i, int a, const Eigen::Vector3d&) {
    return i == 3 && a == 1 && *p.t_s > 2400 ? 6.0 : 0.0;
  };
  const PoseTable table = hidden_run(run, 5);
  const auto change = add_effect(table, {}, effect("axis.offset.step@s4.y"));
  ASSERT_TRUE(change) << change.error().text();
  EXPECT_THAT(change->spec, HasSubstr(",ts="));
  fit::FitOptions kept;
  kept.effects = {effect(change->spec)};
  fit::FitOptions open;
  open.effects = {effect("axis.offset.step@s4.y")};
  const auto fitted = fit::method_choice::fit(table, kept);
  ASSERT_TRUE(fitted);
  for (const fit::FitOptions& options : {kept, open}) {
    const auto explained = explain(table, {.fit = options});
    const auto compared = tests::compare(table, options);
    ASSERT_TRUE(explained && compared);
    EXPECT_NEAR(explained->residual_nT, fitted->residual_nT, 1e-6);
    EXPECT_NEAR(compared->residual_nT, fitted->residual_nT, 1e-6);
    EXPECT_EQ(explained->finding, Finding::pass);
  }
  EXPECT_NEAR(change->rms_after_nT, fitted->residual_nT, 1e-6);
}

}  // namespace
}  // namespace mgtd::calib::criticism::search
