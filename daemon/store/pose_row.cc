// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/pose_row.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

namespace mgtd::daemon::store {
namespace {

std::size_t slot(int index) { return static_cast<std::size_t>(index / 3); }
std::size_t axis(int index) { return static_cast<std::size_t>(index % 3); }

template <std::optional<double> Pose::*Member>
PoseColumn real(const char* name) {
  return {name, [](const Pose& p, int) { return p.*Member; }, [](Pose& p, int, double v) { p.*Member = v; }};
}

template <std::optional<int> Pose::*Member>
PoseColumn whole(const char* name) {
  return {name,
          [](const Pose& p, int) { return p.*Member ? std::optional<double>(*(p.*Member)) : std::nullopt; },
          [](Pose& p, int, double v) { p.*Member = static_cast<int>(std::lround(v)); }};
}

std::vector<PoseColumn> make(int sensors) {
  std::vector<PoseColumn> columns{real<&Pose::t_s>("t_s"),
                                  real<&Pose::azimuth_rad>("azimuth_rad"),
                                  real<&Pose::pitch_rad>("pitch_rad"),
                                  real<&Pose::roll_rad>("roll_rad"),
                                  real<&Pose::f_nT>("f_nT"),
                                  real<&Pose::f_sd_nT>("f_sd_nT"),
                                  real<&Pose::n>("n"),
                                  real<&Pose::n_eff>("n_eff"),
                                  whole<&Pose::mount>("mount"),
                                  whole<&Pose::sense>("sense"),
                                  real<&Pose::dwell_s>("dwell_s"),
                                  real<&Pose::since_stop_s>("since_stop_s")};
  for (int i = 0; i < 3 * sensors; ++i) {
    columns.push_back({fmt::format("s{}_{}_nT", i / 3 + 1, "xyz"[i % 3]),
                       [](const Pose& p, int at) { return std::optional<double>(p.y_nT[slot(at)][at % 3]); },
                       [](Pose& p, int at, double v) { p.y_nT[slot(at)][at % 3] = v; }, i, true});
  }
  for (int i = 0; i < 3 * sensors; ++i) {
    columns.push_back({fmt::format("s{}_sd_{}_nT", i / 3 + 1, "xyz"[i % 3]),
                       [](const Pose& p, int at) { return p.sd_nT[slot(at)][axis(at)]; },
                       [](Pose& p, int at, double v) { p.sd_nT[slot(at)][axis(at)] = v; }, i});
  }
  for (int i = 0; i < sensors; ++i) {
    columns.push_back({fmt::format("s{}_T_degC", i + 1),
                       [](const Pose& p, int at) { return p.T_degC[static_cast<std::size_t>(at)]; },
                       [](Pose& p, int at, double v) { p.T_degC[static_cast<std::size_t>(at)] = v; }, i});
  }
  return columns;
}

}  // namespace

std::span<const PoseColumn> pose_columns(std::size_t sensors) {
  static const auto columns = [] {
    std::array<std::vector<PoseColumn>, kMostSensors + 1> all;
    for (std::size_t n = 0; n < all.size(); ++n) all[n] = make(static_cast<int>(n));
    return all;
  }();
  return columns.at(sensors);
}

}  // namespace mgtd::daemon::store
