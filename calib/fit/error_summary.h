// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/fit/fit_report.h"
#include "calib/fit/readings.h"

/// summarise() says how far corrected readings are from what they should be: |b| from F at each sensor, and
/// the tensor of a uniform field from zero.
namespace mgtd::calib::fit {

/// Corrected fields, one column per pose; platform frame for the tensor to mean anything.
using FieldTable = Eigen::MatrixXd;

[[nodiscard]] FieldTable raw_fields(const Readings& readings);
[[nodiscard]] FieldTable corrected_fields(const Readings& readings,
                                          const PerSensor<sensor::SensorModel>& sensors);

/// What counts, pose by pose: the field of each sensor, and the tensor. Empty: everything.
struct Counted {
  Eigen::Array<bool, Eigen::Dynamic, Eigen::Dynamic> field;
  Eigen::Array<bool, 1, Eigen::Dynamic> tensor;
};

[[nodiscard]] ErrorSummary summarise(const FieldTable& b_nT, const Eigen::VectorXd& f_nT,
                                     const sensor::Geometry& geometry, const Counted& counted = {});

/// (|b| - F)/sd squared, summed over sensors and poses. sd: the pose-mean noise along the field, and that of
/// F.
[[nodiscard]] double field_chi2(const FieldTable& b_nT, const Readings& readings,
                                const PerSensor<sensor::SensorModel>& sensors,
                                const calibration::AxisNoise& pose_noise_nT);

}  // namespace mgtd::calib::fit
