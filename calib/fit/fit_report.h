// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calib/calibration/calibration.h"
#include "calib/fit/azimuth_gauge.h"
#include "calib/fit/fit_options.h"
#include "calib/fit/fit_summary.h"
#include "calib/fit/outlier_node.h"
#include "proto/error.h"
#include "proto/pose.h"
#include "proto/tensor.h"

/// A FitReport holds what a fit found, as values: the calibration, how the fit ended, how far its result can
/// be trusted. The words for a person are made in calib/report, the checks in calib/fit/checks.
namespace mgtd::calib::fit::joint {
struct JointFindings;
}  // namespace mgtd::calib::fit::joint

namespace mgtd::calib::fit {

/// Root mean squares over poses. The field is that of each sensor against the pose's own F; the tensor of a
/// uniform field is zero, so its rms is the error.
struct ErrorSummary {
  PerSensor<double> total_field_rmse_nT{};
  Gradient tensor_rmse_nT_per_m;
};

/// Step 2 from the odd and from the even poses of the standard set, counted by azimuth.
struct HalvesComparison {
  ErrorSummary odd, even;
  PerSensor<sensor::SensorModel> odd_sensors, even_sensors;
  /// Largest difference between the halves of alpha, beta and gamma over the sensors, gamma less its common
  /// part.
  double angle_difference_rad{0};
};

/// The field of the site in the platform frame at zero table angles.
struct SiteField {
  double f_nT{0};
  double inclination_rad{0}, declination_rad{0};
  double inclination_sd_rad{0}, declination_sd_rad{0};
};

/// Scatter of the attitudes about the table's angles, kept apart from what the model leaves of the readings.
struct TableScatter {
  double chi2{0}, dof{0};
  double sd_rad{0};         ///< estimated
  double stated_sd_rad{0};  ///< FitOptions::table_sd_rad
};

struct FitReport {
  calibration::Calibration calibration;
  double chi2{0};  ///< two-step: of |b| against F; joint: of all readings and the scalar reference
  double dof{0};
  FitSummary summary;
  double noise_nT{0};       ///< of a pose mean, rms over the axes
  bool noise_known{false};  ///< from the spreads within the dwells; else the noise is the residual's own
  /// Sentences of the caller that stand before all others: what it found beside the fit.
  std::vector<std::string> found_beside;
  SiteField site;
  ErrorSummary before, after_step1, after;
  std::optional<ErrorSummary> two_step;    ///< beside a joint fit, where the poses allow one
  std::optional<ErrorSummary> simplified;  ///< the baseline method beside the others, likewise
  /// Folds contiguous in time; empty when a fold cannot be fitted without its poses.
  std::optional<ErrorSummary> held_out;
  std::optional<ErrorSummary> check_poses;  ///< poses of the set "check", which no fit has seen
  std::optional<HalvesComparison> halves;
  std::optional<AzimuthOrigin> azimuth_origin;  ///< of the two-step and the simplified method

  // Of the joint fit:
  TableScatter table;
  double residual_nT{0};                       ///< PoseResiduals::residual_nT
  std::optional<double> held_out_residual_nT;  ///< the same for poses left out, each with its own best field
  std::vector<OutlierNode> outliers;
  /// Poses that contradict the others in something, of all poses; above a third of them nothing is left out.
  /// Empty where all were to be kept.
  std::optional<double> contradicting{};
  std::shared_ptr<const joint::JointFindings> joint;  ///< joint/joint_findings.h; null for the other methods
  Gradient tensor_sd_nT_per_m;  ///< of the tensor by the calibration alone, rms over all attitudes
};

}  // namespace mgtd::calib::fit
