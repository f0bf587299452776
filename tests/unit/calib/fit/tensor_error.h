// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <random>
#include <vector>

#include "tests/unit/calib/fit/simulated_poses.h"

/// What a calibration's error does to the tensor on clean attitudes, and what a covariance says it should do.
namespace mgtd::calib::testing {

using Components = Eigen::Array<double, 6, 1>;  // xx yy zz xy xz yz

inline Components tensor_of(const PerSensor<Eigen::Vector3d>& b, double d_m) {
  const Eigen::Vector3d by_x = (b[0] - b[2]) / d_m, by_y = (b[1] - b[3]) / d_m;
  return {by_x[0], by_y[1], -by_x[0] - by_y[1], (by_x[1] + by_y[0]) / 2, by_x[2], by_y[2]};
}

/// Fields of strength f uniformly over the sphere, platform frame.
inline std::vector<Eigen::Vector3d> clean_fields(double f_nT, int count, std::uint64_t seed) {
  std::mt19937_64 rng(seed);
  std::normal_distribution<double> normal;
  std::vector<Eigen::Vector3d> out;
  for (int k = 0; k < count; ++k)
    out.push_back(f_nT * Eigen::Vector3d{normal(rng), normal(rng), normal(rng)}.normalized());
  return out;
}

/// Mean square of the six components in a uniform field, noise-free readings.
inline Components tensor_mean_square(const Rig& estimate, const Rig& truth,
                                     const std::vector<Eigen::Vector3d>& fields, double d_m = 0.4) {
  Components sum = Components::Zero();
  for (const Eigen::Vector3d& b : fields) {
    PerSensor<Eigen::Vector3d> corrected;
    for (std::size_t i = 0; i < kSensors; ++i) corrected[i] = estimate[i].correct(truth[i].predict(b));
    sum += tensor_of(corrected, d_m).square() / static_cast<double>(fields.size());
  }
  return sum;
}

/// The same expected from a covariance of the 48 parameters at the truth.
inline Components expected_mean_square(const Eigen::MatrixXd& covariance, const Rig& truth,
                                       const std::vector<Eigen::Vector3d>& fields, double d_m = 0.4) {
  constexpr int kAll = kSensors * sensor::kSensorParameters;
  Components sum = Components::Zero();
  for (const Eigen::Vector3d& b : fields) {
    Eigen::Matrix<double, 6, kAll> J;
    for (int j = 0; j < kAll; ++j) {
      const auto s = static_cast<std::size_t>(j / sensor::kSensorParameters);
      const int p = j % sensor::kSensorParameters;
      const double h = p >= sensor::ix && p <= sensor::iz ? 1.0 : 1e-6;
      PerSensor<Eigen::Vector3d> change{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(),
                                        Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
      const sensor::ParameterVector step = h * sensor::ParameterVector::Unit(p);
      const sensor::SensorModel up =
          sensor::SensorModel::from_parameters(truth[s].parameters() + step, truth[s].mounting);
      const sensor::SensorModel down =
          sensor::SensorModel::from_parameters(truth[s].parameters() - step, truth[s].mounting);
      const Eigen::Vector3d y = truth[s].predict(b);
      change[s] = (up.correct(y) - down.correct(y)) / (2 * h);
      J.col(j) = tensor_of(change, d_m).matrix();
    }
    sum += (J * covariance.topLeftCorner(kAll, kAll) * J.transpose()).diagonal().array() /
           static_cast<double>(fields.size());
  }
  return sum;
}

}  // namespace mgtd::calib::testing
