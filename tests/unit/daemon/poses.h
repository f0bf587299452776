// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

#include "proto/pose.h"

namespace mgtd::test {

/// A pose with every field filled, all values different and none a round binary number.
inline Pose full_pose(int number) {
  Pose p;
  double v = number + 0.1;
  const auto next = [&] { return v = std::nextafter(v * 1.07, 1e9); };
  p.number = number;
  p.set = number % 2 == 0 ? "random" : "standard";
  p.t_s = next();
  p.t_utc = WallTime{1'795'255'200'123'456'789 + number};
  p.azimuth_rad = next();
  p.pitch_rad = -next();
  p.roll_rad = next();
  p.f_nT = next();
  p.f_sd_nT = next();
  p.n = 250;
  p.n_eff = next();
  for (auto& y : p.y_nT) y = {next(), -next(), next()};
  for (auto& sensor : p.sd_nT) {
    for (auto& sd : sensor) sd = next();
  }
  p.mount = 2;
  p.sense = -1;
  p.dwell_s = next();
  p.since_stop_s = next();
  for (auto& T : p.T_degC) T = next();
  p.covariates = {{"motor_A", next()}, {"battery_V", next()}};
  return p;
}

inline bool same(const Pose& a, const Pose& b) {
  return a.number == b.number && a.set == b.set && a.t_s == b.t_s && a.t_utc == b.t_utc &&
         a.azimuth_rad == b.azimuth_rad && a.pitch_rad == b.pitch_rad && a.roll_rad == b.roll_rad &&
         a.f_nT == b.f_nT && a.f_sd_nT == b.f_sd_nT && a.n == b.n && a.n_eff == b.n_eff && a.y_nT == b.y_nT &&
         a.sd_nT == b.sd_nT && a.mount == b.mount && a.sense == b.sense && a.dwell_s == b.dwell_s &&
         a.since_stop_s == b.since_stop_s && a.T_degC == b.T_degC && a.covariates == b.covariates;
}

}  // namespace mgtd::test
