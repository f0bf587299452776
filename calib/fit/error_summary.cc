// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/error_summary.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "calib/calibration/tensor.h"

namespace mgtd::calib::fit {
namespace {}  // namespace

FieldTable raw_fields(const Readings& readings) {
  FieldTable b(3 * static_cast<Eigen::Index>(readings.y_nT.size()), readings.poses());
  for (std::size_t i = 0; i < readings.y_nT.size(); ++i)
    b.middleRows<3>(3 * static_cast<Eigen::Index>(i)) = readings.y_nT[i];
  return b;
}

FieldTable corrected_fields(const Readings& readings, const PerSensor<sensor::SensorModel>& sensors) {
  FieldTable b(3 * static_cast<Eigen::Index>(readings.y_nT.size()), readings.poses());
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const Eigen::Matrix3d gain = sensors[i].R_PS() * sensors[i].response().inverse();
    b.middleRows<3>(3 * static_cast<Eigen::Index>(i)) =
        gain * (readings.y_nT[i].colwise() - sensors[i].offset_nT);
  }
  return b;
}

ErrorSummary summarise(const FieldTable& b_nT, const Eigen::VectorXd& f_nT, const sensor::Geometry& geometry,
                       const Counted& counted) {
  ErrorSummary out;
  const Eigen::Index n = b_nT.cols();
  const bool all = counted.tensor.size() != n;
  const auto mean = [](const Eigen::ArrayXd& squares, const Eigen::ArrayXd& weight) {
    return std::sqrt((squares * weight).sum() / std::max(1.0, weight.sum()));
  };
  out.total_field_rmse_nT.resize(geometry.sensors());
  for (std::size_t i = 0; i < geometry.sensors(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const Eigen::ArrayXd weight =
        all ? Eigen::ArrayXd::Ones(n) : Eigen::ArrayXd(counted.field.row(at).transpose().cast<double>());
    const Eigen::VectorXd strength = b_nT.middleRows<3>(3 * at).colwise().norm().transpose();
    out.total_field_rmse_nT[i] = mean((strength - f_nT).array().square(), weight);
  }
  const Eigen::ArrayXd weight =
      all ? Eigen::ArrayXd::Ones(n) : Eigen::ArrayXd(counted.tensor.transpose().cast<double>());
  const Eigen::MatrixXd tensor = calibration::gradient_rows(geometry) * b_nT;
  const auto rms = [&](Eigen::Index c) { return mean(tensor.row(c).transpose().array().square(), weight); };
  out.tensor_rmse_nT_per_m = {rms(0), rms(1), rms(2), rms(3), rms(4), rms(5)};
  return out;
}

double field_chi2(const FieldTable& b_nT, const Readings& readings,
                  const PerSensor<sensor::SensorModel>& sensors,
                  const calibration::AxisNoise& pose_noise_nT) {
  double chi2 = 0;
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    const Eigen::Matrix3d gain = sensors[i].R_PS() * sensors[i].response().inverse();
    const Eigen::Vector3d variance = pose_noise_nT.row(at).array().square();
    for (Eigen::Index k = 0; k < b_nT.cols(); ++k) {
      const Eigen::Vector3d b = b_nT.col(k).segment<3>(3 * at);
      const Eigen::Vector3d along = gain.transpose() * b.normalized();
      const double residual = b.norm() - readings.f_nT[k];
      chi2 +=
          residual * residual / (along.cwiseAbs2().dot(variance) + readings.f_sd_nT[k] * readings.f_sd_nT[k]);
    }
  }
  return chi2;
}

}  // namespace mgtd::calib::fit
