// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/bootstrap.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace mgtd::calib {
namespace {

constexpr auto kCount = static_cast<std::size_t>(kSensors);

/// Draws that are the same with every standard library (std::normal_distribution is not).
class Gaussian {
 public:
  explicit Gaussian(std::uint64_t seed) : random_(seed) {}
  double operator()() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    // Box-Muller on 53-bit uniforms in (0, 1].
    const double u = (static_cast<double>(random_() >> 11U) + 1) * 0x1p-53;
    const double v = static_cast<double>(random_() >> 11U) * 0x1p-53;
    const double radius = std::sqrt(-2 * std::log(u));
    spare_ = radius * std::sin(2 * std::numbers::pi * v);
    has_spare_ = true;
    return radius * std::cos(2 * std::numbers::pi * v);
  }

 private:
  std::mt19937_64 random_;
  double spare_{0};
  bool has_spare_{false};
};

/// Where the field of every pose truly was, as far as the fit knows: direction by the table where its angles
/// are known, by the sensors elsewhere.
Eigen::Matrix3Xd fitted_directions(const Readings& readings, const TwoStep& fitted) {
  Eigen::Matrix3Xd out(3, readings.poses());
  for (Eigen::Index k = 0; k < readings.poses(); ++k) {
    const auto& angles = readings.angles[static_cast<std::size_t>(k)];
    if (angles) {
      out.col(k) = table_rotation(*angles) * fitted.site_direction();
      continue;
    }
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < kCount; ++i) sum += fitted.sensors[i].correct(readings.y_nT[i].col(k));
    out.col(k) = sum.normalized();
  }
  return out;
}

class Remeasure {
 public:
  Remeasure(const Readings& readings, const FitOptions& options, const TwoStep& fitted,
            const AxisNoise& noise)
      : readings_(readings),
        options_(options),
        fitted_(fitted),
        noise_(noise),
        direction_(fitted_directions(readings, fitted)),
        draw_(options.seed) {}

  [[nodiscard]] Readings operator()() {
    Readings out = readings_;
    const double common = options_.field_sd_nT * draw_();
    for (Eigen::Index k = 0; k < out.poses(); ++k) {
      const auto& angles = readings_.angles[static_cast<std::size_t>(k)];
      Eigen::Vector3d direction = direction_.col(k);
      if (angles) {
        const double sd = options_.table_sd_rad;
        const TableAngles true_angles{angles->azimuth_rad + sd * draw_(), angles->pitch_rad + sd * draw_(),
                                      angles->roll_rad + sd * draw_()};
        direction = table_rotation(true_angles) * fitted_.site_direction();
      }
      const double own = readings_.f_sd_nT[k];
      const double f = readings_.f_nT[k] + (own > 0 ? own * draw_() : common);
      for (std::size_t i = 0; i < kCount; ++i) {
        Eigen::Vector3d y = fitted_.sensors[i].predict(f * direction);
        for (int a = 0; a < 3; ++a) y[a] += noise_(static_cast<Eigen::Index>(i), a) * draw_();
        out.y_nT[i].col(k) = y;
      }
    }
    return out;
  }

 private:
  const Readings& readings_;
  const FitOptions& options_;
  const TwoStep& fitted_;
  const AxisNoise& noise_;
  Eigen::Matrix3Xd direction_;
  Gaussian draw_;
};

/// Parameters relative to the fitted ones. A replicate may choose a neighbouring mounting; seen from the
/// fitted one it differs little.
Eigen::Matrix<double, kArrayParameters, 1> difference(const TwoStep& replicate, const TwoStep& fitted) {
  Eigen::Matrix<double, kArrayParameters, 1> out;
  for (std::size_t i = 0; i < kCount; ++i) {
    ParameterVector d = replicate.sensors[i].parameters() - fitted.sensors[i].parameters();
    for (const int angle : {theta, phi, psi, alpha, beta, gamma})
      d[angle] = std::remainder(d[angle], 2 * std::numbers::pi);
    out.segment<kSensorParameters>(static_cast<Eigen::Index>(i) * kSensorParameters) = d;
  }
  return out;
}

double inclination(const TwoStep& t) { return std::asin(t.site_direction()[2]); }

}  // namespace

BootstrapResult bootstrap(const Readings& readings, const FitOptions& options, const TwoStep& fitted,
                          const AxisNoise& pose_noise_nT) {
  Remeasure remeasure(readings, options, fitted, pose_noise_nT);
  BootstrapResult out;
  ArrayCovariance sum = ArrayCovariance::Zero();
  double inclination_sum = 0, declination_sum = 0;
  for (int replicate = 0; replicate < options.replicates; ++replicate) {
    const auto again = two_step(remeasure(), options);
    if (!again) continue;
    const auto d = difference(*again, fitted);
    sum += d * d.transpose();
    inclination_sum += std::pow(inclination(*again) - inclination(fitted), 2);
    declination_sum += std::pow(
        std::remainder(again->origin.declination_rad - fitted.origin.declination_rad, 2 * std::numbers::pi),
        2);
    ++out.replicates;
  }
  const double n = std::max(1, out.replicates);
  out.covariance = sum / n;
  out.inclination_sd_rad = std::sqrt(inclination_sum / n);
  out.declination_sd_rad = std::sqrt(declination_sum / n);
  return out;
}

}  // namespace mgtd::calib
