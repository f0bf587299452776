// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "calib/effects/library/library.h"
#include "calib/fit/joint/joint_fit.h"
#include "tests/support/parameter_name.h"
#include "tests/unit/calib/effects/effect_scene.h"

/// Every effect put into a run by equations written here, and found again by the fit: the coefficient within
/// its uncertainty, the chi-square back at one.
namespace mgtd::calib::effects {
namespace {

using Eigen::Vector3d;
using testing::Injection;
using testing::Scene;

constexpr double kF0 = 50'000, kT0 = 20, kArcsec = 4.84813681109536e-6, kDeg = 0.0174532925199433;

struct Case {
  std::string spec;
  Injection in;
  std::vector<double> truth;  ///< of the coefficients, in their order
  Scene scene{};
};

double T(const Pose& pose, int sensor) { return *pose.T_degC[static_cast<std::size_t>(sensor)]; }
double hours(const Pose& pose) { return *pose.t_s / 3600; }

/// `law` on sensor 3, axis z.
Injection on_s3z(std::function<double(const Pose&, const Vector3d& v, const Vector3d* before)> law) {
  return {.axis = [law](const Pose& pose, int sensor, int axis, const Vector3d& v, const Vector3d* before) {
    return sensor == 2 && axis == 2 ? law(pose, v, before) : 0.0;
  }};
}

std::vector<Case> axis_cases() {
  std::vector<Case> out;
  const auto add = [&](const char* spec, Injection in, std::vector<double> truth) {
    out.push_back({spec, std::move(in), std::move(truth)});
  };
  add("axis.offset.temperature@s3.z",
      on_s3z([](const Pose& p, const Vector3d&, const Vector3d*) { return 0.4 * (T(p, 2) - kT0); }), {0.4});
  add("axis.offset.temperature2@s3.z", on_s3z([](const Pose& p, const Vector3d&, const Vector3d*) {
        return 0.05 * std::pow(T(p, 2) - kT0, 2);
      }),
      {0.05});
  add("axis.offset.drift@s3.z",
      on_s3z([](const Pose& p, const Vector3d&, const Vector3d*) { return 2 * hours(p); }), {2});
  add("axis.offset.step@s3.z,ts=1.01",
      on_s3z([](const Pose& p, const Vector3d&, const Vector3d*) { return hours(p) > 1.01 ? 1.5 : 0; }),
      {1.5});
  add("axis.gain.temperature@s3.z", on_s3z([](const Pose& p, const Vector3d& v, const Vector3d*) {
        return 15e-6 * (T(p, 2) - kT0) * v[2];
      }),
      {15});
  add("axis.gain.temperature2@s3.z", on_s3z([](const Pose& p, const Vector3d& v, const Vector3d*) {
        return 2e-6 * std::pow(T(p, 2) - kT0, 2) * v[2];
      }),
      {2});
  add("axis.gain.drift@s3.z",
      on_s3z([](const Pose& p, const Vector3d& v, const Vector3d*) { return 30e-6 * hours(p) * v[2]; }),
      {30});
  add("axis.gain.step@s3.z,c=20000", on_s3z([](const Pose&, const Vector3d& v, const Vector3d*) {
        return std::abs(v[2]) > 20000 ? 60e-6 * v[2] : 0;
      }),
      {60});
  add("axis.orthogonality.temperature@s3.z", on_s3z([](const Pose& p, const Vector3d& v, const Vector3d*) {
        return (T(p, 2) - kT0) * kArcsec * (3 * v[0] - 2 * v[1]);
      }),
      {3, -2});
  add("axis.orthogonality.temperature2@s3.z", on_s3z([](const Pose& p, const Vector3d& v, const Vector3d*) {
        return std::pow(T(p, 2) - kT0, 2) * kArcsec * (0.5 * v[0] - 0.3 * v[1]);
      }),
      {0.5, -0.3});
  out.push_back({"axis.offset.temperature",
                 {.axis = [](const Pose& p, int sensor, int axis, const Vector3d&,
                             const Vector3d*) { return 0.1 * (sensor - axis) * (T(p, sensor) - kT0); }},
                 {0, -0.1, -0.2, 0.1, 0, -0.1, 0.2, 0.1, 0, 0.3, 0.2, 0.1}});
  out.push_back(
      {"axis.gain.temperature@each-sensor",
       {.axis = [](const Pose& p, int sensor, int axis, const Vector3d& v,
                   const Vector3d*) { return 5e-6 * (sensor + 1) * (T(p, sensor) - kT0) * v[axis]; }},
       {5, 10, 15, 20}});
  out.push_back({"axis.cubic@all",
                 {.axis = [](const Pose&, int, int axis, const Vector3d& v,
                             const Vector3d*) { return 5 * std::pow(v[axis] / kF0, 3); }},
                 {5}});
  add("axis.quadratic@s3.z",
      on_s3z([](const Pose&, const Vector3d& v, const Vector3d*) { return 4 * std::pow(v[2] / kF0, 2); }),
      {4});
  add("axis.cubic@s3.z",
      on_s3z([](const Pose&, const Vector3d& v, const Vector3d*) { return 6 * std::pow(v[2] / kF0, 3); }),
      {6});
  add("axis.transverse@s3.z", on_s3z([](const Pose&, const Vector3d& v, const Vector3d*) {
        return 4 * (v[0] * v[0] + v[1] * v[1]) / (kF0 * kF0) - 5 * v[0] * v[1] / (kF0 * kF0);
      }),
      {4, -5});
  add("axis.zero-crossing@s3.z",
      on_s3z([](const Pose&, const Vector3d& v, const Vector3d*) { return v[2] > 0 ? 1.5 : -1.5; }), {1.5});
  const auto p = std::make_shared<double>(0);
  add("axis.hysteresis@s3.z,w=0.2", on_s3z([p](const Pose&, const Vector3d& v, const Vector3d* before) {
        if (before == nullptr) *p = 0;
        const double x = v[2] / kF0;
        if (*p < x - 0.2) *p = x - 0.2;
        if (*p > x + 0.2) *p = x + 0.2;
        return 2 * (*p - x) / 0.2;
      }),
      {2});
  add("axis.settling@s3.z,tau=15", on_s3z([](const Pose& q, const Vector3d& v, const Vector3d* before) {
        return before == nullptr ? 0.0 : 4 * ((*before)[2] - v[2]) / kF0 * std::exp(-*q.since_stop_s / 15);
      }),
      {4});
  return out;
}

Vector3d turned(const Vector3d& omega, const Vector3d& b) {
  if (omega.norm() == 0) return b;
  return Eigen::AngleAxisd(-omega.norm(), omega.normalized()) * b;
}

std::vector<Case> platform_cases() {
  std::vector<Case> out;
  out.push_back({"platform.current@s2",
                 {.platform = [](const Pose& p, int sensor, const Vector3d& b, const Vector3d&) -> Vector3d {
                   return b + (sensor == 1 ? p.covariates.at("motor_A") : 0) * Vector3d(3, -2, 1);
                 }},
                 {3, -2, 1}});
  Eigen::Matrix3d S;
  S << 0.02, 0, 0, 0, -0.01, 0.005, 0, 0.01, 0;
  out.push_back({"platform.flexure@s2",
                 {.platform = [S](const Pose&, int sensor, const Vector3d& b, const Vector3d& g) -> Vector3d {
                   return sensor == 1 ? turned(kDeg * S * g, b) : b;
                 }},
                 {0.02, 0, 0, 0, -0.01, 0.005, 0, 0.01, 0}});
  out.push_back({"platform.flexure",
                 {.platform = [S](const Pose&, int sensor, const Vector3d& b, const Vector3d& g) -> Vector3d {
                   return turned((sensor - 1.5) * kDeg * S * g, b);
                 }},
                 {}});
  for (int sensor = 0; sensor < 4; ++sensor) {
    for (int k = 0; k < 9; ++k) out.back().truth.push_back((sensor - 1.5) * S(k / 3, k % 3));
  }
  out.push_back({"platform.thermal-bending",
                 {.platform = [](const Pose& p, int sensor, const Vector3d& b, const Vector3d&) -> Vector3d {
                   return turned((sensor - 1.5) * kArcsec * (T(p, sensor) - kT0) * Vector3d(4, -3, 2), b);
                 }},
                 {-6, 4.5, -3, -2, 1.5, -1, 2, -1.5, 1, 6, -4.5, 3}});
  out.push_back({"platform.thermal-bending@s2",
                 {.platform = [](const Pose& p, int sensor, const Vector3d& b, const Vector3d&) -> Vector3d {
                   return sensor == 1 ? turned(kArcsec * (T(p, 1) - kT0) * Vector3d(4, -3, 2), b) : b;
                 }},
                 {4, -3, 2}});
  out.push_back({"platform.current",
                 {.platform = [](const Pose& p, int sensor, const Vector3d& b, const Vector3d&) -> Vector3d {
                   return b + (sensor + 1) * p.covariates.at("motor_A") * Vector3d(3, -2, 1);
                 }},
                 {3, -2, 1, 6, -4, 2, 9, -6, 3, 12, -8, 4}});
  Case magnet{"platform.tabletop-magnet",
              {.platform = [](const Pose& p, int sensor, const Vector3d& b, const Vector3d&) -> Vector3d {
                return b + (*p.mount - 1) * (sensor + 1) * Vector3d(2, -1, 3);
              }},
              {}};
  for (int mount = 2; mount <= 3; ++mount) {
    for (int sensor = 1; sensor <= 4; ++sensor) {
      for (const double d : {2.0, -1.0, 3.0}) magnet.truth.push_back((mount - 1) * sensor * d);
    }
  }
  out.push_back(magnet);
  return out;
}

/// Recorded angles through a true turn of the table.
Injection table_turn(std::function<TableAngles(const Pose&)> truth) {
  return {.attitude = [truth](const Pose& p) { return testing::attitude(truth(p)); }};
}

std::vector<Case> table_cases() {
  std::vector<Case> out;
  out.push_back({"table.eccentricity",
                 table_turn([](const Pose& p) {
                   const double a = *p.azimuth_rad;
                   return TableAngles{a + kDeg * (0.1 * std::cos(a) - 0.05 * std::sin(a) +
                                                  0.04 * std::cos(2 * a) + 0.08 * std::sin(2 * a)),
                                      *p.pitch_rad, *p.roll_rad};
                 }),
                 {0.1, -0.05, 0.04, 0.08}});
  out.push_back({"table.angle-scale",
                 table_turn([](const Pose& p) {
                   return TableAngles{*p.azimuth_rad * (1 + 2000e-6), *p.pitch_rad, *p.roll_rad};
                 }),
                 {2000}});
  out.push_back({"table.backlash",
                 table_turn([](const Pose& p) {
                   return TableAngles{*p.azimuth_rad + kDeg * 0.1 * *p.sense, *p.pitch_rad, *p.roll_rad};
                 }),
                 {0.1}});
  out.push_back({"table.wobble",
                 {.attitude = [](const Pose& p) -> Eigen::Matrix3d {
                   const double c = std::cos(*p.azimuth_rad), s = std::sin(*p.azimuth_rad);
                   const Vector3d tilt = kDeg * Vector3d(0.1 * c - 0.06 * s, -0.06 * c - 0.1 * s, 0);
                   return testing::passive(*p.azimuth_rad, 2) *
                          Eigen::AngleAxisd(-tilt.norm(), tilt.normalized()) *
                          testing::passive(*p.pitch_rad, 1) * testing::passive(*p.roll_rad, 0);
                 }},
                 {0.1, -0.06}});
  return out;
}

std::vector<Case> site_cases() {
  std::vector<Case> out;
  out.push_back({"site.gradient",
                 {.site = [](double, const Vector3d& x) -> Vector3d { return testing::gradient_50() * x; }},
                 {30, -45, -20, 50, 10}});
  // The curvature is the gradient of a cubic harmonic: 100 (x^3 - 3 x y^2)/6 + 60 x y z.
  out.push_back({"site.curvature",
                 {.site = [](double, const Vector3d& r) -> Vector3d {
                   const double x = r[0], y = r[1], z = r[2];
                   return 100 * Vector3d((x * x - y * y) / 2, -x * y, 0) + 60 * Vector3d(y * z, x * z, x * y);
                 }},
                 {100, 0, 0, -100, 60, 0, 0}});
  const Vector3d place(0.9, 0.1, 0.5), moment(0.2, -0.1, 0.3);
  out.push_back({"site.dipole,x=1,y=0,z=0.6",
                 {.site = [=](double, const Vector3d& x) -> Vector3d {
                   const Vector3d d = x - place;
                   const double r = d.norm();
                   return 100 * (3 * moment.dot(d) * d / std::pow(r, 5) - moment / std::pow(r, 3));
                 }},
                 {0.2, -0.1, 0.3, -0.1, 0.1, -0.1}});
  out.push_back(
      {"site.gradient-drift",
       {.site = [](double t, const Vector3d& x) -> Vector3d { return 0.4 * t * testing::gradient_50() * x; }},
       {12, -18, -8, 20, 4}});
  out.push_back({"site.gradient-drift,ts=1.01",
                 {.site = [](double t, const Vector3d& x) -> Vector3d {
                   return (t > 1.01 ? 0.4 : 0) * testing::gradient_50() * x;
                 }},
                 {12, -18, -8, 20, 4}});
  // Without a scalar reference the drift along the field is seen too.
  Scene alone;
  alone.with_f = false;
  out.push_back({"site.step,ts=1.01",
                 {.site = [](double t, const Vector3d& x) -> Vector3d {
                   if (t <= 1.01) return Vector3d::Zero();
                   return Vector3d(40, -30, 25) + 0.4 * testing::gradient_50() * x;
                 }},
                 {40, -30, 25, 12, -18, -8, 20, 4},
                 alone});
  out.push_back({"site.step,ts=1.01,x=1,y=0,z=0.6",
                 {.site = [=](double t, const Vector3d& x) -> Vector3d {
                   const Vector3d d = x - place;
                   const double r = d.norm();
                   if (t <= 1.01) return Vector3d::Zero();
                   return 100 * (3 * moment.dot(d) * d / std::pow(r, 5) - moment / std::pow(r, 3));
                 }},
                 {0.2, -0.1, 0.3, -0.1, 0.1, -0.1}});
  out.push_back({"site.field-drift",
                 {.site = [](double t, const Vector3d&) -> Vector3d {
                   const double phase = 3.14159265358979 * t / (156.0 / 60);
                   return std::cos(phase) * Vector3d(8, -30, 12) + std::cos(3 * phase) * Vector3d(0, 20, 5);
                 }},
                 {8, -30, 12, 0, 0, 0, 0, 20, 5},
                 alone});
  out.push_back({"site.reference-error",
                 {.reference =
                      [](const Pose&, const Vector3d& u) {
                        return 20 * u[0] - 10 * u[2] + 30 * (u[0] * u[0] - u[2] * u[2]);
                      }},
                 {20, 0, -10, 30, 0, 0, 0, 0}});
  return out;
}

fit::joint::JointOptions with(const std::string& spec, const Scene& scene) {
  fit::joint::JointOptions options;
  if (!scene.with_f) options.field_nT = scene.f_nT;
  options.table_sd_rad = to_rad(0.02);
  if (!spec.empty()) options.effects = {*library::make_effect(spec)};
  return options;
}

/// With a scalar reference the part of a step along the field is in each pose's own strength: the turn of the
/// field and the gradient are found as well as without it, and what is absorbed stays at zero within its
/// prior.
TEST(SiteStep, BesideAScalarReferenceTellsWhatLiesAcrossTheField) {
  const Scene scene;
  const Vector3d step(40, -30, 25), along = scene.direction * scene.direction.dot(step);
  const PoseTable table = testing::run_with({.site = [&](double t, const Vector3d& x) -> Vector3d {
                                              if (t <= 1.01) return Vector3d::Zero();
                                              return step + 0.4 * testing::gradient_50() * x;
                                            }},
                                            scene, 1);
  const auto fit = fit::joint::fit_joint(table, with("site.step,ts=1.01", scene));
  ASSERT_TRUE(fit) << fit.error().text();
  EXPECT_NEAR(fit->chi2 / fit->dof, 1, 3.5 * std::sqrt(2 / fit->dof));
  const Vector3d found = fit->state.coefficients.head<3>();
  const Eigen::Matrix3d C =
      fit->covariance.block<3, 3>(fit::joint::FixedSlots{}.effects(), fit::joint::FixedSlots{}.effects());
  const Vector3d n = scene.direction;
  EXPECT_GT(std::sqrt(n.dot(C * n)), 900) << "along the field only the prior of 1000 nT is known";
  EXPECT_LT(std::abs(n.dot(found)), 1);
  const Vector3d across = found - n * n.dot(found) - (step - along);
  for (const Vector3d& e : {Vector3d(0, 1, 0), Vector3d(n.cross(Vector3d(0, 1, 0)))}) {
    const double sd = std::sqrt(e.dot(C * e));
    EXPECT_LT(sd, 10);
    EXPECT_LT(std::abs(e.dot(across)), 4 * sd);
  }
}

class Injected : public ::testing::TestWithParam<Case> {};

TEST_P(Injected, IsFoundWithinItsUncertainty) {
  const Case& c = GetParam();
  double pulls = 0, worst = 0;
  int count = 0;
  constexpr int kSeeds = 3;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const PoseTable table = testing::run_with(c.in, c.scene, seed);
    const auto without = fit::joint::fit_joint(table, with("", c.scene));
    const auto fit = fit::joint::fit_joint(table, with(c.spec, c.scene));
    ASSERT_TRUE(without && fit) << (fit ? "" : fit.error().text());
    // Three and a half standard deviations of a chi-square, twice the tail of three seeds of all cases.
    EXPECT_NEAR(fit->chi2 / fit->dof, 1, 3.5 * std::sqrt(2 / fit->dof)) << c.spec;
    const double gain = without->chi2 + without->chi2_table - fit->chi2 - fit->chi2_table;
    // Wrong angles of the table are taken for a worse table, and the heading error of a reference for offsets
    // and matrices common to the sensors: there the chi-square falls little, the coefficients are right all
    // the same.
    const Level level = fit->problem.effects.front()->level();
    if (level != Level::table && level != Level::reference) {
      EXPECT_GT(gain, 50) << c.spec << ": too small to try the fit";
    }
    ASSERT_EQ(fit->state.coefficients.size(), static_cast<Eigen::Index>(c.truth.size()));
    for (Eigen::Index i = 0; i < fit->state.coefficients.size(); ++i) {
      const double sd = std::sqrt(
          fit->covariance(fit::joint::FixedSlots{}.effects() + i, fit::joint::FixedSlots{}.effects() + i));
      const double pull = (fit->state.coefficients[i] - c.truth[static_cast<std::size_t>(i)]) / sd;
      pulls += pull * pull;
      worst = std::max(worst, std::abs(pull));
      ++count;
    }
  }
  EXPECT_LT(worst, 4.5) << c.spec;
  EXPECT_LT(pulls / count, 1 + 4 * std::sqrt(2.0 / count)) << c.spec;
}

std::string name_of(const ::testing::TestParamInfo<Case>& info) {
  return mgtd::testing::parameter_name(info.param.spec);
}

INSTANTIATE_TEST_SUITE_P(Axis, Injected, ::testing::ValuesIn(axis_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(Platform, Injected, ::testing::ValuesIn(platform_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(Table, Injected, ::testing::ValuesIn(table_cases()), name_of);
INSTANTIATE_TEST_SUITE_P(Site, Injected, ::testing::ValuesIn(site_cases()), name_of);

}  // namespace
}  // namespace mgtd::calib::effects
