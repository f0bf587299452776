// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>

#include "proto/per_sensor.h"

/// A Geometry says where the sensors sit: it holds their places in the platform frame O-XYZ, metres. The
/// field and its gradient are those at the origin O.
namespace mgtd::calib::sensor {

class Geometry {
 public:
  static constexpr double kBaseline_m = 0.4;

  Geometry() : Geometry(kBaseline_m) {}
  /// The planar cross with `baseline_m` between opposite sensors, d:
  /// s1 (+d/2,0,0), s2 (0,+d/2,0), s3 (-d/2,0,0), s4 (0,-d/2,0).
  explicit Geometry(double baseline_m) {
    const double h = baseline_m / 2;
    places_P_m_ = {Eigen::Vector3d{h, 0, 0}, Eigen::Vector3d{0, h, 0}, Eigen::Vector3d{-h, 0, 0},
                   Eigen::Vector3d{0, -h, 0}};
  }
  /// Any array of 1 to kMostSensors sensors.
  explicit Geometry(const PerSensor<Eigen::Vector3d>& places_P_m) : places_P_m_(places_P_m) {}

  [[nodiscard]] const PerSensor<Eigen::Vector3d>& positions_P_m() const { return places_P_m_; }
  [[nodiscard]] std::size_t sensors() const { return places_P_m_.size(); }
  [[nodiscard]] Eigen::Index channels() const { return 3 * static_cast<Eigen::Index>(sensors()); }
  /// The baseline where the array is the cross, sensors in its order; exact, no tolerance.
  [[nodiscard]] std::optional<double> cross_baseline_m() const {
    if (sensors() != kSensorCount) return std::nullopt;
    const double d = 2 * places_P_m_[0][0];
    if (d >= 0 && *this == Geometry(d)) return d;
    return std::nullopt;
  }
  /// As many sensors, and none further than `within_m` from its place in the other.
  [[nodiscard]] bool agrees_with(const Geometry& other, double within_m = 1e-6) const {
    if (sensors() != other.sensors()) return false;
    for (std::size_t i = 0; i < sensors(); ++i)
      if ((places_P_m_[i] - other.places_P_m_[i]).norm() > within_m) return false;
    return true;
  }
  friend bool operator==(const Geometry& a, const Geometry& b) { return a.places_P_m_ == b.places_P_m_; }

 private:
  PerSensor<Eigen::Vector3d> places_P_m_;
};

}  // namespace mgtd::calib::sensor
