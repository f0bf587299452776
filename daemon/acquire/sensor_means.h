// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "calib/sensor/channels.h"
#include "proto/epoch.h"
#include "proto/sensors_report.h"

/// SensorMeans averages what each sensor reads, epoch by epoch, until it is asked. Sums are those of the
/// differences from the first reading y_1 of the sensor, so that a noise of pT in a field of 50 000 nT is not
/// lost in rounding:
///
///     mean = y_1 + S / n      sd^2 = (Q - S^2 / n) / (n - 1)      S = sum (y - y_1), Q = sum (y - y_1)^2
///
/// A reading that is no number counts for nothing. add() allocates nothing.
namespace mgtd::daemon::acquire {

class SensorMeans {
 public:
  /// `calibration`: id of the one that made `fields_P_nT`, the fields at the sensors one below the other;
  /// null: they are not looked at. `table`: where it stands, empty while it moves.
  void add(const Epoch& epoch, const std::shared_ptr<const std::string>& calibration,
           const calib::sensor::FieldVector& fields_P_nT, const std::optional<TableAngles>& table);

  /// The means since the last call; empty where no epoch came.
  [[nodiscard]] std::optional<SensorsReport> take();

 private:
  struct Sums {
    std::uint64_t epochs{0};
    Eigen::Vector3d first_nT{Eigen::Vector3d::Zero()}, sum_nT{Eigen::Vector3d::Zero()},
        squares_nT2{Eigen::Vector3d::Zero()};
    Eigen::Vector3d first_P_nT{Eigen::Vector3d::Zero()}, sum_P_nT{Eigen::Vector3d::Zero()};
  };

  bool begun_{false};
  std::uint64_t from_seq_{0}, to_seq_{0};
  WallTime t_{};
  std::shared_ptr<const std::string> calibration_;
  bool one_calibration_{true};  ///< made the fields of every epoch
  std::optional<TableAngles> table_;
  bool stands_{true};
  PerSensor<double> T_degC_;
  PerSensor<Sums> sums_;
};

}  // namespace mgtd::daemon::acquire
