// SPDX-License-Identifier: Apache-2.0
#include "calib/poses/pose_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "proto/units.h"

namespace mgtd::calib::poses {
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
  return {std::move(name), false,
          [member](Pose& p, double v) { p.*member = static_cast<int>(std::lround(v)); },
          [member](const Pose& p) { return p.*member ? std::optional<double>(*(p.*member)) : std::nullopt; },
          true};
}

/// Beyond these no instrument of this kind reads; a slipped column or unit does.
constexpr double kMostReading_nT = 1e7, kLeastField_nT = 1'000, kMostField_nT = 200'000;
constexpr double kColdest_degC = -100, kHottest_degC = 150;

constexpr std::string_view kAxes = "xyz";
constexpr double kNoLimit = std::numeric_limits<double>::infinity();
const PoseColumn::Limits kAboveZero{.low = 0, .high = kNoLimit, .without_low = true};

PoseColumn within(PoseColumn column, PoseColumn::Limits limits) {
  column.limits = limits;
  return column;
}

/// NaN stands for components that were not given.
PoseColumn reference(std::size_t axis) {
  const auto a = static_cast<Eigen::Index>(axis);
  return {fmt::format("ref_{}_nT", kAxes[axis]),
          false,
          [a](Pose& p, double v) {
            if (!p.ref_nT) p.ref_nT = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
            (*p.ref_nT)[a] = v;
          },
          [a](const Pose& p) { return p.ref_nT ? std::optional((*p.ref_nT)[a]) : std::nullopt; },
          false,
          {.low = -kMostReading_nT, .high = kMostReading_nT}};
}

std::vector<PoseColumn> make_columns(std::size_t sensors) {
  std::vector<PoseColumn> columns{
      plain("t_s", &Pose::t_s),
      angle("azimuth_deg", &Pose::azimuth_rad),
      angle("pitch_deg", &Pose::pitch_rad),
      angle("roll_deg", &Pose::roll_rad),
      within(plain("f_nT", &Pose::f_nT), {.low = kLeastField_nT, .high = kMostField_nT}),
      within(plain("f_sd_nT", &Pose::f_sd_nT), kAboveZero),
      reference(0),
      reference(1),
      reference(2),
      within(plain("ref_sd_nT", &Pose::ref_sd_nT), kAboveZero),
      within(plain("n", &Pose::n), {.low = 1}),
      within(plain("n_eff", &Pose::n_eff), kAboveZero)};
  for (std::size_t i = 0; i < sensors; ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      columns.push_back({fmt::format("s{}_{}_nT", i + 1, kAxes[a]),
                         true,
                         [i, a](Pose& p, double v) { p.y_nT.at(i)[static_cast<Eigen::Index>(a)] = v; },
                         [i, a](const Pose& p) {
                           return i < p.y_nT.size() ? std::optional(p.y_nT[i][static_cast<Eigen::Index>(a)])
                                                    : std::nullopt;
                         },
                         false,
                         {.low = -kMostReading_nT, .high = kMostReading_nT}});
    }
  }
  for (std::size_t i = 0; i < sensors; ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      columns.push_back(
          {fmt::format("s{}_sd_{}_nT", i + 1, kAxes[a]),
           false,
           [i, a](Pose& p, double v) { p.sd_nT.at(i).at(a) = v; },
           [i, a](const Pose& p) { return i < p.sd_nT.size() ? p.sd_nT[i].at(a) : std::nullopt; },
           false,
           {.low = 0, .high = kNoLimit}});  // 0: a stuck axis
    }
  }
  columns.push_back(whole("mount", &Pose::mount));
  columns.push_back(within(whole("sense", &Pose::sense), {.low = -1, .high = 1, .only_ends = true}));
  columns.push_back(within(plain("dwell_s", &Pose::dwell_s), kAboveZero));
  columns.push_back(plain("since_stop_s", &Pose::since_stop_s));
  for (std::size_t i = 0; i < sensors; ++i) {
    columns.push_back({fmt::format("s{}_T_degC", i + 1),
                       false,
                       [i](Pose& p, double v) { p.T_degC.at(i) = v; },
                       [i](const Pose& p) { return i < p.T_degC.size() ? p.T_degC[i] : std::nullopt; },
                       false,
                       {.low = kColdest_degC, .high = kHottest_degC}});
  }
  return columns;
}

}  // namespace

bool PoseColumn::Limits::hold(double value) const {
  if (only_ends) return value == low || value == high;
  return (without_low ? value > low : value >= low) && value <= high;
}

std::string PoseColumn::Limits::words() const {
  if (only_ends) return fmt::format("{:+} or {:+}", low, high);
  if (high == kNoLimit) return fmt::format("{} {}", without_low ? "above" : "at least", low);
  return fmt::format("from {} to {}", low, high);
}

const std::vector<PoseColumn>& pose_columns(std::size_t sensors) {
  static const auto kColumns = [] {
    std::array<std::vector<PoseColumn>, kMostSensors + 1> all;
    for (std::size_t n = 0; n < all.size(); ++n) all[n] = make_columns(n);
    return all;
  }();
  return kColumns.at(sensors);
}

PoseColumn::Limits field_limits_beside_reference() { return {.low = 0, .high = kMostField_nT}; }

Pose unmeasured_pose(std::size_t sensors) {
  Pose pose;
  pose.y_nT = no_readings(sensors);
  pose.sd_nT = PerSensor<std::array<std::optional<double>, 3>>(sensors);
  pose.T_degC = PerSensor<std::optional<double>>(sensors);
  return pose;
}

std::string counted(std::size_t sensors) {
  return fmt::format("{} sensor{}", sensors, sensors == 1 ? "" : "s");
}

std::size_t sensors_of(const PoseTable& table) {
  return table.poses.empty() ? kSensorCount : table.poses.front().y_nT.size();
}

}  // namespace mgtd::calib::poses
