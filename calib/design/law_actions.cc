// SPDX-License-Identifier: Apache-2.0
#include "calib/design/law_actions.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "proto/units.h"

namespace mgtd::calib::design {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kOtherDay_degC = 3, kPulse_degC = 5, kStep_degC = 6;

using Sensors = PerSensor<sensor::SensorModel>;
using Lack = std::optional<std::string>;

bool any(const PoseTable& run, bool (*has)(const Pose&)) {
  return std::any_of(run.poses.begin(), run.poses.end(), has);
}
bool all(const PoseTable& run, bool (*has)(const Pose&)) {
  return std::all_of(run.poses.begin(), run.poses.end(), has);
}

Lack no_time(const PoseTable& run) {
  if (all(run, [](const Pose& p) { return p.t_s.has_value(); })) return std::nullopt;
  return "the poses have no time (t_s)";
}

Lack no_temperature(const PoseTable& run) {
  const bool some = any(run, [](const Pose& p) {
    return std::any_of(p.T_degC.begin(), p.T_degC.end(), [](const auto& T) { return T.has_value(); });
  });
  if (some) return std::nullopt;
  return "no temperature is recorded (s1_T_degC ...)";
}

/// A current, or something that is on or off.
bool is_load(const PoseTable& run, const std::string& name) {
  if (name.ends_with("_A")) return true;
  return std::all_of(run.poses.begin(), run.poses.end(), [&](const Pose& p) {
    const auto found = p.covariates.find(name);
    return found == p.covariates.end() || found->second == 0 || found->second == 1;
  });
}

Lack no_load(const PoseTable& run) {
  for (const Pose& pose : run.poses) {
    for (const auto& column : pose.covariates)
      if (is_load(run, column.first)) return std::nullopt;
  }
  return "no column is a current (..._A) or a switch (0 or 1)";
}

Lack not_turnable(const PoseTable& run) {
  if (turnable(run)) return std::nullopt;
  return "no table turned the array to angles that could be asked for";
}

Lack no_field(const PoseTable& run) {
  if (all(run, [](const Pose& p) { return p.f_nT.has_value() || p.ref_nT.has_value(); })) return std::nullopt;
  return "no reference tells how strong the field is (f_nT)";
}

Lack one_mounting(const PoseTable&) {
  return "a sensor turned in its mount is another array: measure it as a run of its own";
}

Lack no_further_tilt(const PoseTable& run) {
  if (!turnable(run)) return not_turnable(run);
  const AngleRange pitch = angle_range(run, &Pose::pitch_rad);
  if (pitch.most_rad - pitch.least_rad < to_rad(140)) return std::nullopt;
  return "the run has all tilts already";
}

void one_head_after_another(Pose& pose, const ActionMoment& at, const Sensors&) {
  const double turn = at.share * static_cast<double>(pose.T_degC.size());
  const auto heated = std::min(pose.T_degC.size() - 1, static_cast<std::size_t>(turn));
  auto& T = pose.T_degC[heated];
  if (T) *T += kPulse_degC * std::sin(kPi * (turn - std::floor(turn)));
}

void heat_step(Pose& pose, const ActionMoment& at, const Sensors&) {
  constexpr double kBegin = 0.2, kTime = 0.25;  // of the action
  const double since = at.share - kBegin;
  if (since <= 0) return;
  for (auto& T : pose.T_degC)
    if (T) *T += kStep_degC * (1 - std::exp(-since / kTime));
}

void warmer(Pose& pose, const ActionMoment&, const Sensors&) {
  for (auto& T : pose.T_degC)
    if (T) *T += kOtherDay_degC;
}

void colder(Pose& pose, const ActionMoment&, const Sensors&) {
  for (auto& T : pose.T_degC)
    if (T) *T -= kOtherDay_degC;
}

void switch_load(Pose& pose, const ActionMoment& at, const Sensors&) {
  for (auto& [name, value] : pose.covariates) {
    if (name.ends_with("_A")) {
      value += at.k % 2 == 0 ? 0.5 : -0.5;
    } else if (value == 0 || value == 1) {
      value = at.k % 2 == 0 ? 1 : 0;
    }
  }
}

void weaker_field(Pose& pose, const ActionMoment&, const Sensors& sensors) {
  constexpr double kShare = 0.8;
  for (std::size_t i = 0; i < sensors.size(); ++i)
    pose.y_nT[i] = sensors[i].predict(kShare * sensors[i].correct(pose.y_nT[i]));
  if (pose.f_nT) *pose.f_nT *= kShare;
  if (pose.ref_nT) *pose.ref_nT *= kShare;
}

constexpr std::array kLawActions{
    LawAction{.text = "24 more poses as before", .by_the_rig = true, .placed = false},
    LawAction{.text = "24 poses where the formulas differ most (attitude, approach, wait)",
              .by_the_rig = true,
              .lacks = &not_turnable},
    LawAction{.text = "24 poses on another day, 3 degC warmer",
              .extra_min = 20,
              .other_day = true,
              .lacks = &no_time,
              .change = &warmer},
    LawAction{.text = "24 poses on another day, 3 degC colder",
              .extra_min = 20,
              .other_day = true,
              .lacks = &no_time,
              .change = &colder},
    LawAction{.text = "24 poses while one head after another is warmed by 5 degC",
              .extra_min = 15,
              .lacks = &no_temperature,
              .change = &one_head_after_another},
    LawAction{.text = "a heat step: all heads 6 degC warmer, from the fifth of 24 poses on",
              .extra_min = 10,
              .lacks = &no_temperature,
              .change = &heat_step},
    LawAction{.text = "24 poses with the load switched from pose to pose",
              .extra_min = 2,
              .lacks = &no_load,
              .change = &switch_load},
    LawAction{.text = "24 poses with dwells of 5 to 60 s in mixed order",
              .by_the_rig = true,
              .dwells = true,
              .lacks = &no_time},
    LawAction{.text = "24 poses with the field a fifth weaker (coil)",
              .extra_min = 5,
              .lacks = &no_field,
              .change = &weaker_field},
    LawAction{.text = "24 poses tilted up to 20 degrees further (by the table, or a wedge under the array)",
              .extra_min = 4,
              .wider_rad = to_rad(20),
              .lacks = &no_further_tilt},
    LawAction{.text = "sensors turned in their mounts", .extra_min = 30, .lacks = &one_mounting},
};

}  // namespace

AngleRange angle_range(const PoseTable& run, const std::optional<double> Pose::*angle) {
  AngleRange out{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (const Pose& pose : run.poses) {
    out.least_rad = std::min(out.least_rad, *(pose.*angle));
    out.most_rad = std::max(out.most_rad, *(pose.*angle));
  }
  return out;
}

std::span<const LawAction> law_actions() { return kLawActions; }

bool has_table(const PoseTable& run) {
  return std::any_of(run.poses.begin(), run.poses.end(),
                     [](const Pose& p) { return p.azimuth_rad.has_value(); });
}

bool turnable(const PoseTable& run) {
  const std::optional<int>& mount = run.poses.front().mount;
  return std::all_of(run.poses.begin(), run.poses.end(),
                     [&](const Pose& p) { return p.angles().has_value() && p.mount == mount; });
}

}  // namespace mgtd::calib::design
