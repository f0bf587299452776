// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "calib/calibration/calibration.h"
#include "calib/fit/fit_report.h"

/// Readings holds the readings of a pose table in the form that the fits use: one column per pose.
namespace mgtd::calib::fit {

struct Readings {
  PerSensor<Eigen::Matrix3Xd> y_nT;
  Eigen::VectorXd f_nT;
  Eigen::VectorXd f_sd_nT;
  std::vector<std::optional<TableAngles>> angles;
  std::vector<bool> standard;
  std::vector<int> number;  ///< of the pose in the table
  calibration::AxisNoise pose_noise_nT{
      calibration::AxisNoise::Zero(kSensors, 3)};  ///< of a pose mean; zero when the table has no spreads

  [[nodiscard]] Eigen::Index poses() const { return f_nT.size(); }
  /// The pose belongs to the turn of the standard set and its azimuth is known.
  [[nodiscard]] bool of_turn(Eigen::Index k) const {
    const auto at = static_cast<std::size_t>(k);
    return standard[at] && angles[at].has_value();
  }
  [[nodiscard]] double mean_f_nT() const { return f_nT.mean(); }
  /// The poses with these indices, in this order.
  [[nodiscard]] Readings subset(const std::vector<Eigen::Index>& which) const;
};

/// Every pose but those of the set "check", or those alone.
enum class PoseUse { fit, check };

/// Refuses when there is no such pose, and when a pose has no field and none is given.
[[nodiscard]] Result<Readings> readings_of(const PoseTable& table, const FitOptions& options,
                                           PoseUse use = PoseUse::fit);

/// Noise of one sample per axis, pooled over the poses (root mean square of their spreads, without those
/// above five times the median: something moved there), without what a vector reference beside the table says
/// that the field moved meanwhile (dwell_motion.h); zero where no pose tells.
[[nodiscard]] calibration::AxisNoise pooled_sample_noise(const PoseTable& table);

}  // namespace mgtd::calib::fit
