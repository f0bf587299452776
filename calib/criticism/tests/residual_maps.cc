// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/residual_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <set>
#include <unordered_map>

#include "calib/criticism/tests/site_maps.h"
#include "calib/fit/joint/pose_model.h"
#include "calib/fit/joint/single_samples.h"
#include "calib/linear/parts.h"
#include "calib/poses/kept_columns.h"

namespace mgtd::calib::criticism::tests {
namespace {

struct Map {
  std::string name{};
  RowSource rows{};
  std::vector<Hypothesis> hypotheses{};  ///< all channels; each axis where the map is by channel
};
using Maps = std::vector<Map>;

constexpr int kPowers = 3;       ///< of the temperature
constexpr int kGainCosines = 4;  ///< a gain changes slowly

/// Values of the functions of a map at a pose for one channel; empty where the pose cannot feed it.
using ChannelFunctions = std::function<std::vector<double>(const fit::joint::JointPose& pose, int channel)>;
/// The same for all channels of a sensor.
using Functions = std::function<std::vector<double>(const fit::joint::JointPose& pose, int sensor)>;

Hypothesis picked(std::string where, int axes, int alike, Eigen::Index first, Eigen::Index count,
                  Eigen::Index total) {
  Hypothesis h{.where = std::move(where), .axes = axes, .combine = {}, .names = {}, .alike = alike};
  h.combine = Eigen::MatrixXd::Zero(total, count);
  h.combine.middleRows(first, count).setIdentity();
  return h;
}

/// The functions free in each channel. The source keeps a reference to the problem.
Map of_channels(const fit::joint::JointProblem& problem, std::string name, Eigen::Index m,
                ChannelFunctions functions) {
  const int channels = problem.channels();
  Map out{.name = std::move(name), .rows = {.columns = m * channels}};
  out.rows.of = [&problem, m, channels,
                 functions = std::move(functions)](std::span<const Eigen::Index> poses) {
    const Eigen::Index block = problem.pose_rows();
    Eigen::MatrixXd rows =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(poses.size()) * block, m * channels);
    Eigen::Index row = 0;
    for (const Eigen::Index k : poses) {
      const fit::joint::JointPose& pose = problem.poses[static_cast<std::size_t>(k)];
      for (int c = 0; c < channels; ++c) {
        const std::vector<double> values = functions(pose, c);
        for (std::size_t j = 0; j < values.size(); ++j)
          rows(row + c, c * m + static_cast<Eigen::Index>(j)) = pose.weight[c] * values[j];
      }
      row += block;
    }
    return rows;
  };
  out.hypotheses.push_back(picked("all", channels, 1, 0, m * channels, m * channels));
  for (int c = 0; c < channels; ++c) {
    out.hypotheses.push_back(picked(sensor::channel_name(c), 1, channels, c * m, m, m * channels));
  }
  return out;
}

Map by_channel(const fit::joint::JointProblem& problem, std::string name, Eigen::Index m,
               Functions functions) {
  return of_channels(problem, std::move(name), m,
                     [functions = std::move(functions)](const fit::joint::JointPose& pose, int c) {
                       return functions(pose, c / 3);
                     });
}

/// A covariate brought to [-1, 1] over the poses; not usable where it does not vary.
struct Range {
  double low{std::numeric_limits<double>::infinity()}, high{-low};
  void add(double x) { low = std::min(low, x), high = std::max(high, x); }
  [[nodiscard]] bool varies() const {
    return high - low > 1e-9 * (std::abs(high) + std::abs(low)) && high > low;
  }
  [[nodiscard]] double scaled(double x) const { return (2 * x - low - high) / (high - low); }
};

std::vector<double> powers(double x, int n) {
  std::vector<double> out;
  for (double p = x; n > 0; --n, p *= x) out.push_back(p);
  return out;
}

std::vector<double> cosines(double u, int n) {
  std::vector<double> out;
  for (int j = 1; j <= n; ++j) out.push_back(time_cosine(u, j));
  return out;
}

std::vector<double> times(double factor, std::vector<double> values) {
  for (double& v : values) v *= factor;
  return values;
}

Range range_of_times(const fit::joint::JointProblem& problem) {
  Range out;
  for (const fit::joint::JointPose& pose : problem.poses) out.add(pose.t_h);
  return out;
}

Range range_of_temperatures(const fit::joint::JointProblem& problem) {
  Range out;
  for (const fit::joint::JointPose& pose : problem.poses) {
    for (const auto& T : pose.pose->T_degC)
      if (T) out.add(*T);
  }
  return out;
}

void add_time(const fit::joint::JointProblem& problem, Maps& maps) {
  const Range range = range_of_times(problem);
  if (!range.varies()) return;
  maps.push_back(by_channel(problem, "time", kCosines, [range](const fit::joint::JointPose& pose, int) {
    return cosines(range.scaled(pose.t_h), kCosines);
  }));
}

void add_azimuth(const fit::joint::JointProblem& problem, Maps& maps) {
  constexpr int kHarmonics = 4;
  const bool any =
      std::any_of(problem.poses.begin(), problem.poses.end(),
                  [](const fit::joint::JointPose& p) { return p.pose->azimuth_rad.has_value(); });
  if (!any) return;
  maps.push_back(by_channel(problem, "azimuth", 2 * kHarmonics, [](const fit::joint::JointPose& pose, int) {
    std::vector<double> v;
    if (!pose.pose->azimuth_rad) return v;
    for (int j = 1; j <= kHarmonics; ++j) {
      v.push_back(std::cos(j * *pose.pose->azimuth_rad));
      v.push_back(std::sin(j * *pose.pose->azimuth_rad));
    }
    return v;
  }));
}

/// The readings that the functions of maps are of. Those of the dwells as they are; single samples as fitted:
/// their noise is in the residual too, of the sample itself and, where neighbours are correlated, of the one
/// before, and the two would agree for no other reason.
class Readings {
 public:
  Readings(const fit::joint::JointProblem& problem, const fit::joint::JointState& state) : state_(state) {
    if (!fit::joint::reads_single_samples(problem)) return;
    const fit::joint::PoseModel model(problem, state);
    fit::joint::PoseLinear at;
    for (std::size_t k = 0; k < problem.poses.size(); ++k) {
      model.linearise(problem.poses[k], state.nuisances[k], at);
      fitted_nT_.emplace(problem.poses[k].pose, at.y_nT);
    }
  }
  /// Direction of the reading as its sensor sees it, offset taken out.
  [[nodiscard]] Eigen::Vector3d direction(const fit::joint::JointPose& pose, int sensor) const {
    const auto fitted = fitted_nT_.find(pose.pose);
    const Eigen::Vector3d y_nT = fitted == fitted_nT_.end()
                                     ? Eigen::Vector3d(pose.y_nT.segment<3>(3 * sensor))
                                     : Eigen::Vector3d(fitted->second.segment<3>(3 * sensor));
    return (y_nT - state_.sensors[static_cast<std::size_t>(sensor)].offset_nT).normalized();
  }
  [[nodiscard]] Eigen::Vector3d before_nT(const fit::joint::JointPose& pose, int sensor) const {
    const auto fitted = fitted_nT_.find(pose.previous);
    if (fitted != fitted_nT_.end()) return fitted->second.segment<3>(3 * sensor);
    return pose.previous->y_nT[static_cast<std::size_t>(sensor)];
  }

 private:
  const fit::joint::JointState& state_;
  std::unordered_map<const Pose*, fit::joint::Channels> fitted_nT_;  ///< of single samples
};

/// Chebyshev polynomials of the axis' own part of the field.
void add_own_reading(const fit::joint::JointProblem& problem, const Readings& readings, Maps& maps) {
  constexpr int kFirst = 2, kLast = 6;
  maps.push_back(of_channels(problem, "own reading", kLast - kFirst + 1,
                             [&readings](const fit::joint::JointPose& pose, int c) {
                               const Eigen::Vector3d u = readings.direction(pose, c / 3);
                               std::vector<double> v;
                               for (int j = kFirst; j <= kLast; ++j)
                                 v.push_back(std::cos(j * std::acos(u[c % 3])));
                               return v;
                             }));
}

void add_direction(const fit::joint::JointProblem& problem, const Readings& readings, Maps& maps) {
  constexpr Eigen::Index kMonomials = 5 + 7 + 9;
  maps.push_back(
      by_channel(problem, "direction", kMonomials, [&readings](const fit::joint::JointPose& pose, int i) {
        const Eigen::Vector3d u = readings.direction(pose, i);
        std::vector<double> v;
        // z^2 = 1 - x^2 - y^2: higher powers of z are the others.
        for (int degree = 2; degree <= 4; ++degree) {
          for (int z = 0; z <= 1; ++z) {
            for (int x = 0; x <= degree - z; ++x)
              v.push_back(std::pow(u[0], x) * std::pow(u[1], degree - z - x) * (z == 1 ? u[2] : 1.0));
          }
        }
        return v;
      }));
}

void add_temperature(const fit::joint::JointProblem& problem, Maps& maps) {
  const Range range = range_of_temperatures(problem);
  if (!range.varies()) return;
  maps.push_back(
      by_channel(problem, "temperature", kPowers, [range](const fit::joint::JointPose& pose, int i) {
        const auto& T = pose.pose->T_degC[static_cast<std::size_t>(i)];
        return T ? powers(range.scaled(*T), kPowers) : std::vector<double>{};
      }));
}

/// The axis' own part of the field times functions of time and of temperature: a gain that changes.
void add_gain(const fit::joint::JointProblem& problem, const Readings& readings, Maps& maps) {
  const Range of_times = range_of_times(problem), of_temperatures = range_of_temperatures(problem);
  const auto own = [&readings](const fit::joint::JointPose& pose, int c) {
    return readings.direction(pose, c / 3)[c % 3];
  };
  if (of_times.varies()) {
    maps.push_back(of_channels(problem, "own reading x time", kGainCosines,
                               [own, of_times](const fit::joint::JointPose& pose, int c) {
                                 return times(own(pose, c), cosines(of_times.scaled(pose.t_h), kGainCosines));
                               }));
  }
  if (!of_temperatures.varies()) return;
  maps.push_back(of_channels(problem, "own reading x temperature", kPowers,
                             [own, of_temperatures](const fit::joint::JointPose& pose, int c) {
                               const auto& T = pose.pose->T_degC[static_cast<std::size_t>(c / 3)];
                               return T ? times(own(pose, c), powers(of_temperatures.scaled(*T), kPowers))
                                        : std::vector<double>{};
                             }));
}

void add_previous(const fit::joint::JointProblem& problem, const Readings& readings, Maps& maps) {
  maps.push_back(
      by_channel(problem, "previous pose", 3, [&readings](const fit::joint::JointPose& pose, int i) {
        std::vector<double> v;
        if (pose.previous == nullptr) return v;
        const Eigen::Vector3d y = readings.before_nT(pose, i);
        const double size = pose.y_nT.segment<3>(3 * i).norm();
        for (int a = 0; a < 3; ++a) v.push_back(std::isfinite(y[a]) ? y[a] / size : 0);
        return v;
      }));
}

void add_mount(const fit::joint::JointProblem& problem, Maps& maps) {
  std::set<int> mounts;
  for (const fit::joint::JointPose& pose : problem.poses)
    if (pose.pose->mount) mounts.insert(*pose.pose->mount);
  if (mounts.size() < 2) return;
  maps.push_back(by_channel(problem, "mount", static_cast<Eigen::Index>(mounts.size()),
                            [mounts](const fit::joint::JointPose& pose, int) {
                              std::vector<double> v;
                              for (const int m : mounts) v.push_back(pose.pose->mount == m ? 1 : 0);
                              return v;
                            }));
}

void add_columns(const fit::joint::JointProblem& problem, Maps& maps) {
  std::map<std::string, Range> columns;
  for (const fit::joint::JointPose& pose : problem.poses) {
    for (const auto& [name, value] : pose.pose->covariates)
      if (!poses::never_fitted(name)) columns[name].add(value);
  }
  for (const auto& [name, range] : columns) {
    if (!range.varies()) continue;
    maps.push_back(
        by_channel(problem, name, 2, [name = name, range = range](const fit::joint::JointPose& pose, int) {
          const auto found = pose.pose->covariates.find(name);
          return found == pose.pose->covariates.end() ? std::vector<double>{}
                                                      : powers(range.scaled(found->second), 2);
        }));
  }
}

/// `readings` must outlive what comes back.
Maps maps_of(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
             const Readings& readings) {
  Maps maps;
  add_time(problem, maps);
  add_azimuth(problem, maps);
  add_own_reading(problem, readings, maps);
  add_direction(problem, readings, maps);
  add_temperature(problem, maps);
  add_gain(problem, readings, maps);
  add_previous(problem, readings, maps);
  add_mount(problem, maps);
  add_columns(problem, maps);
  for (SiteRows& site : site_map_rows(problem, state)) {
    const Eigen::Index m = site.rows.columns;
    maps.push_back({.name = std::move(site.name),
                    .rows = std::move(site.rows),
                    .hypotheses = {picked("site", problem.channels(), 1, 0, m, m)}});
  }
  return maps;
}

/// Empty where nothing of the map is left after the model's own parameters.
std::optional<MapScore> score_of(const Map& map, const Residual& residual, const NoiseReference& noise) {
  const Signature s(residual, map.rows);
  MapScore best{.map = map.name,
                .where = {},
                .log10_p = 1,
                .by_channel = std::vector<double>(static_cast<std::size_t>(residual.channels())),
                .fit = {}};
  double scales = 0;
  Eigen::VectorXd shown;  // coefficients of what the best explains
  for (const Hypothesis& h : map.hypotheses) {
    scales += 1.0 / h.alike;
    const Eigen::MatrixXd basis = orthonormal_combinations(s, h);
    const auto k = static_cast<int>(basis.cols());
    if (k == 0) continue;
    const Eigen::VectorXd t = basis.transpose() * s.by_residual();
    const double own = noise.log10_p(t.squaredNorm(), k, h.axes), log10_p = own + std::log10(h.alike);
    if (h.alike > 1) best.by_channel.at(static_cast<std::size_t>(&h - &map.hypotheses[1])) = own;
    if (log10_p >= best.log10_p) continue;
    best.where = h.where, best.S = t.squaredNorm(), best.k = k, best.log10_p = log10_p;
    shown = basis * t;
  }
  if (best.k == 0) return std::nullopt;
  best.fit = s.times(shown);
  best.log10_p = std::min(0.0, best.log10_p + std::log10(scales));
  return best;
}

}  // namespace

std::vector<MapScore> score_maps(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
                                 const Residual& residual, const NoiseReference& noise) {
  const Readings readings(problem, state);
  const Maps maps = maps_of(problem, state, readings);
  std::vector<std::optional<MapScore>> scores(maps.size());
  linear::for_each_part(maps.size(), [&](std::size_t i) { scores[i] = score_of(maps[i], residual, noise); });
  std::vector<MapScore> out;
  for (std::optional<MapScore>& score : scores)
    if (score) out.push_back(*std::move(score));
  std::sort(out.begin(), out.end(),
            [](const MapScore& a, const MapScore& b) { return a.log10_p < b.log10_p; });
  return out;
}

}  // namespace mgtd::calib::criticism::tests
