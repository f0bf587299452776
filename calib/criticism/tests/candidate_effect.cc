// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/candidate_effect.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>

#include "calib/effects/where.h"
#include "proto/number.h"

namespace mgtd::calib::criticism::tests {
namespace {

/// "s3.z.tau1" in parts; axis -1 for what belongs to no single axis.
struct NamedPlace {
  int sensor{-1}, axis{-1};
  std::string suffix;
};

NamedPlace place_of(const std::string& name) {
  NamedPlace out{.suffix = name};
  const std::size_t dot = name.find('.');
  if (dot == std::string::npos || dot + 1 >= name.size() || name.front() != 's') return out;
  const auto number = parse_integer(std::string_view(name).substr(1, dot - 1));
  if (!number || *number < 1 || *number > kMostSensors) return out;
  out.sensor = static_cast<int>(*number) - 1;
  const auto axis = std::string_view("xyz").find(name[dot + 1]);
  if (axis != std::string_view::npos) out.axis = static_cast<int>(axis);
  out.suffix = name.substr(out.axis < 0 ? dot + 1 : dot + 2);
  return out;
}

using Groups = std::map<std::string, std::vector<Eigen::Index>>;

/// One column per group: the sum of its members.
Hypothesis summed(std::string where, int axes, int alike, Eigen::Index finest, const Groups& groups) {
  Hypothesis out{.where = std::move(where),
                 .axes = axes,
                 .combine = Eigen::MatrixXd::Zero(finest, static_cast<Eigen::Index>(groups.size())),
                 .names = {},
                 .alike = alike};
  Eigen::Index j = 0;
  for (const auto& [name, members] : groups) {
    for (const Eigen::Index i : members) out.combine(i, j) = 1;
    out.names.push_back(name);
    ++j;
  }
  return out;
}

Hypothesis everything(const effects::Effect& effect, int sensors, std::string where) {
  const auto n = static_cast<Eigen::Index>(effect.coefficients().size());
  Hypothesis out{.where = std::move(where),
                 .axes = 3 * sensors,
                 .combine = Eigen::MatrixXd::Identity(n, n),
                 .names = {}};
  for (const effects::Coefficient& c : effect.coefficients()) out.names.push_back(c.name);
  return out;
}

/// An effect of site, table or platform as a whole and, where each sensor has coefficients of its own, sensor
/// by sensor.
std::vector<Hypothesis> whole_and_sensors(const effects::Effect& effect, int sensors) {
  const bool site = effect.level() == effects::Level::site || effect.level() == effects::Level::reference;
  std::vector<Hypothesis> out{
      everything(effect, sensors, site ? "site" : std::string(effects::to_string(effect.level())))};
  const auto& coefficients = effect.coefficients();
  const auto n = static_cast<Eigen::Index>(coefficients.size());
  PerSensor<Groups> sensor(static_cast<std::size_t>(sensors));
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::string& name = coefficients[static_cast<std::size_t>(i)].name;
    const NamedPlace p = place_of(name);
    if (p.sensor < 0 || sensors == 1) return out;
    sensor[static_cast<std::size_t>(p.sensor)][name].push_back(i);
  }
  for (std::size_t s = 0; s < sensor.size(); ++s) {
    if (!sensor[s].empty()) out.push_back(summed(fmt::format("s{}", s + 1), 3, sensors, n, sensor[s]));
  }
  return out;
}

}  // namespace

std::vector<Hypothesis> hypotheses_of(const effects::Effect& finest, int sensors) {
  if (finest.level() != effects::Level::axis) return whole_and_sensors(finest, sensors);
  const int channels = 3 * sensors;
  std::vector<Hypothesis> out{everything(finest, sensors, "each-axis")};
  const auto& coefficients = finest.coefficients();
  const auto n = static_cast<Eigen::Index>(coefficients.size());
  Groups all, each_sensor;
  PerSensor<Groups> sensor(static_cast<std::size_t>(sensors));
  std::vector<Groups> axis(static_cast<std::size_t>(channels));
  for (Eigen::Index i = 0; i < n; ++i) {
    const std::string& name = coefficients[static_cast<std::size_t>(i)].name;
    const NamedPlace p = place_of(name);
    if (p.sensor < 0 || p.axis < 0) return out;
    const auto s = static_cast<std::size_t>(p.sensor);
    const std::string of_sensor = fmt::format("s{}{}", p.sensor + 1, p.suffix);
    all["all" + p.suffix].push_back(i);
    each_sensor[of_sensor].push_back(i);
    sensor[s][of_sensor].push_back(i);
    axis[3 * s + static_cast<std::size_t>(p.axis)][name].push_back(i);
  }
  for (std::size_t a = 0; a < axis.size(); ++a) {
    out.push_back(summed(effects::axis_name(static_cast<int>(a) / 3, static_cast<int>(a) % 3), 1, channels, n,
                         axis[a]));
  }
  const bool alike = std::all_of(coefficients.begin(), coefficients.end(), [](const effects::Coefficient& c) {
    const std::size_t end = c.name.find('.') + 2;  // of the axis
    return c.name.size() == end || c.name[end] == '.';
  });
  if (!alike) return out;
  // Of one sensor these are the same as all.
  if (sensors > 1) out.push_back(summed("each-sensor", channels, 1, n, each_sensor));
  for (std::size_t s = 0; sensors > 1 && s < sensor.size(); ++s)
    out.push_back(summed(fmt::format("s{}", s + 1), 3, sensors, n, sensor[s]));
  out.push_back(summed("all", channels, 1, n, all));
  return out;
}

std::string spec_of(const CandidateEffect& candidate_effect, const Hypothesis& hypothesis,
                    std::size_t variant) {
  if (candidate_effect.dipole_at) return candidate_effect.variants[variant]->spec();
  std::string out = candidate_effect.name;
  const auto where = effects::Where::parse(hypothesis.where);
  if (where && where->scale != effects::Where::Scale::own) out += "@" + hypothesis.where;
  if (variant < candidate_effect.values.size() && candidate_effect.values[variant])
    out += fmt::format(",{}={:.6g}", candidate_effect.parameter, *candidate_effect.values[variant]);
  return out;
}

}  // namespace mgtd::calib::criticism::tests
