// SPDX-License-Identifier: Apache-2.0
// The simulated rig and the library were written apart: every law of the library is planted by the rig's own
// physics, thirty Cramer-Rao sigmas large, and must be told by its name, be fitted with the number that was
// planted, sign and unit included, and leave nothing but noise.
#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "calib/criticism/search/explain.h"
#include "calib/effects/effect_spec.h"
#include "calib/effects/library/effect_family.h"
#include "calib/effects/library/library.h"
#include "calib/fit/method_choice/fit.h"
#include "calib/report/verdict_text.h"
#include "tests/blind/planted.h"

namespace mgtd::calib::criticism::search {
namespace {

using testing::Planted;
using testing::Stage;

constexpr std::uint64_t kSeed = 40;
constexpr std::array kAbsorbed{"platform.hard-iron", "platform.soft-iron", "platform.crosstalk"};

struct Expected {
  std::string name;  ///< of the coefficient
  double value{0};   ///< for the numbers as they stand in the row
  std::string unit;
  bool scales{true};  ///< with the size of the effect
};

struct Row {
  std::string title;
  Planted planted;
  std::string spec;  ///< the library's law, numbers that are searched as they were planted
  std::vector<Expected> coefficients;
  std::set<std::string> alike{};  ///< documented as inseparable from it in this run
  enum class Run { full, remounted, no_reference, patient, fine_table } run{Run::full};
  double sigmas{30};
};

Stage stage_of(Row::Run run) {
  Stage out = run == Row::Run::remounted ? testing::remounted_stage(kSeed) : testing::full_stage(kSeed);
  out.scenario.scalar = run != Row::Run::no_reference;
  if (run == Row::Run::patient) {
    out.scenario.table_velocity_deg_per_s = 3600;
    out.scenario.table_acceleration_deg_per_s2 = 36'000;
    for (rig::PlannedPose& pose : out.design.poses) pose.pause_s = 100;
  }
  if (run == Row::Run::fine_table || run == Row::Run::remounted) out.scenario.table_accuracy_deg = 0.002;
  return out;
}

std::vector<Row> temperature_and_time() {
  return {
      {"offset_temperature",
       {"axis.offset.temperature", "s2.x", {1}},
       "axis.offset.temperature@s2.x",
       {{"s2.x", 1, "nT/degC"}}},
      {"offset_temperature2",
       {"axis.offset.temperature2", "s3.y", {-1}},
       "axis.offset.temperature2@s3.y",
       {{"s3.y", -1, "nT/degC^2"}}},
      {"offset_drift", {"axis.offset.drift", "s4.z", {1}}, "axis.offset.drift@s4.z", {{"s4.z", 1, "nT/h"}}},
      {"offset_step",
       {"axis.offset.step", "s1.y", {-1, 900}},
       "axis.offset.step@s1.y,ts=0.25",
       {{"s1.y", -1, "nT"}}},
      {"gain_temperature",
       {"axis.gain.temperature", "s2.z", {10}},
       "axis.gain.temperature@s2.z",
       {{"s2.z", 10, "ppm/degC"}}},
      {"gain_temperature2",
       {"axis.gain.temperature2", "s1.x", {-10}},
       "axis.gain.temperature2@s1.x",
       {{"s1.x", -10, "ppm/degC^2"}}},
      {"gain_drift", {"axis.gain.drift", "s3.z", {100}}, "axis.gain.drift@s3.z", {{"s3.z", 100, "ppm/h"}}},
      {"orthogonality_temperature",
       {"axis.orthogonality.temperature", "s2.y", {3, -2}},
       "axis.orthogonality.temperature@s2.y",
       {{"s2.yx", 3, "arcsec/degC"}, {"s2.yz", -2, "arcsec/degC"}}},
      {"orthogonality_temperature2",
       {"axis.orthogonality.temperature2", "s4.x", {-1, 2}},
       "axis.orthogonality.temperature2@s4.x",
       {{"s4.xy", -1, "arcsec/degC^2"}, {"s4.xz", 2, "arcsec/degC^2"}}},
  };
}

std::vector<Row> nonlinearities() {
  return {
      {"gain_step",
       {"axis.gain.step", "s2.y", {-50, 25'000}},
       "axis.gain.step@s2.y,c=25000",
       {{"s2.y", -50, "ppm"}}},
      {"quadratic",
       {"axis.quadratic", "s3.x", {1}},
       "axis.quadratic@s3.x",
       {{"s3.x", 1, "nT"}},
       {"axis.transverse"}},
      {"cubic", {"axis.cubic", "s1.z", {-1}}, "axis.cubic@s1.z", {{"s1.z", -1, "nT"}}},
      {"transverse",
       {"axis.transverse", "s4.y", {2, 5}},
       "axis.transverse@s4.y",
       {{"s4.y.squares", 2, "nT"}, {"s4.y.product", 5, "nT"}},
       {"axis.quadratic"}},
      {"zero_crossing",
       {"axis.zero-crossing", "s3.y", {-1}},
       "axis.zero-crossing@s3.y",
       {{"s3.y", -1, "nT"}}},
      {"hysteresis",
       {"axis.hysteresis", "s1.x", {1, 0.15}},
       "axis.hysteresis@s1.x,w=0.15",
       {{"s1.x", 1, "nT"}}},
      {"settling",
       {"axis.settling", "s2.x", {-10, 20}},
       "axis.settling@s2.x,tau=20",
       {{"s2.x", -10, "nT"}},
       {},
       Row::Run::patient},
      {"settling_on_the_way",
       {"axis.settling", "s2.x", {-10, 5}},
       "axis.settling@s2.x,tau=5",
       {{"s2.x", -10, "nT"}},
       {"axis.hysteresis"}},
  };
}

std::vector<Row> platform_and_table() {
  return {
      {"current",
       {"platform.current", "s3", {3, -2, 1}, "motor_A"},
       "platform.current@s3,columns=motor_A",
       {{"s3.motor_A.x", 3, "nT/A"}, {"s3.motor_A.y", -2, "nT/A"}, {"s3.motor_A.z", 1, "nT/A"}}},
      {"thermal_bending",
       {"platform.thermal-bending", "s2", {4, -3, 2}},
       "platform.thermal-bending@s2",
       {{"s2.x", 4, "arcsec/degC"}, {"s2.y", -3, "arcsec/degC"}, {"s2.z", 2, "arcsec/degC"}}},
      {"flexure",
       {"platform.flexure", "s4", {0.01, 0, 0.005, 0, -0.01, 0, 0.004, 0.008, 0}},
       "platform.flexure@s4",
       {{"s4.xx", 0.01, "deg"},
        {"s4.xy", 0, "deg"},
        {"s4.xz", 0.005, "deg"},
        {"s4.yx", 0, "deg"},
        {"s4.yy", -0.01, "deg"},
        {"s4.yz", 0, "deg"},
        {"s4.zx", 0.004, "deg"},
        {"s4.zy", 0.008, "deg"},
        {"s4.zz", 0, "deg"}}},
      {"eccentricity",
       {"table.eccentricity", "all", {0.1, -0.05, 0.04, 0.08}},
       "table.eccentricity",
       {{"cos", 0.1, "deg"}, {"sin", -0.05, "deg"}, {"cos2", 0.04, "deg"}, {"sin2", 0.08, "deg"}}},
      {"angle_scale", {"table.angle-scale", "all", {-1000}}, "table.angle-scale", {{"kappa", -1000, "ppm"}}},
      {"backlash", {"table.backlash", "all", {0.1}}, "table.backlash", {{"beta", 0.1, "deg"}}},
  };
}

/// What is constant in the table's frame, in that of the platform, less the part in the offsets.
std::vector<Expected> seen_by_mounting(const Eigen::Vector3d& d_nT) {
  std::vector<Expected> out;
  const auto mounts = testing::remounted_stage(kSeed).design.mounts;
  for (std::size_t m = 1; m < mounts.size(); ++m) {
    const Eigen::Vector3d turned = mounts[m] * d_nT - mounts[0] * d_nT;
    for (int sensor = 1; sensor <= 4; ++sensor) {
      for (int a = 0; a < 3; ++a)
        out.push_back({"m" + std::to_string(m + 1) + ".s" + std::to_string(sensor) + "." + "xyz"[a],
                       sensor == 3 ? turned[a] : 0, "nT"});
    }
  }
  return out;
}

std::vector<Row> more_of_the_table() {
  // Of four numbers two turn the array on the table by a fixed angle: (x_cos - y_sin)/2 and (x_sin + y_cos)/2
  // are left.
  return {
      {"wobble",
       {"table.wobble", "all", {0.05, -0.02, 0.03, 0.04}},
       "table.wobble",
       {{"w1", (0.05 - 0.04) / 2, "deg"}, {"w2", (-0.02 + 0.03) / 2, "deg"}}},
      {"tabletop_magnet",
       {"platform.tabletop-magnet", "s3", {3, -2, 4}},
       "platform.tabletop-magnet",
       seen_by_mounting({3, -2, 4}),
       {},
       Row::Run::remounted},
  };
}

std::vector<Expected> five(const std::array<double, 5>& g, const std::string& unit) {
  return {{"Gxx", g[0], unit},
          {"Gyy", g[1], unit},
          {"Gxy", g[2], unit},
          {"Gxz", g[3], unit},
          {"Gyz", g[4], unit}};
}

/// A gradient that comes, and no field.
std::vector<Expected> step_of(const std::array<double, 5>& g) {
  std::vector<Expected> out{{"Bx", 0, "nT"}, {"By", 0, "nT"}, {"Bz", 0, "nT"}};
  for (Expected& e : five(g, "nT/m")) out.push_back(std::move(e));
  return out;
}

/// t in D cos(k pi t/D): - 4 D/pi^2 (cos 1 + cos 3/9 + cos 5/25 ...) and a constant, which is the field's.
std::vector<Expected> straight_line(const Eigen::Vector3d& nT_per_h) {
  const PoseTable run = testing::planted_run(testing::full_stage(kSeed), {}, kSeed);
  const double D_h = (*run.poses.back().t_s - *run.poses.front().t_s) / 3600;
  std::vector<Expected> out;
  for (int k = 1; k <= 3; ++k) {
    for (int i = 0; i < 3; ++i)
      out.push_back({"cos" + std::to_string(k) + "." + "xyz"[i],
                     k == 2 ? 0 : -4 * D_h / (std::numbers::pi * std::numbers::pi * k * k) * nT_per_h[i],
                     "nT"});
  }
  return out;
}

std::vector<Row> site() {
  return {
      {"gradient",
       {"site.gradient", "all", {20, -15, 10, -5, 8}},
       "site.gradient",
       five({20, -15, 10, -5, 8}, "nT/m"),
       {"site.step", "site.dipole"}},  // one that came in the first minutes; a magnet three metres away
      {"gradient_drift",
       {"site.gradient-drift", "all", {20, -15, 10, -5, 8}},
       "site.gradient-drift",
       five({20, -15, 10, -5, 8}, "nT/m/h")},
      {"gradient_step",
       {"site.gradient-step", "all", {20, -15, 10, -5, 8, 900}},
       "site.step,ts=0.25",
       step_of({20, -15, 10, -5, 8})},
      {"curvature",
       {"site.curvature", "all", {100, -50, 80, 40, -60, 30, 70}},
       "site.curvature",
       {{"Hxxx", 100, "nT/m^2"},
        {"Hxxy", -50, "nT/m^2"},
        {"Hxxz", 80, "nT/m^2"},
        {"Hxyy", 40, "nT/m^2"},
        {"Hxyz", -60, "nT/m^2"},
        {"Hyyy", 30, "nT/m^2"},
        {"Hyyz", 70, "nT/m^2"}}},
      {"dipole",
       {"site.dipole", "all", {0.2, -0.1, 0.3, 0.6, -0.3, 0.4}},
       "site.dipole,x=0.65,y=-0.25,z=0.4",
       {{"mx", 0.2, "A m^2"},
        {"my", -0.1, "A m^2"},
        {"mz", 0.3, "A m^2"},
        {"dx", -0.05, "m", false},
        {"dy", -0.05, "m", false},
        {"dz", 0, "m", false}},
       {},
       Row::Run::full,
       300},  // moment and place each must be told
      {"reference_error",
       {"site.reference-error", "all", {0, 5, -3, 4}},
       "site.reference-error",
       {{"kx", 5, "nT"},
        {"ky", -3, "nT"},
        {"kz", 4, "nT"},
        {"kxx", 0, "nT"},
        {"kyy", 0, "nT"},
        {"kxy", 0, "nT"},
        {"kxz", 0, "nT"},
        {"kyz", 0, "nT"}},
       {},
       Row::Run::fine_table},
      // With a scalar reference the strength is known: across the field (60 deg down, 5 deg to the west).
      {"field_drift",
       {"site.field-drift", "all", {10, -20, -8, 0, 0, 0}},
       "site.field-drift",
       straight_line({10, -20, -8}),
       {},
       Row::Run::fine_table},
      // Without one, the strength against the poses' common field.
      {"field_drift_alone",
       {"site.field-drift", "all", {10, -20, 15, 0, 0, 0}},
       "site.field-drift",
       straight_line({10, -20, 15}),
       {"axis.gain.drift"},
       Row::Run::no_reference},
  };
}

void PrintTo(const Row& row, std::ostream* out) { *out << row.title; }

std::string title_of(const ::testing::TestParamInfo<Row>& info) { return info.param.title; }

std::set<std::string> declared(const ExplainReport& r) {
  std::set<std::string> out(r.named.begin(), r.named.end());
  for (const Round& round : r.rounds) out.insert(round.possible.begin(), round.possible.end());
  return out;
}

std::vector<Row> all_rows() {
  std::vector<Row> out;
  for (auto& rows :
       {temperature_and_time(), nonlinearities(), platform_and_table(), more_of_the_table(), site()})
    out.insert(out.end(), rows.begin(), rows.end());
  return out;
}

TEST(TwoSides, HaveTheSameLaws) {
  std::set<std::string> library, rig, rows, planted;
  for (const effects::library::EffectFamily& family : effects::library::effect_families())
    if (family.untestable.empty()) library.insert(std::string(family.name));
  for (const rig::EffectKind* kind : rig::all_kinds())
    if (!kind->unnamed) rig.insert(kind->name);
  for (const char* absorbed : kAbsorbed) rig.erase(absorbed);
  for (const Row& row : all_rows()) {
    rows.insert(std::string(effects::family_name(row.spec)));
    planted.insert(row.planted.kind);
  }
  EXPECT_EQ(rows, library);
  EXPECT_EQ(planted, rig);
}

/// In a uniform field nothing tells them from offsets and matrices: no alarm, no claim, and the reason why.
TEST(TwoSides, WhatIsAbsorbedIsDeclaredUntestable) {
  const std::vector<Planted> absorbed{
      {"platform.hard-iron", "s2", {80, -50, 30}},
      {"platform.soft-iron", "s3", {2e-3, 0, 1e-3, 0, -1e-3, 0, 1e-3, 0, 5e-4}},
      {"platform.crosstalk", "all", {3.4e-6}}};
  for (const Planted& effect : absorbed) {
    const PoseTable run = testing::planted_run(testing::full_stage(kSeed), {effect}, kSeed);
    const auto told = explain(run, {});
    ASSERT_TRUE(told) << told.error().text();
    EXPECT_EQ(told->finding, Finding::pass) << effect.kind << ": " << report::sentence(*told);
    EXPECT_TRUE(
        std::any_of(told->untestable.begin(), told->untestable.end(),
                    [&](const tests::Untestable& u) { return u.effect == effect.kind && !u.why.empty(); }))
        << effect.kind;
  }
}

class Planting : public ::testing::TestWithParam<Row> {};

TEST_P(Planting, AgreeOnNameNumberSignAndUnit) {
  const Row& row = GetParam();
  const Stage stage = stage_of(row.run);
  const testing::Sized planted = testing::sized(stage, row.planted, row.sigmas, kSeed);
  const PoseTable run = testing::planted_run(stage, {planted.effect}, kSeed);

  ExplainOptions asked;
  if (!stage.scenario.scalar) asked.fit.field_nT = stage.scenario.f_nT;
  const auto told = explain(run, asked);
  ASSERT_TRUE(told) << told.error().text();
  const std::string family(effects::family_name(row.spec));
  const std::set<std::string> names = declared(*told);
  EXPECT_TRUE(names.contains(family)) << report::sentence(*told);
  for (const std::string& name : names)
    EXPECT_TRUE(name == family || row.alike.contains(name)) << name << ": " << report::sentence(*told);
  EXPECT_EQ(told->finding, names.size() > 1 ? Finding::ambiguous : Finding::explained)
      << report::sentence(*told);

  const auto effect = effects::library::make_effect(row.spec);
  ASSERT_TRUE(effect) << effect.error().text();
  fit::FitOptions options;
  options.effects = {*effect};
  if (!stage.scenario.scalar) options.field_nT = stage.scenario.f_nT;
  const auto fit = fit::method_choice::fit(run, options);
  ASSERT_TRUE(fit) << fit.error().text();
  EXPECT_NEAR(fit->chi2 / fit->dof, 1, 4 * std::sqrt(2 / fit->dof));
  const auto& found = fit->calibration.effects.front().coefficients;
  ASSERT_EQ(found.size(), row.coefficients.size());
  const auto m = static_cast<Eigen::Index>(found.size());
  Eigen::VectorXd off(m);
  for (std::size_t i = 0; i < found.size(); ++i) {
    const Expected& e = row.coefficients[i];
    const double truth = e.value * (e.scales ? planted.factor : 1);
    EXPECT_EQ(found[i].name, e.name);
    EXPECT_EQ(found[i].unit, e.unit);
    EXPECT_NEAR(found[i].value, truth, 5 * found[i].sd) << e.name << ", sd " << found[i].sd;
    off[static_cast<Eigen::Index>(i)] = found[i].value - truth;
  }
  // Together, where single ones are told badly: within four standard deviations of a length of m of them.
  const Eigen::MatrixXd covariance = fit->calibration.effect_covariance.rightCols(m);
  EXPECT_LT(std::sqrt(off.dot(covariance.ldlt().solve(off))), std::sqrt(m) + 4);
}

INSTANTIATE_TEST_SUITE_P(TwoSides, Planting, ::testing::ValuesIn(all_rows()), title_of);

}  // namespace
}  // namespace mgtd::calib::criticism::search
