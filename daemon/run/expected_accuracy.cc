// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/expected_accuracy.h"

#include <cmath>
#include <utility>

#include "calib/fit/joint/joint_fit.h"
#include "calib/fit/joint/joint_problem.h"
#include "calib/fit/joint/tensor_uncertainty.h"
#include "calib/poses/pose_columns.h"
#include "calib/sensor/sensor_equations.h"
#include "daemon/plan/mounting.h"
#include "daemon/run/planned_poses.h"

namespace mgtd::daemon::run {
namespace {

std::optional<double> noise_nT(const Pose& pose) {
  const double n = pose.n_eff.value_or(pose.n.value_or(0));
  double sum_nT2 = 0, axes = 0;
  for (const auto& sensor : pose.sd_nT)
    for (const auto& sd_nT : sensor)
      if (sd_nT) sum_nT2 += *sd_nT * *sd_nT, ++axes;
  if (!(n > 0) || !(sum_nT2 > 0)) return std::nullopt;
  return std::sqrt(sum_nT2 / axes / n);
}

/// Poses of unlike length have the information of as many of this length.
double mean_dwell_s(const plan::RunPlan& plan) {
  double sum_s = 0;
  for (const plan::PlannedPose& pose : plan.poses) sum_s += pose.dwell_s;
  return sum_s / static_cast<double>(plan.poses.size());
}

Eigen::Vector3d mean_reading_nT(const Pose& pose) {
  Eigen::Vector3d sum_nT = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& y_nT : pose.y_nT) sum_nT += y_nT;
  return sum_nT / static_cast<double>(pose.y_nT.size());
}

}  // namespace

std::optional<calib::design::DesignRequest> planned_design(const config::Config& config,
                                                           const plan::RunPlan& plan, const Pose& measured) {
  const auto noise = noise_nT(measured);
  const Eigen::Vector3d b_P_nT = mean_reading_nT(measured);
  const auto angles = measured.angles();
  if (!noise || !angles || !(b_P_nT.norm() > 0)) return std::nullopt;
  calib::design::DesignRequest out;
  assume(config, out);
  const Eigen::Vector3d b_site_nT =
      calib::sensor::table_rotation(angles->azimuth_rad, angles->pitch_rad, angles->roll_rad, 0.0, 0.0)
          .transpose() *
      b_P_nT;
  out.f_nT = b_site_nT.norm();
  out.inclination_rad = calib::fit::joint::inclination_of(b_site_nT.normalized());
  out.declination_rad = calib::fit::joint::declination_of(b_site_nT.normalized());
  const double mean_s = mean_dwell_s(plan);
  out.pose_noise_nT = *noise * std::sqrt(measured.dwell_s.value_or(mean_s) / mean_s);
  out.sensors.resize(out.geometry.sensors());
  out.power = false;
  out.candidates.clear();
  for (const plan::PlannedPose& p : plan.poses) {
    const TableAngles a = p.mount ? plan::platform_angles(p.mounting, p.target) : p.target;
    Pose pose = calib::poses::unmeasured_pose(out.geometry.sensors());
    pose.number = p.number;
    pose.azimuth_rad = a.azimuth_rad;
    pose.pitch_rad = a.pitch_rad;
    pose.roll_rad = a.roll_rad;
    out.poses.poses.push_back(std::move(pose));
  }
  return out;
}

std::vector<CourseAccuracy> expected_accuracy(calib::design::DesignRequest whole,
                                              const std::stop_token& stop) {
  constexpr int kSteps = 12;
  const PoseTable plan = std::exchange(whole.poses, {});
  const auto least = static_cast<double>(calib::fit::joint::kFewestPoses),
             most = static_cast<double>(plan.poses.size());
  std::vector<CourseAccuracy> out;
  std::size_t before = 0;
  for (int i = 0; i <= kSteps && most >= least && !stop.stop_requested(); ++i) {
    const auto count =
        static_cast<std::size_t>(std::lround(least * std::pow(most / least, i / double{kSteps})));
    if (count == before) continue;
    before = count;
    whole.poses.poses.assign(plan.poses.begin(), plan.poses.begin() + static_cast<std::ptrdiff_t>(count));
    const auto design = calib::design::evaluate_design(whole);
    if (!design || !design->determined) continue;
    const double worst = calib::fit::joint::worst_component(design->tensor_sd_nT_per_m).value;
    if (std::isfinite(worst)) out.push_back({static_cast<int>(count), design->tensor_sd_nT_per_m, worst});
  }
  return out;
}

}  // namespace mgtd::daemon::run
