// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/derivative_check.h"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "calib/sensor/geometry.h"

namespace mgtd::calib::effects {
namespace {

constexpr double kTolerance = 0.05;  ///< of the largest derivative

struct Compared {
  int pose{0}, sensor{0};
  std::size_t input{0};
  double claimed{0}, difference{0};
};

double wide_step(Level level, std::size_t input) {
  if (level == Level::site) return 0.02;
  return input < 3 ? 500 : 0.02;
}

std::array<double, 6> inputs_at(const Effect& effect, const Pose& pose, int sensor) {
  const auto s = static_cast<std::size_t>(sensor);
  std::array<double, 6> out{0, 0, 0, 0.2, -0.3, 0.9};
  const Eigen::Vector3d from =
      effect.level() == Level::site ? Eigen::Vector3d(sensor::Geometry{}.positions_P_m()[s]) : pose.y_nT[s];
  for (std::size_t i = 0; i < 3; ++i) out[i] = from[static_cast<Eigen::Index>(i)];
  return out;
}

/// Every derivative at one pose and sensor, as claimed and as differences.
void compare(const Effect& effect, const Pose& pose, int sensor, std::vector<Compared>& out) {
  const auto n = static_cast<std::size_t>(inputs_of(effect.level()));
  const auto m = static_cast<std::size_t>(outputs_of(effect.level()));
  const auto active = effect.at(sensor);
  const Conditions at{.pose = pose, .t_h = pose.t_s.value_or(0) / 3600};
  std::array<double, 6> x = inputs_at(effect, pose, sensor);
  std::vector<double> c(active.size());
  for (std::size_t j = 0; j < c.size(); ++j)
    c[j] = effect.coefficients()[static_cast<std::size_t>(active[j])].typical;
  std::vector<Jet> in(n), coefficients(c.size()), value(m);
  for (std::size_t i = 0; i < n; ++i) in[i] = Jet::variable(x[i], static_cast<int>(i));
  for (std::size_t j = 0; j < c.size(); ++j) coefficients[j] = Jet::variable(c[j], static_cast<int>(n + j));
  effect.term(at, sensor, std::span<const Jet>(in), std::span<const Jet>(coefficients),
              std::span<Jet>(value));
  const auto sided = [&](double& slot, double by) {
    const double before = slot;
    std::vector<double> y(m);
    slot += by;
    effect.term(at, sensor, std::span<const double>(x.data(), n), std::span<const double>(c),
                std::span<double>(y));
    slot = before;
    return y;
  };
  for (std::size_t i = 0; i < n + c.size(); ++i) {
    double& slot = i < n ? x[i] : c[i - n];
    const double h = i < n ? wide_step(effect.level(), i) : 0.1 * slot;
    const auto above = sided(slot, h), below = sided(slot, -h);
    for (std::size_t o = 0; o < m; ++o)
      out.push_back({pose.number, sensor, i, value[o].d[static_cast<Eigen::Index>(i)],
                     (above[o] - below[o]) / (2 * h)});
  }
}

}  // namespace

Result<void> check_derivatives(const Effect& effect, const PoseTable& table) {
  std::vector<Compared> all;
  for (const Pose& pose : table.poses) {
    if (!effect.missing(pose).empty()) continue;
    for (int sensor = 0; sensor < static_cast<int>(pose.y_nT.size()); ++sensor)
      if (!effect.at(sensor).empty()) compare(effect, pose, sensor, all);
  }
  std::array<double, kJetSlots> largest{};
  for (const Compared& c : all)
    largest[c.input] = std::max({largest[c.input], std::abs(c.claimed), std::abs(c.difference)});
  const auto inputs = static_cast<std::size_t>(inputs_of(effect.level()));
  for (const Compared& c : all) {
    if (std::abs(c.claimed - c.difference) <= kTolerance * largest[c.input]) continue;
    return fail(
        ErrorCode::refused,
        fmt::format("{} does not change smoothly: at pose {}, s{}, its derivative by {} {} is {:.4g}, but "
                    "{:.4g} from one side to the other",
                    effect.name(), c.pose, c.sensor + 1, c.input < inputs ? "input" : "coefficient",
                    1 + (c.input < inputs ? c.input : c.input - inputs), c.claimed, c.difference),
        "write what jumps as a steep slope: tanh(u/1000) for sign(u), sqrt(u^2 + 1e6) for abs(u)");
  }
  return {};
}

}  // namespace mgtd::calib::effects
