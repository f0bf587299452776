// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cmath>
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

/// A JointProblem says what the joint fit observes and what it solves for (method, section 5).
///
/// Observations of pose k, each with its own standard deviation:
///     3N readings  y_i = axis(C_i A_i R_i' b_i) + I_i,   b_i = platform(R_k B(R_k' r_i))
///      1 scalar    F_k = |B(0)|; without a scalar reference F_k = F, one unknown for all poses
///      3 attitude  R_k = turn_by(w_k) T(table angles of k), w_k near 0
///      3 vector    b_k itself, where it was measured beside the sensors or made by a coil cage; the platform
///                  frame is then that of the reference, and the angles of the sensors are their misalignment
///      1 size      with table angles the vector r_k is that of a reference that stands still beside the
///                  table: B(0) = F_k R_SR r_k/|r_k|, R_SR unknown (reference_turn.h). |r_k| is F_k, unless
///                  there is a scalar reference; the noise of its direction adds to that of the attitude
/// Unknowns: the fixed block (12 per sensor, direction n and magnitude F of the site's field or, with a
/// reference beside the table, R_SR, coefficients of effects) and four nuisances a pose: w_k (3) and F_k
/// where B(0) = F_k n; or, for a pose without table angles, the field b_k (3) itself in the platform frame
/// and one idle slot.
namespace mgtd::calib::fit::joint {

inline constexpr int kNuisances = 4;
inline constexpr int kGlobals = 3;  ///< of every model: two tangents of n, F; effects come behind

/// Where the unknowns of the fixed block stand: the sensors, two tangents of n, F, then the effects. With a
/// reference beside the table the turn of R_SR about n stands in the place of F.
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
  // As long as the array has channels, not as the largest array has: a recording has tens of thousands of
  // poses, and a fit copies them many times.
  Eigen::VectorXd y_nT;
  Eigen::VectorXd weight;  ///< 1/sd of each reading; 0 leaves it out (outlier node)
  /// Part of that variance: of effects that remember the way of the table (memory_variance.h). Empty: none.
  Eigen::VectorXd memory_nT2{};
  double f_nT{0}, f_weight{0};  ///< scalar reference of this pose; with `common_field` its spread about F
  /// The field as a known vector: in frame P, or, of a reference beside the table, in its own axes.
  Eigen::Vector3d reference_nT{Eigen::Vector3d::Zero()};
  double reference_weight{0};  ///< 1/nT, of each component, or of the size alone; 0: not known
  double reference_sd_rad{0};  ///< of the direction that a reference beside the table shows
  /// f_nT is no reading of this pose: from the size of the vector (site_difference.h), or the field as known.
  bool filled_in{false};
  bool has_angles{false};
  Eigen::Matrix3d T{Eigen::Matrix3d::Identity()};  ///< table rotation at the recorded angles
  double attitude_weight{0};                       ///< 1/rad, of each component of w_k: weigh_attitude()
  const effects::CovariateMeans* means{nullptr};   ///< those of the problem

  [[nodiscard]] effects::Conditions conditions() const { return {*pose, t_h, previous, means}; }
  /// Observations beside readings and scalar reference, less the pose's own unknowns: with angles three of
  /// the attitude and perhaps the size of the field against four, else perhaps its vector against itself.
  [[nodiscard]] int beside() const {
    return has_angles ? (reference_weight > 0 ? 4 : 3) - 4 : reference_weight > 0 ? 3 - 3 : 0 - 3;
  }
  /// What the angles of the table and the direction of the field tell together about an attitude.
  void weigh_attitude(double table_sd_rad) {
    attitude_weight = 1 / std::hypot(table_sd_rad, reference_sd_rad);
  }
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
  double filled_in_sd_nT{0};        ///< of the error that is common to all poses `filled_in`
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
  /// The vector is in the platform frame, which is then defined by it.
  [[nodiscard]] bool platform_reference() const { return has_reference && !has_angles; }
  /// The vector is that of a reference which stands still beside the table: of every pose with its angles.
  [[nodiscard]] bool site_reference() const { return has_reference && has_angles; }
  /// Slots of the fixed block that no observation of any pose reaches.
  [[nodiscard]] std::vector<int> idle_slots() const;
  /// Unknowns of the site's field and of the reference in the fixed block.
  [[nodiscard]] int site_unknowns() const;
  /// Rows of a pose in the linearised fit: its readings, the scalar reference, the attitude; with a vector
  /// reference in the platform frame that in the place of the attitude, and one row more for the idle slot;
  /// with one beside the table one row more for its size. Where no pose knows its attitude, the idle slot
  /// alone stands in its place.
  [[nodiscard]] int pose_rows() const {
    return channels() + 1 + (has_angles || has_reference ? 3 : 1) + (has_reference ? 1 : 0);
  }
  [[nodiscard]] int fixed() const { return slots().effects() + coefficients(); }
};

struct JointState {
  PerSensor<sensor::SensorModel> sensors;
  Eigen::Vector3d direction{0, 0, 1};  ///< n, unit vector in the site frame; of its mean with R_SR
  /// From the axes of a reference beside the table to the site frame; set where there is one.
  std::optional<Eigen::Matrix3d> R_SR{};
  double f_nT{0};  ///< F, used with common_field
  Eigen::VectorXd coefficients;
  std::vector<Nuisance> nuisances;

  [[nodiscard]] FixedSlots slots() const { return {static_cast<int>(sensors.size())}; }
  /// The fixed block as a vector; the two slots of n hold zero (they are steps in its tangent plane).
  [[nodiscard]] Eigen::VectorXd fixed() const;
  /// x + step on the manifold: n moves in its tangent plane and is normalised; R_SR turns with it, and about
  /// it.
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
/// The rotation vectors, site frame, that the slots of R_SR stand for: the first two move n along its
/// tangents, the third turns about it.
[[nodiscard]] Eigen::Matrix3d reference_turns(const Eigen::Vector3d& n);

}  // namespace mgtd::calib::fit::joint
