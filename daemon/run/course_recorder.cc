// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/course_recorder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/fit/joint/tensor_uncertainty.h"
#include "calib/report/figures/accuracy_figure.h"
#include "calib/report/figures/sky_figures.h"
#include "calib/report/figures/ticks.h"
#include "calib/sensor/sensor_equations.h"
#include "calib/validity/change.h"
#include "daemon/plan/mounting.h"
#include "proto/units.h"

namespace mgtd::daemon::run {
namespace {

namespace figures = calib::report::figures;

Eigen::Matrix3d attitude(const TableAngles& a) {
  return calib::sensor::table_rotation(a.azimuth_rad, a.pitch_rad, a.roll_rad, 0.0, 0.0);
}

std::optional<Eigen::Vector3d> mean_direction(const Pose& pose) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& y_nT : pose.y_nT)
    if (y_nT.allFinite()) sum += y_nT;
  return sum.norm() > 0 ? std::optional<Eigen::Vector3d>(sum.normalized()) : std::nullopt;
}

std::string what_followed(const RunStatus& status, int pose) {
  if (status.state == RunState::paused && !status.goes_on) return "the run paused";
  if (status.state == RunState::paused) return "the run waited for a device";
  if (is_active(status.state) && status.state != RunState::aborting)
    return fmt::format("pose {} is measured again", pose);
  return "the run was ended";
}

}  // namespace

CourseRecorder::CourseRecorder(std::string run_id, const plan::RunPlan& plan,
                               std::optional<Eigen::Vector3d> site_direction,
                               std::optional<double> wanted_nT_per_m)
    : configured_site_(std::move(site_direction)) {
  course_.run_id = std::move(run_id);
  course_.wanted_nT_per_m = wanted_nT_per_m;
  extend(plan);
}

void CourseRecorder::extend(const plan::RunPlan& plan) {
  for (std::size_t i = course_.poses.size(); i < plan.poses.size(); ++i) {
    const plan::PlannedPose& p = plan.poses[i];
    course_.poses.push_back({.number = p.number});
    attitudes_[p.number] = attitude(p.mount ? plan::platform_angles(p.mounting, p.target) : p.target);
  }
}

void CourseRecorder::measured(const Pose& pose) {
  Measured m{.d_P = mean_direction(pose), .d_site = {}};
  if (const auto angles = pose.angles(); m.d_P && angles) m.d_site = attitude(*angles).transpose() * *m.d_P;
  if (m.d_P) hole_.add(*m.d_P);
  measured_.insert_or_assign(pose.number, m);
}

void CourseRecorder::dropped(const std::vector<int>& numbers) {
  for (const int number : numbers) measured_.erase(number);
  hole_ = {};
  for (const auto& [number, m] : measured_)
    if (m.d_P) hole_.add(*m.d_P);
}

void CourseRecorder::known(int poses, const Gradient& tensor_sd_nT_per_m, const FitSoFar& fit) {
  const double worst = calib::fit::joint::worst_component(tensor_sd_nT_per_m).value;
  if (!std::isfinite(worst)) return not_known("the array tells no component of the gradient");
  // Poses that were dropped are not known any more.
  std::erase_if(course_.accuracy, [&](const CourseAccuracy& before) { return before.poses >= poses; });
  course_.accuracy.push_back({poses, tensor_sd_nT_per_m, worst, fit});
  course_.why_unknown.clear();
  unkept_ = true;
}

void CourseRecorder::disturbed(int pose, const FieldDisturbance& seen, Stamp now) {
  course_.disturbances.push_back({.t = now.wall,
                                  .pose = pose,
                                  .change_nT = seen.change_nT,
                                  .limit_nT = seen.limit_nT,
                                  .seen_by = std::string(name(seen.seen_by)),
                                  .lasted_s = {},
                                  .then = "the run waits for a calm field"});
  disturbed_since_ = now.mono;
  unkept_ = true;
}

void CourseRecorder::shows(const RunStatus& status, Stamp now) {
  active_ = is_active(status.state);
  if (!disturbed_since_ || status.state == RunState::suspended) return;
  CourseDisturbance& last = course_.disturbances.back();
  last.lasted_s = to_seconds(now.mono - *disturbed_since_);
  last.then = what_followed(status, last.pose);
  disturbed_since_.reset();
  unkept_ = true;
}

void CourseRecorder::restore(KeptCourse kept) {
  // An accuracy by poses that were taken out of the file afterwards is not known any more.
  std::erase_if(kept.accuracy, [&](const CourseAccuracy& a) {
    return a.poses > static_cast<int>(measured_.size()) || !std::isfinite(a.worst_nT_per_m);
  });
  course_.accuracy = std::move(kept.accuracy);
  course_.disturbances = std::move(kept.disturbances);
  for (CourseDisturbance& d : course_.disturbances)
    if (!d.lasted_s) d.then = "the daemon ended before the field was calm";
}

std::optional<KeptCourse> CourseRecorder::take_unkept() {
  if (!std::exchange(unkept_, false)) return std::nullopt;
  return KeptCourse{course_.accuracy, course_.disturbances};
}

std::optional<Eigen::Vector3d> CourseRecorder::site_direction() const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& [number, m] : measured_)
    if (m.d_site) sum += *m.d_site;
  return sum.norm() > 0 ? std::optional<Eigen::Vector3d>(sum.normalized()) : configured_site_;
}

RunCourse CourseRecorder::course() const {
  RunCourse out = course_;
  const auto site = site_direction();
  bool next = active_;
  for (CoursePose& pose : out.poses) {
    if (const auto m = measured_.find(pose.number); m != measured_.end()) {
      pose.state = CourseState::measured;
      pose.direction_P = m->second.d_P;
      continue;
    }
    if (std::exchange(next, false)) pose.state = CourseState::next;
    if (site) pose.direction_P = attitudes_.at(pose.number) * *site;
  }
  if (const auto hole = hole_.largest()) {
    out.hole = CourseHole{hole->centre, hole->radius_rad};
    out.good_coverage = figures::good_coverage(to_deg(hole->radius_rad), measured_.size());
  }
  if (out.accuracy.empty()) return out;
  const CourseAccuracy& last = out.accuracy.back();
  const std::size_t sensors = last.fit.parameter_sd.size() / calib::sensor::kSensorParameters;
  for (auto& [name, unit, factor] : calib::validity::shown_slots(sensors, {}))
    out.parameters.push_back({std::move(name), std::move(unit), factor});
  out.good_accuracy = figures::good_accuracy(last.worst_nT_per_m, last.poses, out.wanted_nT_per_m);
  if (active_ && !out.expected.empty())
    out.good_accuracy +=
        fmt::format(" The {} poses of the plan lead one to expect {} nT/m.", out.expected.back().poses,
                    figures::short_number(out.expected.back().worst_nT_per_m));
  return out;
}

}  // namespace mgtd::daemon::run
