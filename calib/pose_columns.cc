// SPDX-License-Identifier: Apache-2.0
#include "calib/pose_columns.h"

#include <fmt/format.h>

#include <cmath>

#include "proto/units.h"

namespace mgtd::calib {
namespace {

using Member = std::optional<double> Pose::*;

PoseColumn plain(std::string name, Member member) {
  return {std::move(name), false, [member](Pose& p, double v) { p.*member = v; },
          [member](const Pose& p) { return p.*member; }};
}

/// To 1e-9 deg (1e-6 nT in 50 000 nT): hides the last bit that degrees and radians do not share.
double rounded_deg(double angle_rad) { return std::round(to_deg(angle_rad) * 1e9) / 1e9; }

/// Degrees in the file, radians inside.
PoseColumn angle(std::string name, Member member) {
  return {std::move(name), false, [member](Pose& p, double v) { p.*member = to_rad(v); },
          [member](const Pose& p) {
            return p.*member ? std::optional(rounded_deg(*(p.*member))) : std::nullopt;
          }};
}

PoseColumn whole(std::string name, std::optional<int> Pose::*member) {
  return {std::move(name), false, [member](Pose& p, double v) { p.*member = static_cast<int>(v); },
          [member](const Pose& p) { return p.*member ? std::optional<double>(*(p.*member)) : std::nullopt; },
          true};
}

std::vector<PoseColumn> make_columns() {
  std::vector<PoseColumn> columns{plain("t_s", &Pose::t_s),
                                  angle("azimuth_deg", &Pose::azimuth_rad),
                                  angle("pitch_deg", &Pose::pitch_rad),
                                  angle("roll_deg", &Pose::roll_rad),
                                  plain("f_nT", &Pose::f_nT),
                                  plain("f_sd_nT", &Pose::f_sd_nT),
                                  plain("n", &Pose::n),
                                  plain("n_eff", &Pose::n_eff)};
  constexpr std::string_view kAxes = "xyz";
  for (std::size_t i = 0; i < kSensors; ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      columns.push_back(
          {fmt::format("s{}_{}_nT", i + 1, kAxes[a]), true,
           [i, a](Pose& p, double v) { p.y_nT.at(i)[static_cast<Eigen::Index>(a)] = v; },
           [i, a](const Pose& p) { return std::optional(p.y_nT.at(i)[static_cast<Eigen::Index>(a)]); }});
    }
  }
  for (std::size_t i = 0; i < kSensors; ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      columns.push_back({fmt::format("s{}_sd_{}_nT", i + 1, kAxes[a]), false,
                         [i, a](Pose& p, double v) { p.sd_nT.at(i).at(a) = v; },
                         [i, a](const Pose& p) { return p.sd_nT.at(i).at(a); }});
    }
  }
  columns.push_back(whole("mount", &Pose::mount));
  columns.push_back(whole("sense", &Pose::sense));
  columns.push_back(plain("dwell_s", &Pose::dwell_s));
  columns.push_back(plain("since_stop_s", &Pose::since_stop_s));
  for (std::size_t i = 0; i < kSensors; ++i) {
    columns.push_back({fmt::format("s{}_T_degC", i + 1), false,
                       [i](Pose& p, double v) { p.T_degC.at(i) = v; },
                       [i](const Pose& p) { return p.T_degC.at(i); }});
  }
  return columns;
}

}  // namespace

const std::vector<PoseColumn>& pose_columns() {
  static const std::vector<PoseColumn> kColumns = make_columns();
  return kColumns;
}

}  // namespace mgtd::calib
