// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "calib/calibration/calibration.h"
#include "calib/calibration/tensor.h"
#include "proto/pose.h"

/// apply() corrects every pose of a pose table with a calibration: it gives the field at each sensor, the
/// field and the tensor at the centre, and the closure. Instrument errors are removed; what the site does is
/// real field and stays in.
namespace mgtd::calib::calibration {

struct ApplyOptions {
  /// Effects of the site that are in the calibration (gradient, dipole, drift) are taken out too: what is
  /// left is what the calibration does not know. Needs the table angles of every pose.
  bool remove_site{false};
  /// Where a pose lacks what an effect needs, leave that effect out instead of refusing.
  bool missing_ok{false};
};

struct AppliedPose {
  int number{0};
  std::optional<double> t_s;
  sensor::FieldVector b_P_nT;  ///< of all sensors
  TensorSample sample;  ///< at the centre; the noise is that of the pose's n_eff (else n, else one) samples
  /// Effects that were not removed, by name; the sd is wider by their size.
  std::vector<std::string> left_out;
};

/// Refuses a pose that lacks what an effect needs (unless missing_ok), and remove_site without effects of the
/// site or without angles.
[[nodiscard]] Result<std::vector<AppliedPose>> apply(const Calibration& calibration, const PoseTable& table,
                                                     const ApplyOptions& options = {});

/// CSV, platform frame: pose, t_s (when any pose has it), s1_bx_nT .. sN_bz_nT, Bx_nT, By_nT, Bz_nT, F_nT,
/// Gxx_nT_per_m, Gyy.., Gzz.., Gxy.., Gxz.., Gyz.., curl_nT_per_m, center_x_nT, center_y_nT, center_z_nT,
/// where the noise is known Gxx_sd_nT_per_m .. Gyz_sd_nT_per_m and closure_chi2, and left_out (names with ';'
/// between) when any effect was. Sensors on one line have dBx_nT_per_m, dBy.., dBz.. with their _sd_, the
/// derivative of the field along that line, as well. What the array cannot tell has no column, and curl and
/// centre are of the cross. Six decimals.
[[nodiscard]] std::string format_applied(const std::vector<AppliedPose>& rows);

}  // namespace mgtd::calib::calibration
