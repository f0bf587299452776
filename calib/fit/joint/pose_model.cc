// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/pose_model.h"

#include <Eigen/Geometry>

#include "calib/sensor/sensor_equations.h"

namespace mgtd::calib::fit::joint {
namespace {

/// Parameters that act through the gain, in the order of SensorGain::d_gain.
constexpr std::array<int, 9> kGainParameters{sensor::theta, sensor::phi,  sensor::psi,
                                             sensor::cx,    sensor::cy,   sensor::cz,
                                             sensor::alpha, sensor::beta, sensor::gamma};

Eigen::Matrix3d values(const auto& m) {
  return m.unaryExpr([](const auto& x) { return x.v; }).template cast<double>();
}

Eigen::Matrix3d derivatives(const auto& m, int slot) {
  return m.unaryExpr([slot](const auto& x) { return x.d[slot]; }).template cast<double>();
}

}  // namespace

/// R and its derivatives by w (3) and by the table state (5), or the field itself for a pose without angles.
struct PoseModel::Attitude {
  static constexpr int kAttitude = 3, kTable = 5;
  bool known{false};
  double f_nT{0};
  Eigen::Vector3d b_P_nT;  ///< of a pose without angles
  Eigen::Vector3d n;       ///< direction of the field, site frame
  Eigen::Matrix3d d_n;     ///< of n by the slots of R_SR, where there is one
  Eigen::Matrix3d R;
  std::array<Eigen::Matrix3d, kAttitude + kTable> dR;
  Eigen::Matrix<double, kTable, Eigen::Dynamic> state_d_coefficient;
};

PoseModel::PoseModel(const JointProblem& problem, const JointState& state)
    : state_(state),
      table_(problem.effects, effects::Level::table),
      site_(problem.effects, effects::Level::site),
      platform_(problem.effects, effects::Level::platform),
      axis_(problem.effects, effects::Level::axis),
      reference_(problem.effects, effects::Level::reference),
      positions_P_m_(problem.geometry.positions_P_m()),
      tangents_(tangents(state.direction)),
      reference_turns_(reference_turns(state.direction)),
      globals_(kGlobals + problem.coefficients()),
      of_field_(site_.empty() && platform_.empty() && table_.empty() ? int{kGlobals} : globals_),
      common_field_(problem.common_field) {
  gains_.clear();
  for (const sensor::SensorModel& sensor : state.sensors) gains_.push_back(gain_of(sensor));
}

PoseModel::SensorGain PoseModel::gain_of(const sensor::SensorModel& sensor) {
  using D = sensor::Dual<9>;
  const sensor::ParameterVector p = sensor.parameters();
  std::array<D, 9> x;
  for (std::size_t j = 0; j < x.size(); ++j) x[j] = D::variable(p[kGainParameters[j]], static_cast<int>(j));
  const sensor::Matrix3<D> turn =
      sensor::turn_z(x[8]) * sensor::turn_y(x[7]) * sensor::turn_x(x[6]) * sensor.mounting.cast<D>();
  const sensor::Matrix3<D> gain =
      sensor::response_matrix<D>(x[0], x[1], x[2], {x[3], x[4], x[5]}) * turn.transpose();
  SensorGain out{.gain = values(gain), .d_gain = {}};
  for (std::size_t j = 0; j < x.size(); ++j) out.d_gain[j] = derivatives(gain, static_cast<int>(j));
  return out;
}

void PoseModel::set_attitude(const JointPose& pose, const Nuisance& nuisance, Attitude& a) const {
  a.known = pose.has_angles;
  if (!a.known) {
    a.b_P_nT = nuisance.head<3>();
    return;
  }
  a.f_nT = nuisance[3];
  if (state_.R_SR) {
    a.n = *state_.R_SR * pose.reference_nT.normalized();
    for (int j = 0; j < 3; ++j) a.d_n.col(j) = reference_turns_.col(j).cross(a.n);
  } else {
    a.n = state_.direction;
  }
  using W = sensor::Dual<3>;
  const sensor::Matrix3<W> error = sensor::turn_by<W>(
      {W::variable(nuisance[0], 0), W::variable(nuisance[1], 1), W::variable(nuisance[2], 2)});
  const Eigen::Matrix3d E = values(error);
  Eigen::Matrix3d T = pose.T;
  if (!table_.empty()) {
    const TableAngles angles = *pose.pose->angles();
    const std::array<double, 5> in{angles.azimuth_rad, angles.pitch_rad, angles.roll_rad, 0, 0};
    const effects::TermSum terms = table_.sum(pose.conditions(), 0, in, state_.coefficients);
    a.state_d_coefficient = terms.d_coefficient;
    using S = sensor::Dual<5>;
    std::array<S, 5> s;
    for (std::size_t j = 0; j < s.size(); ++j) {
      s[j] = S::variable(in[j] + terms.value[static_cast<int>(j)], static_cast<int>(j));
    }
    const sensor::Matrix3<S> table = sensor::table_rotation(s[0], s[1], s[2], s[3], s[4]);
    T = values(table);
    for (int j = 0; j < 5; ++j) a.dR[static_cast<std::size_t>(3 + j)] = E * derivatives(table, j);
  }
  a.R = E * T;
  for (int j = 0; j < 3; ++j) a.dR[static_cast<std::size_t>(j)] = derivatives(error, j) * T;
}

/// b = R B(R' r): every variable that turns R moves the direction and, through x = R' r, the place.
void PoseModel::add_site_columns(const Attitude& a, const Eigen::Vector3d& B_S, const Eigen::Matrix3d& dB_dx,
                                 const Eigen::Vector3d& r_P_m, SensorField& field) const {
  const Eigen::Matrix3d through_place = a.R * dB_dx;
  const auto column = [&](std::size_t j) -> Eigen::Vector3d {
    return a.dR[j] * B_S + through_place * (a.dR[j].transpose() * r_P_m);
  };
  for (int j = 0; j < 3; ++j) field.d_nuisance.col(j) = column(static_cast<std::size_t>(j));
  field.d_nuisance.col(3) = a.R * a.n;
  if (state_.R_SR) {
    field.d_global.leftCols<3>() = a.f_nT * a.R * a.d_n;
  } else {
    field.d_global.leftCols<2>() = a.f_nT * a.R * tangents_;
  }
  if (table_.empty()) return;
  for (int j = 0; j < Attitude::kTable; ++j) {
    field.d_global.rightCols(globals_ - kGlobals) +=
        column(static_cast<std::size_t>(3 + j)) * a.state_d_coefficient.row(j);
  }
}

void PoseModel::field_at(const JointPose& pose, const Attitude& a, int sensor, SensorField& field) const {
  field.d_global.setZero(3, globals_);
  field.d_nuisance.setZero();
  if (!a.known) {
    field.b_P_nT = a.b_P_nT;
    field.d_nuisance.leftCols<3>().setIdentity();
    return;
  }
  const Eigen::Vector3d& r_P_m = positions_P_m_[static_cast<std::size_t>(sensor)];
  Eigen::Vector3d B_S = a.f_nT * a.n;
  Eigen::Matrix3d dB_dx = Eigen::Matrix3d::Zero();
  if (!site_.empty()) {
    const Eigen::Vector3d x_S_m = a.R.transpose() * r_P_m;
    site_.sum(pose.conditions(), sensor, {x_S_m.data(), 3}, state_.coefficients, field.terms);
    B_S += field.terms.value;
    dB_dx = field.terms.d_input;
    field.d_global.rightCols(globals_ - kGlobals) += a.R * field.terms.d_coefficient;
  }
  field.b_P_nT = a.R * B_S;
  add_site_columns(a, B_S, dB_dx, r_P_m, field);
}

void PoseModel::add_platform(const JointPose& pose, const Attitude& a, int sensor, SensorField& field) const {
  if (platform_.empty()) return;
  Eigen::Matrix<double, 6, 1> in = Eigen::Matrix<double, 6, 1>::Zero();
  in.head<3>() = field.b_P_nT;
  if (a.known) in.tail<3>() = a.R.col(2);
  const effects::TermSum& terms = field.terms;
  platform_.sum(pose.conditions(), sensor, {in.data(), 6}, state_.coefficients, field.terms);
  const Eigen::Matrix3d by_b = Eigen::Matrix3d::Identity() + terms.d_input.leftCols<3>();
  const Eigen::Matrix3d by_g = terms.d_input.rightCols<3>();
  field.b_P_nT += terms.value;
  field.d_nuisance = (by_b * field.d_nuisance).eval();
  field.d_global = (by_b * field.d_global).eval();
  field.d_global.rightCols(globals_ - kGlobals) += terms.d_coefficient;
  if (!a.known) return;
  for (int j = 0; j < 3; ++j) field.d_nuisance.col(j) += by_g * a.dR[static_cast<std::size_t>(j)].col(2);
  for (int j = 0; j < Attitude::kTable && !table_.empty(); ++j) {
    field.d_global.rightCols(globals_ - kGlobals) +=
        by_g * a.dR[static_cast<std::size_t>(3 + j)].col(2) * a.state_d_coefficient.row(j);
  }
}

void PoseModel::scalar_field(const JointPose& pose, const Attitude& a, PoseLinear& out) const {
  out.f_nuisance.setZero();
  out.f_global.setZero(globals_);
  if (!a.known) {
    out.f_nT = a.b_P_nT.norm();
    out.f_nuisance.head<3>() = a.b_P_nT.transpose() / out.f_nT;
    return;
  }
  if (common_field_) {
    // What is common to the poses is the field that does not drift.
    out.f_nT = a.f_nT;
    out.f_nuisance[3] = 1;
    return;
  }
  Eigen::Vector3d B_S = a.f_nT * a.n;
  Eigen::Matrix<double, 3, Eigen::Dynamic> d_coefficient;
  if (!site_.empty()) {
    const Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    const effects::TermSum terms = site_.sum(pose.conditions(), 0, {centre.data(), 3}, state_.coefficients);
    B_S += terms.value;
    d_coefficient = terms.d_coefficient;
  }
  out.f_nT = B_S.norm();
  const auto add = [&](const Eigen::RowVector3d& by_B) {
    out.f_nuisance[3] += by_B.dot(a.n);
    if (state_.R_SR) {
      out.f_global.head<3>() += a.f_nT * by_B * a.d_n;
    } else {
      out.f_global.head<2>() += a.f_nT * by_B * tangents_;
    }
    if (!site_.empty()) out.f_global.tail(globals_ - kGlobals) += by_B * d_coefficient;
  };
  add(B_S.transpose() / out.f_nT);
  if (!reference_.empty()) add(reference_terms(pose, a, B_S, out));
}

/// Adds the terms of the scalar reference; gives their derivative by B_S.
Eigen::RowVector3d PoseModel::reference_terms(const JointPose& pose, const Attitude& a,
                                              const Eigen::Vector3d& B_S, PoseLinear& out) const {
  const Eigen::Vector3d u_S = B_S.normalized(), u_P = a.R * u_S;
  const effects::TermSum terms = reference_.sum(pose.conditions(), 0, {u_P.data(), 3}, state_.coefficients);
  const Eigen::RowVector3d by_u = terms.d_input;
  out.f_nT += terms.value[0];
  out.f_global.tail(globals_ - kGlobals) += terms.d_coefficient;
  for (int j = 0; j < Attitude::kAttitude; ++j)
    out.f_nuisance[j] += by_u * (a.dR[static_cast<std::size_t>(j)] * u_S);
  for (int j = 0; j < Attitude::kTable && !table_.empty(); ++j) {
    out.f_global.tail(globals_ - kGlobals) +=
        by_u.dot(a.dR[static_cast<std::size_t>(Attitude::kAttitude + j)] * u_S) *
        a.state_d_coefficient.row(j);
  }
  return by_u * a.R * (Eigen::Matrix3d::Identity() - u_S * u_S.transpose()) / B_S.norm();
}

void PoseModel::read(const JointPose& pose, int sensor, SensorField& field, Derivatives wanted,
                     PoseLinear& out) const {
  const bool fixed = wanted == Derivatives::fixed;
  const auto i = static_cast<std::size_t>(sensor);
  const int row = 3 * sensor;
  const SensorGain& g = gains_[i];
  const Eigen::Vector3d v_nT = g.gain * field.b_P_nT;
  auto d_sensor = out.d_sensor.middleRows<3>(row);
  for (std::size_t j = 0; fixed && j < kGainParameters.size(); ++j)
    d_sensor.col(kGainParameters[j]) = g.d_gain[j] * field.b_P_nT;
  out.y_nT.segment<3>(row) = v_nT + state_.sensors[i].offset_nT;
  out.d_nuisance.middleRows<3>(row) = g.gain * field.d_nuisance;
  auto d_global = out.d_global.middleRows<3>(row);
  const Eigen::Index fields = of_field_;
  if (fixed) {
    d_global.leftCols(fields).noalias() = g.gain * field.d_global.leftCols(fields);
    d_global.rightCols(globals_ - fields).setZero();
  }
  if (!axis_.empty()) {
    const effects::TermSum& terms = field.terms;
    axis_.sum(pose.conditions(), sensor, {v_nT.data(), 3}, state_.coefficients, field.terms);
    out.y_nT.segment<3>(row) += terms.value;
    if (!terms.d_input.isZero(0)) {  // of coefficients at zero, as those of effects that are tried
      const Eigen::Matrix3d by_v = Eigen::Matrix3d::Identity() + terms.d_input;
      out.d_nuisance.middleRows<3>(row) = (by_v * out.d_nuisance.middleRows<3>(row)).eval();
      if (fixed) {
        d_sensor = (by_v * d_sensor).eval();
        d_global.leftCols(fields) = (by_v * d_global.leftCols(fields)).eval();
      }
    }
    if (fixed) d_global.rightCols(globals_ - kGlobals) += terms.d_coefficient;
  }
  if (fixed) d_sensor.middleCols<3>(sensor::ix).setIdentity();
}

void PoseModel::linearise(const JointPose& pose, const Nuisance& nuisance, PoseLinear& out,
                          Derivatives wanted) const {
  const int sensors = static_cast<int>(gains_.size());
  out.y_nT.resize(3 * sensors);
  out.d_sensor.resize(3 * sensors, sensor::kSensorParameters);
  out.d_nuisance.resize(3 * sensors, kNuisances);
  out.d_global.resize(3 * sensors, globals_);
  Attitude a;
  set_attitude(pose, nuisance, a);
  scalar_field(pose, a, out);
  SensorField& field = out.field;
  for (int sensor = 0; sensor < sensors; ++sensor) {
    // Without site and platform effects the sensors share one field.
    if (sensor == 0 || !site_.empty() || !platform_.empty()) {
      field_at(pose, a, sensor, field);
      add_platform(pose, a, sensor, field);
    }
    read(pose, sensor, field, wanted, out);
  }
}

/// R of a pose with angles.
Eigen::Matrix3d PoseModel::attitude(const JointPose& pose, const Nuisance& nuisance) const {
  const Eigen::Matrix3d error = sensor::turn_by<double>(nuisance.head<3>());
  if (table_.empty()) return error * pose.T;
  const TableAngles angles = *pose.pose->angles();
  const std::array<double, 5> in{angles.azimuth_rad, angles.pitch_rad, angles.roll_rad, 0, 0};
  const effects::TermValue moved = table_.value(pose.conditions(), 0, in, state_.coefficients);
  return error * sensor::table_rotation<double>(in[0] + moved[0], in[1] + moved[1], in[2] + moved[2],
                                                moved[3], moved[4]);
}

Channels PoseModel::axis_inputs_nT(const JointPose& pose, const Nuisance& nuisance) const {
  const effects::Conditions conditions = pose.conditions();
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d field_S_nT = nuisance.head<3>();  // of a pose without angles: in frame P already
  if (pose.has_angles) {
    R = attitude(pose, nuisance);
    field_S_nT = nuisance[3] * (state_.R_SR ? Eigen::Vector3d(*state_.R_SR * pose.reference_nT.normalized())
                                            : Eigen::Vector3d(state_.direction));
  }
  Channels out(3 * static_cast<Eigen::Index>(gains_.size()));
  for (int sensor = 0; sensor < static_cast<int>(gains_.size()); ++sensor) {
    const auto i = static_cast<std::size_t>(sensor);
    Eigen::Vector3d b_P_nT = R * field_S_nT;
    if (pose.has_angles && !site_.empty()) {
      const Eigen::Vector3d x_S_m = R.transpose() * positions_P_m_[i];
      b_P_nT += R * site_.value(conditions, sensor, {x_S_m.data(), 3}, state_.coefficients);
    }
    if (!platform_.empty()) {
      Eigen::Matrix<double, 6, 1> in = Eigen::Matrix<double, 6, 1>::Zero();
      in.head<3>() = b_P_nT;
      if (pose.has_angles) in.tail<3>() = R.col(2);
      b_P_nT += platform_.value(conditions, sensor, {in.data(), 6}, state_.coefficients);
    }
    out.segment<3>(3 * sensor) = gains_[i].gain * b_P_nT;
  }
  return out;
}

}  // namespace mgtd::calib::fit::joint
