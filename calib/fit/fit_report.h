// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calib/calibration/calibration.h"
#include "calib/fit/fit_options.h"
#include "calib/fit/outlier_node.h"
#include "proto/error.h"
#include "proto/pose.h"
#include "proto/tensor.h"

/// What a fit found: the calibration, how far it can be trusted, and what the operator must know about it.
namespace mgtd::calib {

/// Root mean squares over poses. The field is that of each sensor against the pose's own F; the tensor of a
/// uniform field is zero, so its rms is the error.
struct ErrorSummary {
  std::array<double, kSensors> total_field_rmse_nT{};
  Gradient tensor_rmse_nT_per_m;
};

/// Step 2 from the odd and from the even poses of the standard set, counted by azimuth.
struct HalvesComparison {
  ErrorSummary odd, even;
  std::array<SensorModel, kSensors> odd_sensors, even_sensors;
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

struct FitReport {
  Calibration calibration;
  double chi2{0};  ///< two-step: of |b| against F; joint: of all readings and the scalar reference
  double dof{0};
  double noise_nT{0};      ///< of a pose mean, rms over the axes
  bool noise_told{false};  ///< by the spreads within the dwells; else the residual's own
  /// Sentences for the operator: what failed, what was recognised, what is left over.
  std::vector<std::string> reasons;
  SiteField site;
  ErrorSummary before, after_step1, after;
  std::optional<ErrorSummary> two_step;    ///< beside a joint fit, where the poses allow one
  std::optional<ErrorSummary> simplified;  ///< the baseline method beside the others, likewise
  /// Folds contiguous in time; empty when a fold cannot be fitted without its poses.
  std::optional<ErrorSummary> held_out;
  std::optional<ErrorSummary> check_poses;  ///< poses of the set "check", which no fit has seen
  std::optional<HalvesComparison> halves;

  // Of the joint fit:
  double chi2_table{0}, dof_table{0};          ///< of the table angles, kept apart from the model's
  double table_sd_rad{0};                      ///< estimated
  double residual_nT{0};                       ///< as PoseResiduals tells it
  std::optional<double> held_out_residual_nT;  ///< the same for poses left out, each with its own best field
  std::vector<OutlierNode> outliers;
  /// Poses that contradict the others in something, of all poses; above a third of them nothing is left out.
  double contradicting{0};
  /// What the poses do not tell, with the standard deviation it leaves in the field.
  std::vector<std::string> weak;
  Gradient tensor_sd_nT_per_m;  ///< of the tensor by the calibration alone, rms over all attitudes
};

}  // namespace mgtd::calib
