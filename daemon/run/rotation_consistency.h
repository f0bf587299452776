// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "proto/pose.h"
#include "proto/reading.h"

/// RotationConsistency checks whether an angle that was entered by hand agrees with the turn of the field.
///
/// Between two poses the field turns, in the eyes of a sensor, by the angle between its two readings, however
/// the sensor is mounted. The entered attitudes R_j, R_k say n' R_j' R_k n for its cosine, n the direction of
/// the field at the site. n is fitted to all pairs of the poses so far and the new one; what remains of the
/// new one, in the middle of its pairs, is its disagreement: one wrong pose among the earlier ones does no
/// harm. Sensors that are not calibrated yet turn a direction by a degree (offsets of 1 % of the field), so
/// blunders are seen and readings to a degree are not judged.
namespace mgtd::daemon::run {

struct RotationFinding {
  bool agrees{true};
  int against{0};          ///< pose with which it disagrees most
  double measured_rad{0};  ///< turn of the field since that pose
  double entered_rad{0};   ///< by the angles
};

class RotationConsistency {
 public:
  static constexpr double kLimit_rad = 0.07;  ///< 4 deg, median over the poses so far

  void add(const Pose& pose);
  /// Takes a pose out again that is to be measured anew.
  void remove(int number);
  [[nodiscard]] RotationFinding judge(const Pose& pose) const;

 private:
  struct Seen {
    int number;
    Eigen::Matrix3d R;
    PerSensor<Eigen::Vector3d> u;  ///< directions of the readings
  };
  [[nodiscard]] static Seen seen(const Pose& pose);

  std::vector<Seen> poses_;
};

}  // namespace mgtd::daemon::run
