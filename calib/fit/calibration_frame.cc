// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/calibration_frame.h"

#include "calib/poses/pose_table.h"
#include "calib/poses/run_time.h"
#include "proto/version.h"

namespace mgtd::calib::fit {

calibration::Reference reference_of(const PoseTable& table, const Readings& readings) {
  calibration::Reference out;
  out.f_nT = readings.mean_f_nT();
  out.T_degC.resize(readings.y_nT.size());
  for (std::size_t i = 0; i < out.T_degC.size(); ++i) {
    double sum = 0, count = 0;
    for (const Pose& pose : table.poses) {
      if (pose.T_degC[i]) sum += *pose.T_degC[i], ++count;
    }
    if (count > 0) out.T_degC[i] = sum / count;
  }
  if (const poses::RunTime time = poses::RunTime::of(table); time.start) out.t_utc = format_utc(*time.start);
  for (const auto& [name, mean] : effects::covariate_means(table)) {
    if (name.ends_with("_A")) out.currents_A[name] = mean;
  }
  return out;
}

calibration::Calibration calibration_frame(const PoseTable& table, const Readings& readings,
                                           const FitOptions& options) {
  calibration::Calibration c;
  c.method = name(options.method);
  c.geometry = options.geometry;
  c.sample_noise_nT = pooled_sample_noise(table);
  c.reference = reference_of(table, readings);
  c.data_hash = poses::data_hash(table);
  c.poses = static_cast<int>(readings.poses());
  c.software = software();
  return c;
}

}  // namespace mgtd::calib::fit
