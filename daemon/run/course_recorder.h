// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calib/report/figures/sky.h"
#include "daemon/plan/run_plan.h"
#include "daemon/run/field_disturbance.h"
#include "daemon/run/kept_course.h"
#include "proto/pose.h"
#include "proto/run_course.h"
#include "proto/run_status.h"

/// A CourseRecorder records the course of a run while it goes on: the directions of the field at the poses
/// planned and measured, the accuracy after each fit of the poses so far, and the disturbances with what the
/// run did.
///
/// The direction at a measured pose is the mean of its raw readings; that at a planned one is
///
///     d_P = R(azimuth, pitch, roll) d_site
///
/// with d_site the mean over the measured poses; before the first of them by the inclination of the
/// configuration and its declination (0 where it has none), and unknown without an inclination. The axes
/// of the sensors are taken for those of the platform: the map is wrong where sensors are mounted in quarter
/// turns. Their offsets are in it too: a few tenths of a degree, less than a mark on the map is wide.
///
/// Pure: what happens and the time come in. It fits nothing (accuracy_so_far.h does, on the worker). A run
/// that another life of the daemon resumes has its poses again, and what its file kept (kept_course.h).
namespace mgtd::daemon::run {

class CourseRecorder {
 public:
  CourseRecorder() = default;
  CourseRecorder(std::string run_id, const plan::RunPlan& plan, std::optional<Eigen::Vector3d> site_direction,
                 std::optional<double> wanted_nT_per_m);

  /// Poses behind those that it knows.
  void extend(const plan::RunPlan& plan);
  void measured(const Pose& pose);
  /// To be measured again.
  void dropped(const std::vector<int>& numbers);
  /// By a calibration from so many poses; replaces what was known from as many or more.
  void known(int poses, const Gradient& tensor_sd_nT_per_m, const FitSoFar& fit = {});
  void expects(std::vector<CourseAccuracy> of_plan) { course_.expected = std::move(of_plan); }
  void not_known(std::string why) { course_.why_unknown = std::move(why); }
  void disturbed(int pose, const FieldDisturbance& seen, Stamp now);
  /// The state that the run shows: what follows a disturbance.
  void shows(const RunStatus& status, Stamp now);
  /// What an earlier life of the daemon kept of this run, whose poses are known already.
  void restore(KeptCourse kept);
  /// What is to be kept now; empty where nothing is new since it was asked for last.
  [[nodiscard]] std::optional<KeptCourse> take_unkept();

  [[nodiscard]] RunCourse course() const;

 private:
  struct Measured {
    std::optional<Eigen::Vector3d> d_P, d_site;
  };
  [[nodiscard]] std::optional<Eigen::Vector3d> site_direction() const;

  RunCourse course_;                          ///< but for what course() makes anew
  std::map<int, Eigen::Matrix3d> attitudes_;  ///< of the plan, site to platform, by number
  std::map<int, Measured> measured_;          ///< by number
  std::optional<Eigen::Vector3d> configured_site_;
  calib::report::figures::HoleSearch hole_;
  std::optional<Instant> disturbed_since_;
  bool active_{false}, unkept_{false};
};

}  // namespace mgtd::daemon::run
