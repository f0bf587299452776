// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "calib/calibration/calibration.h"

/// A Change is a difference of two sets of parameters, judged against its covariance.
namespace mgtd::calib::validity {

/// Probability below which a difference is called a change.
inline constexpr double kChanged = 0.01;

/// A change of one parameter, all others as they were: what it would have to be, and how likely.
struct ParameterChange {
  std::string name;  ///< "s3 iz", "site.gradient Gxx"
  double change{0}, sd{0};
  std::string unit;   ///< "deg", "nT", "" for scale factors
  double sigmas{0};   ///< change / sd, signed
  double log10_p{0};  ///< of so many sigmas or more somewhere among all parameters compared
  double seen{0};     ///< smallest change that is found in 80 of 100 cases; infinite when it cannot show
  /// The difference as it is, whatever else changed, and its standard error; the common freedoms are taken
  /// out. 0 and 0 where the difference is no parameter's alone.
  double moved{0}, moved_sd{0};
};

struct Change {
  double chi2{0}, dof{0}, log10_p{0};  ///< that nothing changed: all parameters together
  double log10_p_single{0};  ///< the same by the parameter that accounts for most, corrected for the choice
  PerSensor<double> others_log10_p{};  ///< that nothing but this sensor changed
  /// Largest |sigmas| first; without the turn of a sensor that is alone, which is a turn of the whole array.
  std::vector<ParameterChange> parameters;
  /// The fewest parameters that account for the difference, in the order in which they were found, each with
  /// its change when these alone changed. Empty when nothing changed or when it is spread over many.
  std::vector<ParameterChange> named;

  /// That nothing changed: the better of both tests, corrected for having two. Changed below kChanged.
  [[nodiscard]] double p() const;
};

/// Names and units of the parameters of all sensors and of these effects, with the factor from the inside
/// unit to the one shown.
struct ShownSlot {
  std::string name, unit;
  double factor;
};
[[nodiscard]] std::vector<ShownSlot> shown_slots(std::size_t sensors,
                                                 const std::vector<calibration::CalibratedEffect>& effects);

/// Expected true over estimated variance when the noise of each axis comes from the residuals of so many
/// poses of so many sensors: a covariance taken at its word would call an unchanged rig changed a little too
/// often.
[[nodiscard]] double small_sample_factor(int poses, std::size_t sensors);

/// The sensors in a platform frame turned by Q, and what that does to their parameters.
struct TurnedArray {
  PerSensor<sensor::SensorModel> sensors;
  Eigen::MatrixXd jacobian;
};
[[nodiscard]] TurnedArray turned(const PerSensor<sensor::SensorModel>& sensors, const Eigen::Matrix3d& Q);

/// Columns: what a small common rotation of the array (and, with `free_scale`, a common scale) does to the
/// parameters.
[[nodiscard]] Eigen::MatrixXd common_freedoms(const PerSensor<sensor::SensorModel>& sensors,
                                              Eigen::Index slots, bool free_scale);

/// Inverse on the range of a covariance or an information, in units of its diagonal: directions whose
/// eigenvalue is nothing but rounding (or a convention) are left out.
struct Inverse {
  Eigen::MatrixXd W;
  Eigen::Index rank{0};
};
[[nodiscard]] Inverse inverse_of(const Eigen::MatrixXd& C);

/// Observed: difference = gain * (what changed) + common * (anything) + an error with this covariance.
struct Evidence {
  Eigen::VectorXd difference;
  Eigen::MatrixXd covariance, gain, common;
  std::vector<ShownSlot> slots;
  std::size_t sensors{kSensorCount};
};

/// A turn of the whole array on its table or in its cage, which is no change of the array: rotation vector in
/// the platform frame, in the sense of alpha, beta and gamma, and its standard deviation, about X, Y and Z.
struct CommonTurn {
  Eigen::Vector3d about_rad{Eigen::Vector3d::Zero()}, sd_rad{Eigen::Vector3d::Zero()};
};
/// Q turns the platform frame: b_P of before becomes Q b_P.
[[nodiscard]] CommonTurn common_turn(const Eigen::Matrix3d& Q, const Eigen::Vector3d& sd_rad);

/// The common freedoms that fit the difference best, and their covariance.
struct CommonPart {
  Eigen::VectorXd size;
  Eigen::MatrixXd covariance;
};
[[nodiscard]] CommonPart common_part(const Evidence& evidence);

/// Likelihood ratios, with the common freedoms projected out. Directions in which the covariance vanishes (a
/// convention both sides share) carry no evidence.
[[nodiscard]] Change judge(const Evidence& evidence);

}  // namespace mgtd::calib::validity
