// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/library/library.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "calib/effects/library/effect_family.h"
#include "calib/effects/library/effect_page.h"
#include "tests/unit/calib/effects/effect_scene.h"

namespace mgtd::calib::effects::library {
namespace {

const CovariateMeans kNoMeans;

PoseTable rich_table() { return testing::run_with({}, {.standard = 12, .random = 18}, 5); }

/// Every family at every scale and at a few of its scanned values, on a run.
std::vector<EffectPtr> everything(const PoseTable& table) {
  const EffectContext context{.table = &table, .offset_nT = {}};
  std::vector<EffectPtr> out;
  for (const EffectFamily& family : effect_families()) {
    std::vector<std::optional<double>> values{std::nullopt};
    const std::vector<double> scan = scan_values(family, context);
    for (std::size_t i = 0; i < scan.size(); i += 5) values.emplace_back(scan[i]);
    for (const Where::Scale scale : family.scales) {
      const Where where{.scale = scale, .sensor = 2, .axis = 2};
      for (const auto value : values) {
        auto effect = make(family, where, value, context);
        EXPECT_TRUE(effect) << family.name << ": " << effect.error().text();
        if (effect) out.push_back(*effect);
      }
    }
  }
  return out;
}

struct Point {
  Conditions at;
  int sensor;
  std::vector<double> in, c;
};

std::vector<double> typical_input(Level level, std::mt19937_64& rng) {
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<double> in;
  for (int i = 0; i < inputs_of(level); ++i) {
    const bool field = level == Level::axis || (level == Level::platform && i < 3);
    in.push_back(unit(rng) * (field ? 40'000 : level == Level::site ? 0.2 : 1));
  }
  return in;
}

std::vector<double> value(const Effect& e, const Point& p) {
  std::vector<double> out(static_cast<std::size_t>(outputs_of(e.level())), 1e9);
  e.term(p.at, p.sensor, p.in, p.c, out);
  return out;
}

/// Largest disagreement of the duals with central differences over all inputs and coefficients, relative to
/// the largest derivative of that variable. `planted` falsifies the duals.
double derivative_error(const Effect& e, const Point& p, double planted = 0) {
  std::vector<Jet> in, c, out(static_cast<std::size_t>(outputs_of(e.level())));
  int slot = 0;
  for (const double x : p.in) in.push_back(Jet::variable(x, slot++));
  for (const double x : p.c) c.push_back(Jet::variable(x, slot++));
  e.term(p.at, p.sensor, in, c, out);
  double worst = 0;
  const int variables = slot;
  for (slot = 0; slot < variables; ++slot) {
    const auto i = static_cast<std::size_t>(slot);
    Point up = p, down = p;
    double& x_up = i < p.in.size() ? up.in[i] : up.c[i - p.in.size()];
    double& x_down = i < p.in.size() ? down.in[i] : down.c[i - p.in.size()];
    const double h = 1e-5 * std::max(1.0, std::abs(x_up));
    x_up += h, x_down -= h;
    const auto y_up = value(e, up), y_down = value(e, down);
    double error = 0, size = 1e-12;
    for (std::size_t o = 0; o < out.size(); ++o) {
      const double difference = (y_up[o] - y_down[o]) / (2 * h);
      error = std::max(error, std::abs(out[o].d[slot] * (1 + planted) - difference));
      size = std::max({size, std::abs(difference), std::abs(out[o].d[slot])});
    }
    // Rounding of the differenced values is the floor for derivatives that are nearly zero.
    const double floor = 1e-15 * std::abs(*std::max_element(y_up.begin(), y_up.end())) / h;
    worst = std::max(worst, error / (size + 1e4 * floor));
  }
  return worst;
}

Point point_of(const Effect& e, const Pose& pose, const Pose& previous, const CovariateMeans& means,
               std::mt19937_64& rng) {
  Point p{.at = {pose, *pose.t_s / 3600, &previous, &means},
          .sensor = 2,
          .in = typical_input(e.level(), rng),
          .c = {}};
  std::uniform_real_distribution<double> unit(-1, 1);
  for (const int i : e.active(p.at, p.sensor))
    p.c.push_back(e.coefficients()[static_cast<std::size_t>(i)].typical * unit(rng));
  return p;
}

TEST(EffectLibrary, DerivativesAreThoseOfTheEquation) {
  const PoseTable table = rich_table();
  const CovariateMeans means{{"motor_A", 0.8}};
  std::mt19937_64 rng(1);
  int checked = 0, caught = 0;
  for (const EffectPtr& e : everything(table)) {
    for (const std::size_t k : {5U, 14U, 25U}) {
      ASSERT_EQ(e->missing(table.poses[k]), "") << e->spec();
      const Point p = point_of(*e, table.poses[k], table.poses[k - 1], means, rng);
      // Central differences at 1e-5 of a unit: truncation and rounding meet near 1e-8.
      EXPECT_LT(derivative_error(*e, p), 1e-6) << e->spec();
      caught += derivative_error(*e, p, 1e-3) > 1e-5;
      ++checked;
    }
  }
  EXPECT_GT(checked, 300);
  // A planted error of a thousandth shows wherever the term has a derivative at all; a step that is still to
  // come has none.
  EXPECT_GT(caught, checked * 4 / 5);
}

/// To the last bit: a model evaluated by one way or the other is the same.
TEST(EffectLibrary, ShapesAreTheDerivativesByCoefficientsThatAreZero) {
  const PoseTable table = rich_table();
  std::mt19937_64 rng(4);
  for (const EffectPtr& e : everything(table)) {
    Point p = point_of(*e, table.poses[20], table.poses[19], kNoMeans, rng);
    std::fill(p.c.begin(), p.c.end(), 0.0);
    const auto outputs = static_cast<std::size_t>(outputs_of(e->level()));
    std::vector<double> shapes(outputs * p.c.size(), 1e9);
    ASSERT_EQ(e->shapes(p.at, p.sensor, p.in, shapes), e->level() == Level::axis) << e->spec();
    if (e->level() != Level::axis) continue;
    std::vector<Jet> in, c, out(outputs);
    int slot = 0;
    for (const double x : p.in) in.push_back(Jet::variable(x, slot++));
    for (const double x : p.c) c.push_back(Jet::variable(x, slot++));
    e->term(p.at, p.sensor, in, c, out);
    for (std::size_t o = 0; o < outputs; ++o) {
      EXPECT_EQ(out[o].v, 0) << e->spec();
      EXPECT_TRUE((out[o].d.head(static_cast<Eigen::Index>(in.size())) == 0).all()) << e->spec();
      for (std::size_t j = 0; j < c.size(); ++j)
        EXPECT_EQ(shapes[o + outputs * j], out[o].d[static_cast<Eigen::Index>(in.size() + j)]) << e->spec();
    }
  }
}

TEST(EffectLibrary, WithoutCoefficientsEveryTermVanishes) {
  const PoseTable table = rich_table();
  std::mt19937_64 rng(2);
  for (const EffectPtr& e : everything(table)) {
    Point p = point_of(*e, table.poses[20], table.poses[19], kNoMeans, rng);
    std::fill(p.c.begin(), p.c.end(), 0.0);
    for (const double y : value(*e, p)) EXPECT_EQ(y, 0) << e->spec();
  }
}

TEST(EffectLibrary, CoarserScalesAreSumsOfTheFinest) {
  const PoseTable table = rich_table();
  const EffectContext context{.table = &table, .offset_nT = {}};
  std::mt19937_64 rng(3);
  for (const EffectFamily& family : effect_families()) {
    if (family.level != Level::axis) continue;
    const EffectPtr finest = *make(family, Where{.scale = Where::Scale::each_axis}, std::nullopt, context);
    const EffectPtr all = *make(family, Where{.scale = Where::Scale::all}, std::nullopt, context);
    Point p = point_of(*finest, table.poses[20], table.poses[19], kNoMeans, rng);
    Point q = p;
    q.c.assign(all->at(p.sensor).size(), 0.7);
    p.c.assign(p.c.size(), 0.7);
    EXPECT_EQ(value(*finest, p), value(*all, q)) << family.name;
  }
}

TEST(EffectLibrary, SpecMakesTheSameEffectAgain) {
  const PoseTable table = rich_table();
  for (const EffectPtr& e : everything(table)) {
    const auto again = make_effect(e->spec());
    ASSERT_TRUE(again) << e->spec() << ": " << again.error().text();
    EXPECT_EQ((*again)->spec(), e->spec());
    ASSERT_EQ((*again)->coefficients().size(), e->coefficients().size()) << e->spec();
    for (std::size_t i = 0; i < e->coefficients().size(); ++i)
      EXPECT_EQ((*again)->coefficients()[i].name, e->coefficients()[i].name);
  }
}

TEST(EffectLibrary, NoSensorHasMoreCoefficientsThanThereAreSlots) {
  const PoseTable table = rich_table();
  for (const EffectPtr& e : everything(table)) {
    const Conditions at{table.poses[20], 0, nullptr, nullptr};
    for (int sensor = 0; sensor < kSensors; ++sensor)
      EXPECT_LE(e->active(at, sensor).size(), static_cast<std::size_t>(kMaxActive)) << e->spec();
  }
}

TEST(EffectLibrary, EveryFamilyHasAPage) {
  for (const EffectFamily& family : effect_families()) {
    const std::string page = effect_page(family);
    EXPECT_NE(page.find(family.equation.substr(0, 20)), std::string::npos);
    EXPECT_FALSE(family.cause.empty() || family.source.empty() || family.signature.empty()) << family.name;
    EXPECT_GT(family.typical, 0);
    EXPECT_GT(family.bound, family.typical) << family.name;
    EXPECT_EQ(family.untestable.empty() || !family.experiment.empty(), true) << family.name;
    for (const Confusion& c : family.confusions)
      EXPECT_NE(find_family(c.with), nullptr) << family.name << " is confused with " << c.with;
  }
  EXPECT_EQ(effects_json(effect_families())["effects"].size(), effect_families().size());
}

}  // namespace
}  // namespace mgtd::calib::effects::library
