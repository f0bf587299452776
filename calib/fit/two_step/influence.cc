// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/two_step/influence.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "calib/calibration/field_derivative.h"
#include "calib/linear/inverse.h"
#include "calib/linear/propagation.h"

namespace mgtd::calib::fit::two_step {
namespace {

constexpr int kScalar = 9;  ///< parameters of step 1

/// Per sensor nine of step 1 and three of the turn w, then the two of the site. First only what reaches a
/// slot directly; what comes through step 1 or through w is added at the end, by one matrix.
using Slots = Eigen::VectorXd;
using Mixing = Eigen::MatrixXd;
using ScalarRow = Eigen::Matrix<double, 1, kScalar>;
using ScalarDerivative = Eigen::Matrix<double, 3, kScalar>;

constexpr int slot_of(std::size_t sensor) { return static_cast<int>(sensor) * sensor::kSensorParameters; }

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0;
  return m;
}

/// d(T B)/d(azimuth, pitch, roll) at b = T B.
Eigen::Matrix3d table_derivative(const TableAngles& angles, const Eigen::Vector3d& b_P) {
  const Eigen::Matrix3d Rz = sensor::rotation_z(angles.azimuth_rad),
                        RzRy = Rz * sensor::rotation_y(angles.pitch_rad);
  Eigen::Matrix3d d;
  d << -Eigen::Vector3d::UnitZ().cross(b_P), -Rz.col(1).cross(b_P), -RzRy.col(0).cross(b_P);
  return d;
}

class Propagation {
 public:
  Propagation(const Readings& readings, const FitOptions& options, const TwoStep& fitted,
              const calibration::AxisNoise& noise);
  [[nodiscard]] Influence result();

 private:
  void prepare_sensor(std::size_t i);
  void prepare_origin();
  void add_pose(Eigen::Index k);
  void add_readings(Eigen::Index k, std::size_t i);
  [[nodiscard]] ScalarDerivative derivative(std::size_t i, Eigen::Index k) const {
    return calibration::field_derivative(fitted_.sensors[i], b_[i].col(k)).leftCols<kScalar>();
  }
  /// What an error db of the field seen by sensor i at pose k does directly: rows of w_i, sine, origin.
  struct FieldRows {
    Eigen::Matrix3d turn{Eigen::Matrix3d::Zero()};
    Eigen::RowVector3d sine{Eigen::RowVector3d::Zero()}, origin{Eigen::RowVector3d::Zero()};
  };
  [[nodiscard]] FieldRows rows_of(std::size_t i, Eigen::Index k) const;
  [[nodiscard]] Mixing angles_from_turns() const;
  [[nodiscard]] Mixing origin_from_all() const;

  const Readings& readings_;
  const FitOptions& options_;
  const TwoStep& fitted_;
  const calibration::AxisNoise& noise_;
  double f_nT_;
  Eigen::Vector3d site_;                 ///< unit field at zero angles
  int sensors_, sine_, origin_, slots_;  ///< slots of the sine of the inclination and of the declination; all
  PerSensor<Eigen::Matrix3d> gain_;
  PerSensor<Eigen::Matrix3Xd> b_;  ///< corrected fields, platform frame
  PerSensor<Eigen::Matrix3Xd> m_;  ///< zero columns where the pose is not of the turn
  PerSensor<Eigen::Matrix<double, kScalar, Eigen::Dynamic>> weight_;  ///< dp per nT of |b| - F
  Eigen::Matrix3Xd
      origin_weight_;  ///< dD per unit of the direction; zero columns where the pose does not count
  Mixing through_step1_;
  Eigen::RowVectorXd origin_row_;
  Mixing direct_;       ///< covariance of the directly reached
  Slots common_field_;  ///< of one nT of the field given by the operator
};

Propagation::Propagation(const Readings& readings, const FitOptions& options, const TwoStep& fitted,
                         const calibration::AxisNoise& noise)
    : readings_(readings),
      options_(options),
      fitted_(fitted),
      noise_(noise),
      f_nT_(readings.mean_f_nT()),
      site_(fitted.site_direction()),
      sensors_(static_cast<int>(fitted.sensors.size())),
      sine_(sensors_ * sensor::kSensorParameters),
      origin_(sine_ + 1),
      slots_(sine_ + 2),
      gain_(fitted.sensors.size()),
      b_(fitted.sensors.size()),
      m_(fitted.sensors.size()),
      weight_(fitted.sensors.size()),
      origin_weight_(Eigen::Matrix3Xd::Zero(3, readings.poses())),
      through_step1_(Mixing::Identity(slots_, slots_)),
      origin_row_(Eigen::RowVectorXd::Unit(slots_, origin_)),
      direct_(Mixing::Zero(slots_, slots_)),
      common_field_(Slots::Zero(slots_)) {
  for (std::size_t i = 0; i < fitted_.sensors.size(); ++i) prepare_sensor(i);
  if (fitted.origin.gauge == AzimuthGauge::table_frame) prepare_origin();
  for (std::size_t i = 0; i < fitted_.sensors.size(); ++i) {
    for (Eigen::Index k = 0; k < readings_.poses(); ++k) {
      const FieldRows rows = rows_of(i, k);
      const ScalarDerivative D = derivative(i, k);
      through_step1_.block<3, kScalar>(slot_of(i) + kScalar, slot_of(i)) += rows.turn * D;
      through_step1_.block<1, kScalar>(sine_, slot_of(i)) += rows.sine * D;
      origin_row_.segment<kScalar>(slot_of(i)) += rows.origin * D;
      // The turn w_i moves every field of the sensor by w x b.
      origin_row_.segment<3>(slot_of(i) + kScalar) -= rows.origin * cross_matrix(b_[i].col(k));
    }
  }
}

void Propagation::prepare_sensor(std::size_t i) {
  const sensor::SensorModel& sensor = fitted_.sensors[i];
  const Eigen::Index n = readings_.poses();
  gain_[i] = sensor.R_PS() * sensor.response().inverse();
  b_[i] = gain_[i] * (readings_.y_nT[i].colwise() - sensor.offset_nT);
  Eigen::Matrix<double, kScalar, Eigen::Dynamic> J(kScalar, n);
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  m_[i] = Eigen::Matrix3Xd::Zero(3, n);
  for (Eigen::Index k = 0; k < n; ++k) {
    J.col(k) = (b_[i].col(k).normalized().transpose() * derivative(i, k)).transpose();
    if (!readings_.of_turn(k)) continue;
    m_[i].col(k) = b_[i].col(k);
    scatter += b_[i].col(k) * b_[i].col(k).transpose();
  }
  // Columns of J differ by the size of the field: scaled before the normal matrix is inverted.
  const Eigen::Matrix<double, kScalar, 1> size = J.rowwise().norm().cwiseInverse();
  J = size.asDiagonal() * J;
  const Eigen::Matrix<double, kScalar, kScalar> normal = J * J.transpose();
  weight_[i] = -(size.asDiagonal() * (linear::inverse_by_lu(normal) * J));
  m_[i] = scatter.inverse() * m_[i];
}

/// Sum over tilted poses of |S b_k - T_k S s|^2 is least in the azimuth origin: with g_k its derivative, a
/// change e_k of the difference moves it by -sum g.e / sum g.g.
void Propagation::prepare_origin() {
  const Eigen::Vector3d across = Eigen::Vector3d::UnitZ().cross(site_);
  const double horizontal = std::hypot(site_[0], site_[1]);
  const Eigen::Vector3d by_sine =
      Eigen::Vector3d{-site_[2] * site_[0], -site_[2] * site_[1], horizontal * horizontal} /
      (horizontal * horizontal);
  double sum = 0, sine = 0;
  for (Eigen::Index k = 0; k < readings_.poses(); ++k) {
    if (!is_tilted(readings_.angles[static_cast<std::size_t>(k)])) continue;
    const Eigen::Matrix3d T = table_rotation(*readings_.angles[static_cast<std::size_t>(k)]);
    const Eigen::Vector3d g = Eigen::Vector3d::UnitZ().cross(T * site_) - T * across;
    sum += g.squaredNorm();
    sine += g.dot(T * by_sine);
    origin_weight_.col(k) = -g;
  }
  origin_weight_ /= sum;
  origin_row_[sine_] = sine / sum;
}

Propagation::FieldRows Propagation::rows_of(std::size_t i, Eigen::Index k) const {
  FieldRows rows;
  if (readings_.of_turn(k)) {
    const Eigen::Vector3d m = m_[i].col(k);
    rows.turn = -0.5 * cross_matrix(m);
    rows.sine[2] = site_[2] * m[2] / sensors_;
  }
  rows.origin = origin_weight_.col(k).transpose() / (sensors_ * readings_.f_nT[k]);
  return rows;
}

void Propagation::add_readings(Eigen::Index k, std::size_t i) {
  const FieldRows rows = rows_of(i, k);
  const Eigen::Matrix3d by_axis = gain_[i] * noise_.row(static_cast<Eigen::Index>(i)).asDiagonal();
  Eigen::Matrix<double, sensor::kSensorParameters + 2, 3> a;
  a.topRows<kScalar>() = weight_[i].col(k) * (b_[i].col(k).normalized().transpose() * by_axis);
  a.middleRows<3>(kScalar) = rows.turn * by_axis;
  a.row(sensor::kSensorParameters) = rows.sine * by_axis;
  a.row(sensor::kSensorParameters + 1) = rows.origin * by_axis;
  const Eigen::Matrix<double, sensor::kSensorParameters + 2, sensor::kSensorParameters + 2> c =
      a * a.transpose();
  const int at = slot_of(i);
  direct_.block<sensor::kSensorParameters, sensor::kSensorParameters>(at, at) += c.topLeftCorner<12, 12>();
  direct_.block<sensor::kSensorParameters, 2>(at, sine_) += c.topRightCorner<12, 2>();
  direct_.block<2, sensor::kSensorParameters>(sine_, at) += c.bottomLeftCorner<2, 12>();
  direct_.block<2, 2>(sine_, sine_) += c.bottomRightCorner<2, 2>();
}

void Propagation::add_pose(Eigen::Index k) {
  const auto& angles = readings_.angles[static_cast<std::size_t>(k)];
  Slots by_field = Slots::Zero(slots_);
  Eigen::Matrix<double, Eigen::Dynamic, 3> by_table =
      Eigen::Matrix<double, Eigen::Dynamic, 3>::Zero(slots_, 3);
  for (std::size_t i = 0; i < fitted_.sensors.size(); ++i) {
    add_readings(k, i);
    const FieldRows rows = rows_of(i, k);
    // Step 2 sees the field divided by F_k.
    const Eigen::Vector3d relative = -b_[i].col(k) / readings_.f_nT[k];
    by_field.segment<kScalar>(slot_of(i)) = -weight_[i].col(k);
    by_field.segment<3>(slot_of(i) + kScalar) = rows.turn * relative;
    by_field[sine_] += rows.sine.dot(relative);
    if (!angles) continue;
    const Eigen::Matrix3d turned = table_derivative(*angles, b_[i].col(k));
    by_table.middleRows<3>(slot_of(i) + kScalar) = rows.turn * turned;
    by_table.row(sine_) += rows.sine * turned;
    by_table.row(origin_) += rows.origin * turned;
  }
  by_table *= options_.table_sd_rad;
  if (angles) direct_ += by_table * by_table.transpose();
  const double own = readings_.f_sd_nT[k];
  if (own > 0) {
    direct_ += own * own * by_field * by_field.transpose();
  } else {
    common_field_ += by_field;
  }
}

/// The origin of the azimuth answers to the turns and the sine, which answer to step 1.
Mixing Propagation::origin_from_all() const {
  Mixing out = Mixing::Identity(slots_, slots_);
  out.row(origin_) = origin_row_;
  if (fitted_.origin.gauge != AzimuthGauge::mean_gamma_zero) return out;
  // gamma answers to a turn about z by -1 in every sensor: the origin takes up the mean.
  out.row(origin_).setZero();
  for (std::size_t i = 0; i < fitted_.sensors.size(); ++i) {
    const Eigen::Matrix3d to_angles = calibration::turn_axes(fitted_.sensors[i]).inverse();
    out.block<1, 3>(origin_, slot_of(i) + kScalar) = to_angles.row(2) / sensors_;
  }
  return out;
}

Mixing Propagation::angles_from_turns() const {
  Mixing out = Mixing::Identity(slots_, slots_);
  for (std::size_t i = 0; i < fitted_.sensors.size(); ++i) {
    const Eigen::Matrix3d to_angles = calibration::turn_axes(fitted_.sensors[i]).inverse();
    const int at = slot_of(i) + kScalar;
    out.block<3, 3>(at, at) = to_angles;
    out.block<3, 1>(at, origin_) = to_angles.col(2);
  }
  return out;
}

Influence Propagation::result() {
  for (Eigen::Index k = 0; k < readings_.poses(); ++k) add_pose(k);
  direct_ += options_.field_sd_nT * options_.field_sd_nT * common_field_ * common_field_.transpose();
  const Mixing all = angles_from_turns() * origin_from_all() * through_step1_;
  const Mixing covariance = linear::propagated_covariance(all, direct_);
  Influence out;
  out.covariance = covariance.topLeftCorner(sine_, sine_);
  out.covariance = 0.5 * (out.covariance + out.covariance.transpose()).eval();
  out.inclination_sd_rad = std::sqrt(covariance(sine_, sine_)) / std::hypot(site_[0], site_[1]);
  out.declination_sd_rad = std::sqrt(covariance(origin_, origin_));
  return out;
}

}  // namespace

Influence influence(const Readings& readings, const FitOptions& options, const TwoStep& fitted,
                    const calibration::AxisNoise& pose_noise_nT) {
  return Propagation(readings, options, fitted, pose_noise_nT).result();
}

}  // namespace mgtd::calib::fit::two_step
