// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/grammar.h"

#include <gmock/gmock.h>

#include <set>

#include "calib/discovery/formula_text.h"
#include "calib/effects/library/library.h"
#include "tests/unit/calib/discovery/discovery_scene.h"

namespace mgtd::calib::discovery {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

TEST(Grammar, IsTheSameForTheSameRunAndAnotherForAnother) {
  const auto a = testing::scene({}, 1), b = testing::scene({}, 1), c = testing::scene({}, 2);
  EXPECT_EQ(a->formulas.hash(), b->formulas.hash());
  EXPECT_NE(a->formulas.hash(), c->formulas.hash());
  EXPECT_GT(a->formulas.families.size(), 400U);
  EXPECT_GT(a->formulas.members(), 1000U);
}

TEST(Grammar, EveryFormulaHasAValueAtEveryPose) {
  const auto s = testing::scene({}, 1);
  for (const Family& family : s->formulas.families) {
    for (const double inner : family.inner) {
      for (const std::string& column : family.columns(inner)) {
        const auto values = s->inputs(column, 4);
        ASSERT_TRUE(values) << values.error().text();
        EXPECT_EQ(values->size(), s->inputs.poses()) << column;
        EXPECT_TRUE(values->allFinite()) << column;
      }
    }
  }
}

TEST(Grammar, NamesEveryColumnThatVaries) {
  const auto s = testing::scene({}, 1);
  std::set<std::string> covariates;
  for (const Family& family : s->formulas.families)
    covariates.insert(family.covariates.begin(), family.covariates.end());
  for (const char* name : {"t_h", "T_degC", "s3_T_degC", "motor_A", "battery_V", "azimuth_deg", "pose", "u",
                           "uy", "prev_u", "gravity", "s2_x_nT"})
    EXPECT_THAT(covariates, Contains(name));
}

/// What a formula is worth in a search it is worth as an effect of the model.
TEST(Grammar, AFormulaIsTheEffectThatItsSpecMakes) {
  const auto s = testing::scene({}, 1);
  const Place place{Place::Kind::axis, 5};
  std::size_t tried = 0;
  for (std::size_t f = 0; f < s->formulas.families.size(); f += 7) {
    const Family& family = s->formulas.families[f];
    if (family.foreign_sensor == 1 || family.foreign_axis == 2) continue;
    const Columns columns = family.columns(family.inner[family.inner.size() / 2]);
    const std::string spec = specs_of(columns, place, "law").front();
    const auto made = effects::library::make_effect(spec, 4);
    ASSERT_TRUE(made) << spec << ": " << made.error().text();
    PerSensor<Eigen::Vector3d> offset_nT(4);
    for (std::size_t i = 0; i < 4; ++i) offset_nT[i] = s->fit.state.sensors[i].offset_nT;
    const effects::EffectContext context{.table = &s->table, .offset_nT = offset_nT};
    const auto effects = effects::library::bound_to_run({*made}, context);
    ASSERT_TRUE(effects) << spec << ": " << effects.error().text();
    const effects::Effect& effect = *effects->front();
    std::vector<Eigen::VectorXd> values;
    for (const std::string& column : columns) values.push_back(testing::must(s->inputs(column, 5)));
    for (std::size_t k = 0; k < s->fit.problem.poses.size(); k += 31) {
      const fit::joint::JointPose& pose = s->fit.problem.poses[k];
      // As fitted: the reading less offset to its noise.
      Eigen::Vector3d v;
      for (int a = 0; a < 3; ++a)
        v[a] = s->inputs.name(std::array{"ux", "uy", "uz"}.at(static_cast<std::size_t>(a)),
                              5)[static_cast<Eigen::Index>(k)];
      EXPECT_LT((v - pose.y_nT.segment<3>(3) + s->fit.state.sensors[1].offset_nT).norm(), 1);
      for (std::size_t j = 0; j < columns.size(); ++j) {
        std::vector<double> c(columns.size(), 0.0);
        c[j] = 1;
        std::array<double, 3> out{};
        if (effect.missing(*pose.pose).empty())
          effect.term(pose.conditions(), 1, std::span<const double>(v.data(), 3), c, out);
        const double expected = values[j][static_cast<Eigen::Index>(k)];
        EXPECT_NEAR(out[2], expected, 1e-9 * (1 + std::abs(expected)))
            << spec << " at pose " << pose.pose->number;
      }
    }
    ++tried;
  }
  EXPECT_GT(tried, 50U);
}

}  // namespace
}  // namespace mgtd::calib::discovery
