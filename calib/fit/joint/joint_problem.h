// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <stop_token>
#include <vector>

#include "calib/calibration/tensor.h"
#include "calib/effects/library/library.h"
#include "calib/fit/fit_round.h"
#include "calib/sensor/geometry.h"
#include "calib/sensor/sensor_model.h"
#include "proto/pose.h"
#include "proto/units.h"

/// What the joint fit observes and what it solves for (method, section 5).
///
/// Observations of pose k, each with its own standard deviation:
///     3N readings  y_i = axis(C_i A_i R_i' b_i) + I_i,   b_i = platform(R_k B(R_k' r_i))
///      1 scalar    F_k = |B(0)|; without a scalar reference F_k = F, one unknown for all poses
///      3 attitude  R_k = turn_by(w_k) T(table angles of k), w_k near 0
///      3 vector    b_k itself, where it was measured beside the sensors or made by a coil cage; the platform
///                  frame is then that of the reference, and the angles of the sensors are their misalignment
/// Unknowns: the fixed block (12 per sensor, direction n and magnitude F of the site's field, coefficients of
/// effects) and four nuisances a pose: w_k (3) and F_k where B(0) = F_k n; or, for a pose without table
/// angles, the field b_k (3) itself in the platform frame and one idle slot.
namespace mgtd::calib::fit::joint {

inline constexpr int kNuisances = 4;
inline constexpr int kGlobals = 3;  ///< of every model: two tangents of n, F; effects come behind

/// Where the unknowns of the fixed block stand: the sensors, two tangents of n, F, then the effects.
struct FixedSlots {
  int sensors{kSensors};

  [[nodiscard]] int channels() const { return 3 * sensors; }
  [[nodiscard]] int sensor_block() const { return sensors * sensor::kSensorParameters; }
  [[nodiscard]] int site() const { return sensor_block(); }
  [[nodiscard]] int field() const { return site() + 2; }
  [[nodiscard]] int effects() const { return sensor_block() + kGlobals; }
};

using Channels = sensor::FieldVector;
using Nuisance = Eigen::Matrix<double, kNuisances, 1>;

/// Weight of an attitude that is not believed: 30 degrees, enough to keep the turn about the field defined.
inline constexpr double kLooseAttitude_per_rad = 1 / to_rad(30);

struct JointPose {
  const Pose* pose{nullptr};
  const Pose* previous{nullptr};
  double t_h{0};
  Channels y_nT;
  Channels weight;              ///< 1/sd of each reading; 0 leaves it out (outlier node)
  double f_nT{0}, f_weight{0};  ///< scalar reference of this pose; with `common_field` its spread about F
  Eigen::Vector3d reference_nT{Eigen::Vector3d::Zero()};  ///< the field as a known vector, frame P
  double reference_weight{0};                             ///< 1/nT, of each component; 0: not known
  bool has_angles{false};
  Eigen::Matrix3d T{Eigen::Matrix3d::Identity()};  ///< table rotation at the recorded angles
  double attitude_weight{0};                       ///< 1/rad, of each component of w_k
  const effects::CovariateMeans* means{nullptr};   ///< those of the problem

  [[nodiscard]] effects::Conditions conditions() const { return {*pose, t_h, previous, means}; }
};

/// A Gaussian observation of a linear form of the fixed block: row' x = target.
struct LinearPrior {
  Eigen::VectorXd row;
  double target{0};
  double weight{0};
};

struct JointProblem {
  sensor::Geometry geometry;
  std::vector<effects::EffectPtr> effects;
  std::shared_ptr<const effects::CovariateMeans> means;  ///< over the poses that are fitted
  std::vector<JointPose> poses;
  bool common_field{false};         ///< no scalar reference: F_k is F within 1/f_weight
  bool has_angles{false};           ///< at least one pose has table angles
  bool has_reference{false};        ///< of every pose the field is known as a vector
  std::vector<LinearPrior> priors;  ///< gauge, coefficients, known field
  /// Of the site's field, from the operator; and the weight of both, 1/rad.
  std::optional<double> known_inclination_rad, known_declination_rad;
  double direction_weight{0};
  std::stop_token stop{};    ///< of FitOptions
  RoundListener on_round{};  ///< of FitOptions

  [[nodiscard]] int coefficients() const;
  [[nodiscard]] FixedSlots slots() const { return {static_cast<int>(geometry.sensors())}; }
  [[nodiscard]] int sensors() const { return slots().sensors; }
  [[nodiscard]] int channels() const { return slots().channels(); }
  /// Rows of a pose in the linearised fit: its readings, the scalar reference, the attitude; with a vector
  /// reference that in the place of the attitude, and one row more for the idle slot.
  [[nodiscard]] int pose_rows() const { return channels() + kNuisances + (has_reference ? 1 : 0); }
  [[nodiscard]] int fixed() const { return slots().effects() + coefficients(); }
};

struct JointState {
  PerSensor<sensor::SensorModel> sensors;
  Eigen::Vector3d direction{0, 0, 1};  ///< n, unit vector in the site frame
  double f_nT{0};                      ///< F, used with common_field
  Eigen::VectorXd coefficients;
  std::vector<Nuisance> nuisances;

  [[nodiscard]] FixedSlots slots() const { return {static_cast<int>(sensors.size())}; }
  /// The fixed block as a vector; the two slots of n hold zero (they are steps in its tangent plane).
  [[nodiscard]] Eigen::VectorXd fixed() const;
  /// x + step on the manifold: n moves in its tangent plane and is normalised.
  [[nodiscard]] JointState moved(const Eigen::VectorXd& step) const;
};

/// Inclination and declination of a direction: positive towards +Z, and from X towards Y.
[[nodiscard]] double inclination_of(const Eigen::Vector3d& n);
[[nodiscard]] double declination_of(const Eigen::Vector3d& n);
[[nodiscard]] Eigen::Vector3d direction_of(double inclination_rad, double declination_rad);
/// Their derivatives by the two slots of n, rows.
[[nodiscard]] Eigen::Matrix2d inclination_declination_rows(const Eigen::Vector3d& n);

/// Two orthonormal tangents of the unit sphere at n, columns.
[[nodiscard]] Eigen::Matrix<double, 3, 2> tangents(const Eigen::Vector3d& n);

}  // namespace mgtd::calib::fit::joint
