// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/joint_start.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <limits>
#include <numbers>

#include "calib/fit/joint/angle_sense.h"
#include "calib/fit/joint/data_faults.h"
#include "calib/fit/joint/joint_solver.h"
#include "calib/fit/joint/reference_turn.h"
#include "calib/fit/joint/single_samples.h"
#include "calib/fit/orientation.h"
#include "calib/linear/qr.h"
#include "calib/linear/symmetric_eigen.h"
#include "calib/sensor/sensor_equations.h"
#include "calib/sensor/sensor_start.h"
#include "proto/units.h"

namespace mgtd::calib::fit::joint {
namespace {

/// Relative turns within this of one axis leave the origin of the turn about it undecided.
const double kOneAxis = std::sin(to_rad(1.0));

struct Aligned {
  PerSensor<sensor::ScalarCalibration> alone;
  /// Sensor frame to the frame of sensor 1, reflections allowed.
  PerSensor<Eigen::Matrix3d> to_first;
  std::vector<Eigen::Vector3d> u;  ///< field of each pose in the frame of sensor 1, mean of the sensors
};

Result<Aligned> align_sensors(const JointProblem& problem, double f_nT) {
  const auto poses = static_cast<Eigen::Index>(problem.poses.size());
  Eigen::VectorXd f = Eigen::VectorXd::Constant(poses, f_nT);
  Eigen::MatrixXd y(problem.channels(), poses);
  for (Eigen::Index k = 0; k < poses; ++k) {
    const JointPose& pose = problem.poses[static_cast<std::size_t>(k)];
    y.col(k) = pose.y_nT;
    if (!problem.common_field) f[k] = pose.f_nT;
  }
  Aligned out;
  const std::size_t sensors = problem.geometry.sensors();
  out.alone.resize(sensors);
  out.to_first.resize(sensors);
  PerSensor<Eigen::Matrix3Xd> b_S_nT(sensors);
  Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, poses);
  for (std::size_t i = 0; i < sensors; ++i) {
    const Eigen::Matrix3Xd own = y.middleRows<3>(3 * static_cast<int>(i));
    const auto fitted = sensor::sensor_start(own, f);
    if (!fitted) {
      return fail(fitted.error().code, fmt::format("sensor {}: {}", i + 1, fitted.error().message),
                  fitted.error().remedy);
    }
    out.alone[i] = *fitted;
    b_S_nT[i] = fitted->correct(own);
    out.to_first[i] = nearest_orthogonal(b_S_nT[0] * b_S_nT[i].transpose(), false);
    sum += out.to_first[i] * b_S_nT[i] / static_cast<double>(sensors);
  }
  if (const auto ok = check_turned_together(b_S_nT, out.to_first); !ok) return tl::unexpected(ok.error());
  for (Eigen::Index k = 0; k < poses; ++k) out.u.emplace_back(sum.col(k));
  return out;
}

/// +1 when the majority of the sensors has the handedness of sensor 1 (ties: sensor 1 decides), else -1.
double handedness(const Aligned& aligned) {
  double sum = 0;
  for (const Eigen::Matrix3d& Q : aligned.to_first) sum += Q.determinant();
  return sum < -0.5 ? -1 : 1;
}

struct Placement {
  /// Frame of sensor 1 (made right-handed) to the platform, proper.
  Eigen::Matrix3d Q{Eigen::Matrix3d::Identity()};
  Eigen::Vector3d n{0, 0, 1};
  /// Of a reference beside the table; n is then its mean direction.
  Eigen::Matrix3d R_SR{Eigen::Matrix3d::Identity()};
};

/// Maximises tr(Q' sum T_k n u_k'), linear in n and in Q: n is searched on a Fibonacci sphere, then both
/// alternate.
Placement place(const JointProblem& problem, const std::vector<Eigen::Vector3d>& u) {
  std::array<Eigen::Matrix3d, 3> H{Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Zero()};
  for (std::size_t k = 0; k < u.size(); ++k) {
    if (!problem.poses[k].has_angles) continue;
    for (int j = 0; j < 3; ++j)
      H[static_cast<std::size_t>(j)] += problem.poses[k].T.col(j) * u[k].normalized().transpose();
  }
  const auto best_turn = [&](const Eigen::Vector3d& n) {
    return nearest_orthogonal(n[0] * H[0] + n[1] * H[1] + n[2] * H[2], true);
  };
  const auto pull = [&](const Eigen::Matrix3d& Q) {
    return Eigen::Vector3d{Q.cwiseProduct(H[0]).sum(), Q.cwiseProduct(H[1]).sum(),
                           Q.cwiseProduct(H[2]).sum()};
  };
  if (problem.known_inclination_rad && problem.known_declination_rad) {
    const Eigen::Vector3d n = direction_of(*problem.known_inclination_rad, *problem.known_declination_rad);
    return {best_turn(n), n, Eigen::Matrix3d::Identity()};
  }
  constexpr int kPoints = 200, kAlternations = 100;
  constexpr double kSettledTurn_rad = 1e-9;
  Placement best;
  double best_gain = -1;
  for (int i = 0; i < kPoints; ++i) {
    const Eigen::Vector3d n = direction_of_sphere(i, kPoints);
    const Eigen::Matrix3d Q = best_turn(n);
    if (pull(Q).dot(n) > best_gain) {
      best_gain = pull(Q).dot(n);
      best.Q = Q, best.n = n;
    }
  }
  for (int i = 0; i < kAlternations; ++i) {
    const Eigen::Vector3d before = best.n;
    best.n = pull(best.Q).normalized();
    best.Q = best_turn(best.n);
    if ((best.n - before).squaredNorm() < kSettledTurn_rad * kSettledTurn_rad) break;
  }
  return best;
}

/// The axis of the relative turns between poses, and how far they leave it.
struct TurnAxis {
  Eigen::Vector3d axis_P{0, 0, 1};
  double off_axis{0};
  int poses{0};
};

TurnAxis turn_axis(const JointProblem& problem) {
  TurnAxis out;
  std::optional<Eigen::Matrix3d> first;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  std::vector<Eigen::Vector3d> turns;
  for (const JointPose& pose : problem.poses) {
    if (!pose.has_angles) continue;
    ++out.poses;
    if (!first) first = pose.T;
    const Eigen::Quaterniond q(Eigen::Matrix3d(pose.T * first->transpose()));
    turns.push_back(q.vec());
    scatter += q.vec() * q.vec().transpose();
  }
  out.axis_P = linear::principal_axes(scatter).vectors.col(2);
  for (const Eigen::Vector3d& t : turns)
    out.off_axis = std::max(out.off_axis, (t - t.dot(out.axis_P) * out.axis_P).norm());
  return out;
}

/// Turns the placement about the axis that the angles leave open: to the declination where it is known, else
/// until sensor 1 stands as upright as it can.
void turn_free(const JointProblem& problem, Placement& p) {
  constexpr int kSteps = 3600;
  const TurnAxis turn = turn_axis(problem);
  const auto first = std::find_if(problem.poses.begin(), problem.poses.end(),
                                  [](const JointPose& q) { return q.has_angles; });
  const Placement from = p;
  double best = -std::numeric_limits<double>::infinity();
  for (int i = 0; i < kSteps; ++i) {
    const Eigen::Matrix3d Z =
        Eigen::AngleAxisd(2 * std::numbers::pi * i / kSteps, turn.axis_P).toRotationMatrix();
    // T n = Z' T (n') for turns T about the axis away from the first: n moves by T_1' Z T_1.
    const Eigen::Matrix3d at_site = first->T.transpose() * Z * first->T;
    const Placement turned{Z * from.Q, at_site * from.n, at_site * from.R_SR};
    const double merit = problem.known_declination_rad
                             ? std::cos(declination_of(turned.n) - *problem.known_declination_rad)
                             : turned.Q.trace();
    if (merit > best) {
      best = merit;
      p = turned;
    }
  }
}

Placement beside_table(const ReferencePlacement& placement, const JointProblem& problem) {
  return {placement.Q, placement.R_SR * mean_reference(problem), placement.R_SR};
}

/// Turns the sensors to a reference that turns with them. Turns about a direction that all vectors share are
/// left alone.
Placement beside_reference(const JointProblem& problem, const std::vector<Eigen::Vector3d>& u) {
  Eigen::Matrix3d H = Eigen::Matrix3d::Zero();
  for (std::size_t k = 0; k < u.size(); ++k)
    if (problem.poses[k].reference_weight > 0) H += problem.poses[k].reference_nT * u[k].transpose();
  constexpr double kLeft = 1e-6;
  H.diagonal().array() += kLeft * H.norm();
  return {nearest_orthogonal(H, true), {0, 0, 1}, Eigen::Matrix3d::Identity()};
}

Result<Placement> best_placement(const JointProblem& problem, const std::vector<Eigen::Vector3d>& u) {
  if (problem.platform_reference()) return beside_reference(problem, u);
  Placement p;
  const AngleCoverage coverage = angle_coverage(problem);
  if (coverage != AngleCoverage::none && problem.site_reference()) {
    const ReferencePlacement beside = place_beside(problem, u);
    if (auto ok = check_reference_stands(problem, u, beside); !ok) return tl::unexpected(ok.error());
    if (auto ok = check_angle_sense(problem, u, beside); !ok) return tl::unexpected(ok.error());
    p = beside_table(beside, problem);
  } else if (coverage != AngleCoverage::none) {
    p = place(problem, u);
  }
  if (coverage == AngleCoverage::one_axis) turn_free(problem, p);
  return p;
}

}  // namespace

AngleCoverage angle_coverage(const JointProblem& problem) {
  const TurnAxis turn = turn_axis(problem);
  if (turn.poses < 3) return AngleCoverage::none;
  return turn.off_axis < kOneAxis ? AngleCoverage::one_axis : AngleCoverage::full;
}

namespace {

/// With the smallest turn that lets the reference show the direction.
Placement towards(const JointProblem& problem, const Eigen::Vector3d& direction) {
  Placement out;
  out.n = direction;
  if (problem.site_reference()) out.R_SR = turn_between(mean_reference(problem), direction);
  return out;
}

JointState placed_joint_state(const JointProblem& problem, const PerSensor<sensor::SensorModel>& sensors,
                              const Placement& p, double f_nT) {
  JointState state{.sensors = sensors,
                   .direction = p.n,
                   .R_SR = std::nullopt,
                   .f_nT = f_nT,
                   .coefficients = Eigen::VectorXd::Zero(problem.coefficients()),
                   .nuisances = {}};
  if (problem.site_reference()) state.R_SR = p.R_SR;
  for (const JointPose& pose : problem.poses) {
    Nuisance x = Nuisance::Zero();
    if (pose.has_angles) {
      const bool known = (pose.f_weight > 0 || pose.reference_weight > 0) && !problem.common_field;
      x[3] = known ? pose.f_nT : f_nT;
    } else if (pose.reference_weight > 0) {
      x.head<3>() = pose.reference_nT;
    } else {
      for (int i = 0; i < problem.sensors(); ++i)
        x.head<3>() +=
            sensors[static_cast<std::size_t>(i)].correct(pose.y_nT.segment<3>(3 * i)) / problem.sensors();
    }
    state.nuisances.push_back(x);
  }
  // A sample of a recording says its field by itself.
  if (problem.has_angles || !is_recording(problem)) refit_nuisances(problem, state);
  return state;
}

/// Readings are an affine map of a field that is known as a vector, y = M r + o: least squares for each
/// sensor, and M^-1 = R K with R orthogonal, K upper triangular with positive diagonal (QR).
Result<JointState> start_from_reference(const JointProblem& problem, double f_nT) {
  const auto poses = static_cast<Eigen::Index>(problem.poses.size());
  Eigen::MatrixXd r(poses, 4), y(poses, problem.channels());
  for (Eigen::Index k = 0; k < poses; ++k) {
    const JointPose& pose = problem.poses[static_cast<std::size_t>(k)];
    r.row(k) << pose.reference_nT.transpose() / f_nT, 1;
    y.row(k) = pose.y_nT;
  }
  PerSensor<sensor::SensorModel> sensors(problem.geometry.sensors());
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    Eigen::Matrix<double, 4, 3> map;
    for (int a = 0; a < 3; ++a) {
      const auto solved = linear::unique_least_squares(r, y.col(3 * static_cast<Eigen::Index>(i) + a));
      if (!solved)
        return fail(ErrorCode::refused, "the vectors of the reference lie in a plane",
                    "give fields in more directions: along x, y and z of the cage, and without field");
      map.col(a) = *solved;
    }
    const Eigen::Matrix3d M = map.topRows<3>().transpose() / f_nT;
    if (!(std::abs(M.determinant()) > 0))
      return fail(ErrorCode::refused, fmt::format("sensor {}: an axis does not follow the reference", i + 1),
                  "check this sensor, its cable and its channels of the digitiser");
    const Eigen::HouseholderQR<Eigen::Matrix3d> qr(M.inverse());
    Eigen::Matrix3d R = qr.householderQ(), K = qr.matrixQR().triangularView<Eigen::Upper>();
    for (int a = 0; a < 3; ++a) {
      if (K(a, a) > 0) continue;
      K.row(a) *= -1;
      R.col(a) *= -1;
    }
    sensors[i] = sensor_from(K, map.row(3).transpose(), R);
  }
  return joint_state(problem, sensors, Eigen::Vector3d::UnitZ(), f_nT);
}

}  // namespace

JointState joint_state(const JointProblem& problem, const PerSensor<sensor::SensorModel>& sensors,
                       const Eigen::Vector3d& direction, double f_nT) {
  return placed_joint_state(problem, sensors, towards(problem, direction), f_nT);
}

JointState joint_state(const JointProblem& problem, const JointState& from) {
  Placement p = towards(problem, from.direction);
  if (from.R_SR) p.R_SR = *from.R_SR;
  return placed_joint_state(problem, from.sensors, p, from.f_nT);
}

Result<JointState> joint_start(const JointProblem& problem, double f_nT) {
  if (const auto ok = check_units(problem, f_nT); !ok) return tl::unexpected(ok.error());
  if (const auto ok = check_copies(problem); !ok) return tl::unexpected(ok.error());
  if (problem.platform_reference()) return start_from_reference(problem, f_nT);
  auto aligned = align_sensors(problem, f_nT);
  if (!aligned) return tl::unexpected(aligned.error());
  const double hand = handedness(*aligned);
  for (Eigen::Vector3d& u : aligned->u) u *= hand;
  const auto p = best_placement(problem, aligned->u);
  if (!p) return tl::unexpected(p.error());
  PerSensor<sensor::SensorModel> sensors(problem.geometry.sensors());
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    sensors[i] =
        sensor_from(aligned->alone[i].K, aligned->alone[i].offset_nT, p->Q * hand * aligned->to_first[i]);
  }
  return placed_joint_state(problem, sensors, *p, f_nT);
}

Result<PlacedState> placed_state(const JointProblem& problem, const PerSensor<sensor::SensorModel>& sensors,
                                 double f_nT) {
  std::vector<Eigen::Vector3d> u(problem.poses.size(), Eigen::Vector3d::Zero());
  for (std::size_t k = 0; k < u.size(); ++k) {
    for (std::size_t i = 0; i < sensors.size(); ++i)
      u[k] +=
          sensors[i].correct(problem.poses[k].y_nT.segment<3>(3 * static_cast<int>(i))) / problem.sensors();
  }
  const auto p = best_placement(problem, u);
  if (!p) return tl::unexpected(p.error());
  PerSensor<sensor::SensorModel> placed = sensors;
  for (sensor::SensorModel& sensor : placed) sensor = turned(sensor, p->Q);
  return PlacedState{placed_joint_state(problem, placed, *p, f_nT), p->Q};
}

}  // namespace mgtd::calib::fit::joint
