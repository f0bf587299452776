// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>

#include "calib/effects/level_terms.h"
#include "calib/fit/joint/joint_problem.h"

/// A PoseModel computes the readings that the measurement model predicts for a pose, exactly and with their
/// Jacobian. Levels in order: table, site, platform, sensor, axis.
namespace mgtd::calib::fit::joint {

/// The field that one sensor stands in.
struct SensorField {
  Eigen::Vector3d b_P_nT;
  Eigen::Matrix<double, 3, kNuisances> d_nuisance;
  Eigen::Matrix<double, 3, Eigen::Dynamic> d_global;
  effects::TermSum terms;  ///< of the level that is summed just now
};

struct PoseLinear {
  Channels y_nT;  ///< predicted readings
  /// Rows of sensor i by the parameters of sensor i.
  sensor::ChannelRows<sensor::kSensorParameters> d_sensor;
  sensor::ChannelRows<kNuisances> d_nuisance;
  Eigen::MatrixXd d_global;  ///< by slots kSiteSlot .. of the fixed block
  double f_nT{0};            ///< predicted |B(0)|
  Eigen::Matrix<double, 1, kNuisances> f_nuisance;
  Eigen::RowVectorXd f_global;
  SensorField field;  ///< at the last sensor: storage that is used again from pose to pose
};

/// By which unknowns a pose is differentiated: its own alone (d_nuisance, f_nuisance and the rows of the
/// scalar reference), or those of the fixed block too.
enum class Derivatives { own, fixed };

/// Holds everything that depends on the fixed block only; one is made per iteration. Keeps references to both
/// arguments.
class PoseModel {
 public:
  PoseModel(const JointProblem& problem, const JointState& state);
  /// With Derivatives::own d_sensor and d_global of `out` are left without meaning.
  void linearise(const JointPose& pose, const Nuisance& nuisance, PoseLinear& out,
                 Derivatives wanted = Derivatives::fixed) const;
  /// What the axes see, C A R' b without an offset: the input of effects at level axis. No derivatives.
  [[nodiscard]] Channels axis_inputs_nT(const JointPose& pose, const Nuisance& nuisance) const;

 private:
  struct Attitude;
  struct SensorGain {
    Eigen::Matrix3d gain;                   ///< C A R'
    std::array<Eigen::Matrix3d, 9> d_gain;  ///< by theta, phi, psi, cx, cy, cz, alpha, beta, gamma
  };
  [[nodiscard]] static SensorGain gain_of(const sensor::SensorModel& sensor);
  [[nodiscard]] Eigen::Matrix3d attitude(const JointPose& pose, const Nuisance& nuisance) const;
  void set_attitude(const JointPose& pose, const Nuisance& nuisance, Attitude& a) const;
  void add_site_columns(const Attitude& a, const Eigen::Vector3d& B_S, const Eigen::Matrix3d& dB_dx,
                        const Eigen::Vector3d& r_P_m, SensorField& field) const;
  void field_at(const JointPose& pose, const Attitude& a, int sensor, SensorField& field) const;
  void add_platform(const JointPose& pose, const Attitude& a, int sensor, SensorField& field) const;
  void scalar_field(const JointPose& pose, const Attitude& a, PoseLinear& out) const;
  [[nodiscard]] Eigen::RowVector3d reference_terms(const JointPose& pose, const Attitude& a,
                                                   const Eigen::Vector3d& B_S, PoseLinear& out) const;
  void read(const JointPose& pose, int sensor, SensorField& field, Derivatives wanted, PoseLinear& out) const;

  const JointState& state_;
  effects::LevelTerms table_, site_, platform_, axis_, reference_;
  PerSensor<SensorGain> gains_;
  PerSensor<Eigen::Vector3d> positions_P_m_;
  Eigen::Matrix<double, 3, 2> tangents_;
  Eigen::Matrix3d reference_turns_;
  int globals_;
  int of_field_;  ///< the first of them, which act on the field as it is at the sensors
  bool common_field_;
};

}  // namespace mgtd::calib::fit::joint
