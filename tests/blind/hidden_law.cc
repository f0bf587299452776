// SPDX-License-Identifier: Apache-2.0
#include "tests/blind/hidden_law.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

namespace mgtd::calib::testing {
namespace {

constexpr double kF0 = 50'000;
using V = Eigen::Vector3d;

double warmer(const Pose& p, int sensor) { return *p.T_degC[static_cast<std::size_t>(sensor)] - 20; }
double hours(const Pose& p) { return *p.t_s / 3600; }
double sign_of(double x) { return x > 0 ? 1 : -1; }

constexpr std::array kLaws{
    HiddenLaw{"axis.offset.temperature", "",
              [](const Pose& p, int s, int, const V&) { return warmer(p, s); }},
    HiddenLaw{"axis.offset.drift", "", [](const Pose& p, int, int, const V&) { return hours(p); }},
    HiddenLaw{"axis.offset.step", ",ts=0.754",
              [](const Pose& p, int, int, const V&) { return p.number > 90 ? 1.0 : 0.0; }},
    HiddenLaw{"axis.gain.temperature", "",
              [](const Pose& p, int s, int a, const V& v) { return 1e-6 * warmer(p, s) * v[a]; }},
    HiddenLaw{"axis.gain.drift", "",
              [](const Pose& p, int, int a, const V& v) { return 1e-6 * hours(p) * v[a]; }},
    HiddenLaw{"axis.cubic", "", [](const Pose&, int, int a, const V& v) { return std::pow(v[a] / kF0, 3); }},
    HiddenLaw{"axis.quadratic", "",
              [](const Pose&, int, int a, const V& v) { return std::pow(v[a] / kF0, 2); }},
    HiddenLaw{"axis.zero-crossing", "", [](const Pose&, int, int a, const V& v) { return sign_of(v[a]); }},
    HiddenLaw{"axis.gain.step", ",c=30000",
              [](const Pose&, int, int a, const V& v) { return std::abs(v[a]) > 30'000 ? 1e-6 * v[a] : 0; }},
    HiddenLaw{
        "axis.transverse", "",
        [](const Pose&, int, int a, const V& v) { return v[(a + 1) % 3] * v[(a + 2) % 3] / (kF0 * kF0); }},
};

constexpr std::array kUnlisted{
    HiddenLaw{"none: third harmonic of azimuth", "",
              [](const Pose& p, int, int, const V&) { return std::cos(3 * *p.azimuth_rad); }},
    HiddenLaw{"none: fourth power of the reading", "",
              [](const Pose&, int, int a, const V& v) { return std::pow(v[a] / kF0, 4); }},
    HiddenLaw{"none: oscillation in time", "",
              [](const Pose& p, int, int, const V&) { return std::sin(12 * hours(p)); }},
    HiddenLaw{"none: product with the hour", "",
              [](const Pose& p, int, int a, const V& v) {
                return std::sin(9 * hours(p)) * std::pow(v[a] / kF0, 2);
              }},
};

constexpr std::array kOneField{
    HiddenLaw{"axis.quadratic", "",
              [](const Pose&, int, int a, const V& v) { return std::pow(v[a] / kF0, 2); }},
    HiddenLaw{
        "axis.transverse", "",
        [](const Pose&, int, int a, const V& v) { return (v.squaredNorm() - v[a] * v[a]) / (kF0 * kF0); }},
};

}  // namespace

std::span<const HiddenLaw> one_field_laws() { return kOneField; }
std::span<const HiddenLaw> hidden_laws() { return kLaws; }
std::span<const HiddenLaw> unlisted_laws() { return kUnlisted; }

std::string spec_of(const HiddenLaw& law, int sensor, int axis) {
  return fmt::format("{}@s{}.{}{}", law.name, sensor + 1, "xyz"[axis], law.parameters);
}

Hidden hide(const HiddenLaw& law, int sensor, int axis, double size) {
  return [=](const Pose& p, int s, int a, const V& v) {
    return s == sensor && a == axis ? size * law.law(p, s, a, v) : 0;
  };
}

}  // namespace mgtd::calib::testing
