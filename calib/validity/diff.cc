// SPDX-License-Identifier: Apache-2.0
#include "calib/validity/diff.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "calib/calibration/scale_gauge.h"
#include "calib/fit/orientation.h"
#include "calib/linear/propagation.h"
#include "proto/units.h"

namespace mgtd::calib::validity {
namespace {

/// The 48 parameters and the coefficients of these effects, with their covariance.
struct Side {
  Eigen::VectorXd x;
  Eigen::MatrixXd C;
};

Side side_of(const calibration::Calibration& c, const PerSensor<sensor::SensorModel>& sensors,
             const std::vector<calibration::CalibratedEffect>& shared) {
  std::vector<double> x;
  std::vector<Eigen::Index> slots;
  const Eigen::Index parameters = c.covariance.rows();
  for (const sensor::SensorModel& sensor : sensors) {
    for (const double value : sensor.parameters()) x.push_back(value);
  }
  for (Eigen::Index slot = 0; slot < parameters; ++slot) slots.push_back(slot);
  for (const calibration::CalibratedEffect& wanted : shared) {
    Eigen::Index slot = parameters;
    for (const calibration::CalibratedEffect& own : c.effects) {
      for (const calibration::EffectCoefficient& coefficient : own.coefficients) {
        if (own.effect == wanted.effect) {
          x.push_back(coefficient.value);
          slots.push_back(slot);
        }
        ++slot;
      }
    }
  }
  return {Eigen::Map<const Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(x.size())),
          calibration::full_covariance(c)(slots, slots)};
}

/// Effects that both have; the others are named in `report`.
std::vector<calibration::CalibratedEffect> shared_effects(const calibration::Calibration& a,
                                                          const calibration::Calibration& b,
                                                          DiffReport& report) {
  std::vector<calibration::CalibratedEffect> out;
  const auto has = [](const calibration::Calibration& c, const calibration::CalibratedEffect& e) {
    return std::any_of(c.effects.begin(), c.effects.end(), [&](const calibration::CalibratedEffect& o) {
      return o.effect == e.effect && o.coefficients.size() == e.coefficients.size();
    });
  };
  for (const calibration::CalibratedEffect& e : a.effects) {
    if (has(b, e)) {
      out.push_back(e);
    } else {
      report.only_in_first.push_back(e.effect);
    }
  }
  for (const calibration::CalibratedEffect& e : b.effects) {
    if (!has(a, e)) report.only_in_second.push_back(e.effect);
  }
  return out;
}

/// The rotation that brings the platform frame of b onto that of a, as most of the sensors see it: one that
/// was turned by itself or rewired does not count.
Eigen::Matrix3d turn_back(const calibration::Calibration& a, const calibration::Calibration& b) {
  constexpr double kTogether_rad = 5 * kRadiansPerDegree;
  PerSensor<Eigen::Matrix3d> each(a.sensors.size());
  for (std::size_t i = 0; i < each.size(); ++i)
    each[i] = a.sensors[i].R_PS() * b.sensors[i].R_PS().transpose();
  const auto together = [&](const Eigen::Matrix3d& P, const Eigen::Matrix3d& Q) {
    return std::acos(std::clamp(((P.transpose() * Q).trace() - 1) / 2, -1.0, 1.0)) < kTogether_rad;
  };
  Eigen::Matrix3d sum = Eigen::Matrix3d::Identity();
  std::ptrdiff_t most = 0;
  for (const Eigen::Matrix3d& centre : each) {
    if (centre.determinant() < 0) continue;
    const auto count =
        std::count_if(each.begin(), each.end(), [&](const auto& Q) { return together(centre, Q); });
    if (count <= most) continue;
    most = count;
    sum.setZero();
    for (const Eigen::Matrix3d& Q : each) {
      if (together(centre, Q)) sum += Q;
    }
  }
  return fit::nearest_orthogonal(sum, false);
}

/// Of the mean of the sensors, about X, Y and Z.
Eigen::Vector3d turn_sd_rad(const Eigen::MatrixXd& covariance, int sensors) {
  Eigen::Vector3d out;
  for (int axis = 0; axis < 3; ++axis) {
    double variance = 0;
    for (int i = 0; i < sensors; ++i) {
      for (int j = 0; j < sensors; ++j) {
        variance += covariance(sensor::kSensorParameters * i + sensor::alpha + axis,
                               sensor::kSensorParameters * j + sensor::alpha + axis) /
                    (sensors * sensors);
      }
    }
    out[axis] = std::sqrt(variance);
  }
  return out;
}

}  // namespace

DiffReport diff(const calibration::Calibration& a, const calibration::Calibration& b) {
  DiffReport out;
  const auto shared = shared_effects(a, b, out);
  const Eigen::Matrix3d Q = turn_back(a, b);
  const TurnedArray placed = turned(b.sensors, Q);
  for (std::size_t i = 0; i < a.sensors.size(); ++i)
    if (a.sensors[i].mounting != placed.sensors[i].mounting) out.remounted.push_back(i);
  const Side from = side_of(a, a.sensors, shared), to = side_of(b, placed.sensors, shared);
  const Eigen::Index n = to.x.size();
  Eigen::MatrixXd J = Eigen::MatrixXd::Identity(n, n);
  J.topLeftCorner(placed.jacobian.rows(), placed.jacobian.rows()) = placed.jacobian;
  out.scale_taken_out = calibration::scale_is_free(a) || calibration::scale_is_free(b);
  const Eigen::MatrixXd C =
      small_sample_factor(a.poses, a.sensors.size()) * from.C +
      small_sample_factor(b.poses, b.sensors.size()) * linear::propagated_covariance(J, to.C);
  out.change = judge({.difference = to.x - from.x,
                      .covariance = C,
                      .gain = Eigen::MatrixXd::Identity(n, n),
                      .common = common_freedoms(a.sensors, n, out.scale_taken_out),
                      .slots = shown_slots(a.sensors.size(), shared),
                      .sensors = a.sensors.size()});
  out.changed = !out.remounted.empty() || out.change.p() < kChanged;
  out.turn = common_turn(Q.transpose(), turn_sd_rad(C, static_cast<int>(a.sensors.size())));
  return out;
}

}  // namespace mgtd::calib::validity
