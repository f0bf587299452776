// SPDX-License-Identifier: Apache-2.0
#include "calib/design/actions.h"

#include <array>
#include <cmath>
#include <numbers>

#include "calib/fit/two_step/azimuth_origin.h"
#include "proto/units.h"

namespace mgtd::calib::design {
namespace {

constexpr double kPose_min = 0.5;  ///< where the table tells no times

double share(std::size_t k) { return static_cast<double>(k) / (kActionPoses - 1); }

void warm(Pose& pose, std::size_t k) {
  for (auto& T : pose.T_degC)
    if (T) *T += 5 * std::sin(std::numbers::pi * share(k));
}

void weaker_field(Pose& pose, std::size_t) {
  constexpr double kShare = 0.8;
  for (auto& y : pose.y_nT) y *= kShare;
  if (pose.f_nT) *pose.f_nT *= kShare;
}

void dwell(Pose& pose, std::size_t k) {
  static constexpr std::array kWaits_s{5.0, 20.0, 60.0};
  if (pose.since_stop_s) pose.since_stop_s = kWaits_s[k % kWaits_s.size()];
}

void toggle(Pose& pose, std::size_t k) {
  for (auto& [name, value] : pose.covariates)
    if (name.ends_with("_A")) value += k % 2 == 0 ? 0.5 : -0.5;
}

void reverse(Pose& pose, std::size_t k) {
  if (pose.sense) pose.sense = k % 2 == 0 ? 1 : -1;
}

/// The same field at another pitch.
void tilt(Pose& pose, double by_rad, const PerSensor<sensor::SensorModel>& sensors) {
  const auto before = pose.angles();
  if (!before) return;
  *pose.pitch_rad += by_rad;
  const Eigen::Matrix3d turn =
      fit::two_step::table_rotation(*pose.angles()) * fit::two_step::table_rotation(*before).transpose();
  for (std::size_t i = 0; i < sensors.size(); ++i)
    pose.y_nT[i] = sensors[i].predict(turn * sensors[i].correct(pose.y_nT[i]));
}

constexpr double kTilt_rad = to_rad(20);

constexpr std::array kActions{
    Action{"24 more poses as before", 0, [](Pose&, std::size_t) {}},
    Action{"a heat pulse: warm the heads by 5 degC and let them cool again during 24 poses", 10, &warm},
    Action{"24 poses with the field a fifth weaker (coil)", 5, &weaker_field},
    Action{"24 poses in mixed order with waits of 5, 20 and 60 s before the dwell", 8, &dwell},
    Action{"24 poses with the current switched from pose to pose", 2, &toggle},
    Action{"24 poses approached from alternating sides", 2, &reverse},
    Action{"24 poses tilted 20 degrees further (by the table, or a wedge under the array)", 4,
           [](Pose&, std::size_t) {}, kTilt_rad},
    Action{
        "24 poses with the whole rig at another place: what is the site's stays behind (judge them on their "
        "own)",
        30, [](Pose&, std::size_t) {}, 0, true},
};

}  // namespace

std::span<const Action> actions() { return kActions; }

double minutes_per_pose(const PoseTable& table) {
  const auto &first = table.poses.front().t_s, &last = table.poses.back().t_s;
  if (!first || !last || !(*last > *first)) return kPose_min;
  return (*last - *first) / 60 / static_cast<double>(table.poses.size() - 1);
}

PerSensor<std::optional<double>> drifted_temperatures(const PoseTable& table, double t_s) {
  const Pose &first = table.poses.front(), &last = table.poses.back();
  auto out = last.T_degC;
  const double span_s = last.t_s && first.t_s ? *last.t_s - *first.t_s : 0;
  for (std::size_t i = 0; i < out.size() && span_s > 0; ++i) {
    if (out[i] && first.T_degC[i])
      *out[i] += (*last.T_degC[i] - *first.T_degC[i]) * (t_s - *last.t_s) / span_s;
  }
  return out;
}

PoseTable extended(const PoseTable& table, const Action& action,
                   const PerSensor<sensor::SensorModel>& sensors) {
  PoseTable out = table;
  const Pose& last = table.poses.back();
  const std::size_t n = table.poses.size();
  for (std::size_t k = 0; k < kActionPoses; ++k) {
    // Attitudes spread over the run, in an order that has none.
    Pose pose = table.poses[(k * 37 + 11) % n];
    pose.number = last.number + static_cast<int>(k) + 1;
    if (pose.set == "check") pose.set = "random";
    if (last.t_s) pose.t_s = *last.t_s + 60 * minutes_per_pose(table) * static_cast<double>(k + 1);
    pose.t_utc.reset();
    pose.T_degC = drifted_temperatures(table, pose.t_s.value_or(0));
    action.change(pose, k);
    if (action.tilt_rad != 0) tilt(pose, k % 2 == 0 ? action.tilt_rad : -action.tilt_rad, sensors);
    out.poses.push_back(std::move(pose));
  }
  return out;
}

}  // namespace mgtd::calib::design
