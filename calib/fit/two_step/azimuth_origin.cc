// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/two_step/azimuth_origin.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "calib/fit/orientation.h"
#include "calib/sensor/sensor_model.h"

namespace mgtd::calib::fit::two_step {
namespace {

/// A pose counts as tilted when its turn leaves Z by more than this.
constexpr double kTilted_rad = 2 * kRadiansPerDegree;
constexpr std::size_t kMinTilted = 3;

struct Tilted {
  Eigen::Matrix3d T;    ///< from the table's angles
  Eigen::Vector3d b_P;  ///< unit field by the sensors, D = 0
};

std::vector<Tilted> tilted_poses(const Readings& readings, const Alignment& alignment,
                                 const PerSensor<Eigen::Matrix3Xd>& b_S_nT) {
  std::vector<Tilted> out;
  for (Eigen::Index k = 0; k < readings.poses(); ++k) {
    const auto& angles = readings.angles[static_cast<std::size_t>(k)];
    if (!is_tilted(angles)) continue;
    const Eigen::Matrix3d T = table_rotation(*angles);
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < b_S_nT.size(); ++i) b += alignment.R_PS[i] * b_S_nT[i].col(k);
    out.push_back({T, b.normalized()});
  }
  return out;
}

/// Sum of cosines between measured and predicted fields when the true origin is D.
double agreement(const std::vector<Tilted>& poses, const Eigen::Vector3d& site, double declination) {
  const Eigen::Matrix3d S = sensor::rotation_z(-declination);
  const Eigen::Vector3d turned = S * site;
  double sum = 0;
  for (const Tilted& pose : poses) sum += (S * pose.b_P).dot(pose.T * turned);
  return sum;
}

/// Maximum of a trigonometric polynomial of degree two: a scan, then Newton steps by differences on its exact
/// form. Boost.Math's search for a minimum compares values only and ends at the root of the precision, 1e-8
/// rad.
double best_declination(const std::vector<Tilted>& poses, const Eigen::Vector3d& site) {
  constexpr int kScan = 72;
  constexpr double kStep = 2 * std::numbers::pi / kScan;
  double best = 0, best_value = -1e300;
  for (int i = 0; i < kScan; ++i) {
    const double value = agreement(poses, site, i * kStep);
    if (value > best_value) best_value = value, best = i * kStep;
  }
  for (int round = 0; round < 8; ++round) {
    constexpr double h = 1e-3;
    const double up = agreement(poses, site, best + h), here = agreement(poses, site, best),
                 down = agreement(poses, site, best - h);
    const double curvature = (up - 2 * here + down) / (h * h);
    if (!(curvature < 0)) break;
    best -= (up - down) / (2 * h) / curvature;
  }
  return std::remainder(best, 2 * std::numbers::pi);
}

/// Turn that makes the mean gamma zero.
double mean_gamma_declination(const Alignment& alignment) {
  double sine = 0, cosine = 0;
  for (const Eigen::Matrix3d& R : alignment.R_PS) {
    const sensor::SensorModel sensor = sensor_from(Eigen::Matrix3d::Identity(), Eigen::Vector3d::Zero(), R);
    sine += std::sin(sensor.gamma_rad);
    cosine += std::cos(sensor.gamma_rad);
  }
  // Turning by D takes D from every gamma.
  return std::atan2(sine, cosine);
}

}  // namespace

Eigen::Matrix3d table_rotation(const TableAngles& angles) {
  return sensor::rotation_z(angles.azimuth_rad) * sensor::rotation_y(angles.pitch_rad) *
         sensor::rotation_x(angles.roll_rad);
}

bool is_tilted(const std::optional<TableAngles>& angles) {
  return angles && std::acos(std::clamp(table_rotation(*angles)(2, 2), -1.0, 1.0)) >= kTilted_rad;
}

AzimuthOrigin azimuth_origin(const Readings& readings, const Alignment& alignment,
                             const PerSensor<Eigen::Matrix3Xd>& b_S_nT,
                             std::optional<double> declination_rad) {
  AzimuthOrigin out;
  const std::vector<Tilted> tilted = tilted_poses(readings, alignment, b_S_nT);
  const Eigen::Vector3d site = Eigen::Vector3d{alignment.bh_nT, 0, alignment.bz_nT}.normalized();
  if (declination_rad) {
    out.gauge = AzimuthGauge::declination_given;
    out.declination_rad = *declination_rad;
  } else if (tilted.size() >= kMinTilted) {
    out.gauge = AzimuthGauge::table_frame;
    out.declination_rad = best_declination(tilted, site);
  } else {
    out.declination_rad = mean_gamma_declination(alignment);
  }
  if (tilted.size() >= kMinTilted) {
    const double mean = agreement(tilted, site, out.declination_rad) / static_cast<double>(tilted.size());
    out.misfit_rad = std::sqrt(std::max(0.0, 2 * (1 - mean)));
  }
  return out;
}

void turn_to(Alignment& alignment, double declination_rad) {
  for (Eigen::Matrix3d& R : alignment.R_PS) R = sensor::rotation_z(-declination_rad) * R;
}

}  // namespace mgtd::calib::fit::two_step
