// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "calib/criticism/suspect.h"
#include "tests/unit/calib/fit/simulated_poses.h"

/// Runs with something hidden in them, and effects to suspect that share no code with the library.
namespace mgtd::calib::testing {

/// Added to the reading of axis `axis` of sensor `sensor`, whose field term is v (nT).
using Hidden = std::function<double(const Pose& pose, int sensor, int axis, const Eigen::Vector3d& v)>;

struct HiddenRun {
  double noise_nT{0.3};
  bool spreads{true};  ///< the table tells the noise
  double rho{0};       ///< of the noise from pose to pose
  Hidden hidden{};
  Eigen::Matrix3d G_nT_per_m{Eigen::Matrix3d::Zero()};
};

/// 36 level and 121 random poses of the Table 6 rig; temperatures go up and down over the run by 3 degrees.
inline PoseTable hidden_run(const HiddenRun& run, std::uint64_t seed) {
  Simulation sim{.noise_nT = 0, .table_sd_rad = to_rad(0.1), .f_sd_nT = 0.05, .f_drift_nT = 20};
  sim.G_nT_per_m = run.G_nT_per_m;
  PoseTable table = simulate(sim, 36, 121, seed);
  std::mt19937_64 rng(seed ^ 0x9e3779b97f4a7c15U);
  std::normal_distribution<double> normal;
  Eigen::Matrix<double, 12, 1> n = Eigen::Matrix<double, 12, 1>::NullaryExpr([&] { return normal(rng); });
  const double fresh = std::sqrt(1 - run.rho * run.rho);
  for (std::size_t k = 0; k < table.poses.size(); ++k) {
    Pose& pose = table.poses[k];
    const double phase = static_cast<double>(k) / static_cast<double>(table.poses.size());
    for (std::size_t i = 0; i < 4; ++i)
      pose.T_degC[i] = 21 + 3 * std::sin(5 * phase + 0.3 * static_cast<double>(i)) + 0.2 * normal(rng);
    for (int c = 0; c < 12; ++c) {
      const auto i = static_cast<std::size_t>(c / 3);
      n[c] = run.rho * n[c] + fresh * normal(rng);
      const Eigen::Vector3d v = pose.y_nT[i] - sim.rig[i].offset_nT;
      const double extra = run.hidden ? run.hidden(pose, c / 3, c % 3, v) : 0;
      pose.y_nT[i][c % 3] += extra + run.noise_nT * n[c];
      if (run.spreads) pose.sd_nT[i][static_cast<std::size_t>(c % 3)] = run.noise_nT;
    }
    if (run.spreads) pose.n = 1;
  }
  return table;
}

/// y += c f(pose, v, axis), one coefficient for each of the axes it is laid over.
class AxisLaw final : public EffectOf<AxisLaw> {
 public:
  using Shape = std::function<double(const Pose&, double t_h, int sensor, double v)>;
  /// `groups[axis]`: which coefficient acts on each of the twelve; -1 none.
  AxisLaw(std::string name, Shape shape, std::array<int, 12> groups, std::vector<std::string> names)
      : name_(std::move(name)), shape_(std::move(shape)), groups_(groups) {
    for (std::string& n : names) coefficients_.push_back({.name = std::move(n), .unit = "nT"});
    for (std::size_t c = 0; c < 12; ++c) {
      auto& at = at_[c / 3];
      const int g = groups_[c];
      if (g >= 0 && std::find(at.begin(), at.end(), g) == at.end()) at.push_back(g);
    }
  }
  static EffectPtr finest(const std::string& name, const Shape& shape) {
    std::vector<std::string> names;
    std::array<int, 12> groups{};
    for (int c = 0; c < 12; ++c) {
      names.push_back("s" + std::to_string(c / 3 + 1) + "." + "xyz"[c % 3]);
      groups[static_cast<std::size_t>(c)] = c;
    }
    return std::make_shared<const AxisLaw>(name, shape, groups, names);
  }
  [[nodiscard]] std::string_view name() const override { return name_; }
  [[nodiscard]] Level level() const override { return Level::axis; }
  [[nodiscard]] const std::vector<Coefficient>& coefficients() const override { return coefficients_; }
  [[nodiscard]] std::span<const int> at(int sensor) const override {
    return at_[static_cast<std::size_t>(sensor)];
  }
  [[nodiscard]] std::string_view missing(const Pose&) const override { return {}; }

  template <class S>
  void equation(const Conditions& at, int sensor, std::span<const S> v, std::span<const S> c,
                std::span<S> out) const {
    const auto& own = at_[static_cast<std::size_t>(sensor)];
    for (int a = 0; a < 3; ++a) {
      const auto axis = static_cast<std::size_t>(a);
      const int g = groups_[static_cast<std::size_t>(3 * sensor + a)];
      out[axis] = S(0.0);
      const auto slot = std::find(own.begin(), own.end(), g);
      if (g < 0) continue;
      out[axis] = c[static_cast<std::size_t>(slot - own.begin())] *
                  shape_(at.pose, at.t_h, sensor, value_of(v[axis]));
    }
  }

 private:
  std::string name_;
  Shape shape_;
  std::array<int, 12> groups_;
  std::vector<Coefficient> coefficients_;
  std::array<std::vector<int>, 4> at_;
};

inline Suspect suspect(const std::string& name, const AxisLaw::Shape& shape) {
  Suspect out{.name = name, .variants = {AxisLaw::finest(name, shape)}};
  out.hypotheses = hypotheses_of(*out.variants.front());
  out.make = [name, shape](const Hypothesis& h, std::size_t) -> Result<EffectPtr> {
    std::array<int, 12> groups{};
    for (Eigen::Index c = 0; c < 12; ++c) {
      Eigen::Index column = 0;
      groups[static_cast<std::size_t>(c)] =
          h.combine.row(c).maxCoeff(&column) > 0 ? static_cast<int>(column) : -1;
    }
    return std::make_shared<const AxisLaw>(name, shape, groups, h.names);
  };
  return out;
}

/// Five laws of an axis: two of temperature, one of time, two of the field.
inline std::vector<Suspect> few_suspects() {
  const auto warmer = [](const Pose& p, int i) { return *p.T_degC[static_cast<std::size_t>(i)] - 20; };
  return {
      suspect("offset.temperature", [warmer](const Pose& p, double, int i, double) { return warmer(p, i); }),
      suspect("gain.temperature",
              [warmer](const Pose& p, double, int i, double v) { return warmer(p, i) * v / 50'000; }),
      suspect("offset.drift", [](const Pose&, double t_h, int, double) { return t_h; }),
      suspect("quadratic", [](const Pose&, double, int, double v) { return std::pow(v / 50'000, 2); }),
      suspect("cubic", [](const Pose&, double, int, double v) { return std::pow(v / 50'000, 3); })};
}

}  // namespace mgtd::calib::testing
