// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/identifiability.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "calib/fit/joint/joint_solver.h"
#include "calib/fit/joint/without_poses.h"
#include "calib/linear/ldlt.h"
#include "calib/linear/qr.h"
#include "calib/linear/symmetric_eigen.h"
#include "calib/sensor/sensor_equations.h"
#include "proto/units.h"

namespace mgtd::calib::fit::joint {
namespace {

constexpr int kMaxWeak = 6, kMaxAdd = 6;
constexpr double kNamedShare = 0.8;  ///< of a direction's square that its description must cover

/// nT of corrected field per unit of each slot.
Eigen::VectorXd nanotesla(const JointProblem& problem, double f_nT) {
  Eigen::VectorXd d = Eigen::VectorXd::Constant(problem.fixed(), f_nT);
  for (int i = 0; i < problem.sensors(); ++i)
    d.segment<3>(sensor::kSensorParameters * i + sensor::ix).setOnes();
  if (!problem.site_reference()) d[problem.slots().field()] = 1;
  int slot = problem.slots().effects();
  for (const effects::EffectPtr& effect : problem.effects) {
    // An effect of its typical size counts as ten nanotesla: what makes it worth a place in the model.
    for (const effects::Coefficient& c : effect->coefficients()) d[slot++] = 10 / c.typical;
  }
  return d;
}

/// Orthonormal basis of the common small rotations of all sensors, nT units, with the site direction and the
/// turn of a reference left free.
Eigen::MatrixXd common_rotation(const JointProblem& problem, const Eigen::VectorXd& d) {
  const int of_site = problem.site_reference() ? 3 : 2;
  Eigen::MatrixXd q = Eigen::MatrixXd::Zero(problem.fixed(), 3 + of_site);
  for (int i = 0; i < problem.sensors(); ++i) {
    for (int j = 0; j < 3; ++j) q(sensor::kSensorParameters * i + sensor::alpha + j, j) = d[sensor::alpha];
  }
  const int site = problem.slots().site();
  for (int j = 0; j < of_site; ++j) q(site + j, 3 + j) = 1;
  return linear::orthonormal(q);
}

/// What a slot is called: sensor by sensor for a parameter's index alone, `all` for all sensors together.
std::string slot_name(const JointProblem& problem, int slot, bool all) {
  static constexpr std::array<const char*, sensor::kSensorParameters> kWords{
      "angle theta (x-y)", "angle phi (x-z)", "angle psi (y-z)", "scale x",    "scale y",   "scale z",
      "offset x",          "offset y",        "offset z",        "tilt alpha", "tilt beta", "turn gamma"};
  const FixedSlots slots = problem.slots();
  if (slot < slots.sensor_block()) {
    const char* word = kWords[static_cast<std::size_t>(slot % sensor::kSensorParameters)];
    return all ? fmt::format("{} of all sensors", word)
               : fmt::format("s{} {}", slot / sensor::kSensorParameters + 1, word);
  }
  if (slot < slots.field()) return "direction of the site's field";
  if (slot == slots.field())
    return problem.site_reference() ? "turn of the reference about the field" : "strength of the field";
  int at = slots.effects();
  for (const effects::EffectPtr& effect : problem.effects) {
    for (const effects::Coefficient& c : effect->coefficients()) {
      if (at++ == slot) return fmt::format("{} {}", effect->name(), c.name);
    }
  }
  return {};
}

struct NamedShare {
  std::string name;
  double share;
};

/// A direction by parameters: one that lies in a single sensor keeps its sensor, others are named for all
/// sensors.
std::vector<NamedShare> parts(const JointProblem& problem, const Eigen::VectorXd& v) {
  std::vector<NamedShare> out;
  for (int p = 0; p < sensor::kSensorParameters; ++p) {
    Eigen::VectorXd share(problem.sensors());
    for (int i = 0; i < problem.sensors(); ++i)
      share[i] = v[sensor::kSensorParameters * i + p] * v[sensor::kSensorParameters * i + p];
    Eigen::Index most = 0;
    const bool one = share.maxCoeff(&most) > kNamedShare * share.sum();
    out.push_back(
        {slot_name(problem, sensor::kSensorParameters * static_cast<int>(most) + p, !one), share.sum()});
  }
  for (int slot = problem.slots().sensor_block(); slot < v.size(); ++slot)
    out.push_back({slot_name(problem, slot, false), v[slot] * v[slot]});
  std::sort(out.begin(), out.end(),
            [](const NamedShare& a, const NamedShare& b) { return a.share > b.share; });
  return out;
}

/// Names the largest parts of a direction, until they make up most of it.
void name_parameters(const JointProblem& problem, WeakDirection& weak) {
  constexpr std::size_t kMaxNames = 4;
  double covered = 0;
  const std::vector<NamedShare> all = parts(problem, weak.direction);
  for (std::size_t j = 0; j < kMaxNames && covered < kNamedShare; ++j) {
    weak.parameters.push_back(all[j].name);
    covered += all[j].share;
  }
  weak.others = covered < kNamedShare;
}

/// Mean direction of the field in the platform frame and how far it spreads.
FieldCoverage field_coverage(const JointProblem& problem, const JointState& state) {
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  std::vector<Eigen::Vector3d> directions;
  for (std::size_t k = 0; k < problem.poses.size(); ++k) {
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (std::size_t i = 0; i < state.sensors.size(); ++i)
      b += state.sensors[i].correct(problem.poses[k].y_nT.segment<3>(3 * static_cast<int>(i)));
    directions.push_back(b.normalized());
  }
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& b : directions) mean += b / static_cast<double>(directions.size());
  for (const Eigen::Vector3d& b : directions) scatter += (b - mean) * (b - mean).transpose();
  Eigen::Vector3d axis = linear::principal_axes(scatter).vectors.col(0);
  if (axis.dot(mean) < 0) axis = -axis;
  FieldCoverage out{.axis_P = axis, .least_rad = std::numbers::pi, .most_rad = 0};
  for (const Eigen::Vector3d& b : directions) {
    const double angle_rad = std::acos(std::clamp(b.dot(axis), -1.0, 1.0));
    out.least_rad = std::min(out.least_rad, angle_rad);
    out.most_rad = std::max(out.most_rad, angle_rad);
  }
  return out;
}

/// Greedy: each time the attitude that takes most variance out of the weak directions, none twice.
std::vector<TableAngles> best_additions(const JointProblem& problem, const JointState& state,
                                        const Eigen::MatrixXd& S, const Eigen::MatrixXd& weak,
                                        const Eigen::VectorXd& d, double f_nT,
                                        const std::vector<TableAngles>& candidates) {
  // Directions without any information would be infinite; a trace of it makes them comparable.
  Eigen::MatrixXd information = d.cwiseInverse().asDiagonal() * S * d.cwiseInverse().asDiagonal();
  information.diagonal().array() += 1e-12 * information.diagonal().maxCoeff();
  std::vector<Eigen::MatrixXd> offers;
  for (const TableAngles& angles : candidates) {
    offers.push_back(d.cwiseInverse().asDiagonal() * information_of(problem, state, angles, f_nT) *
                     d.cwiseInverse().asDiagonal());
  }
  std::vector<TableAngles> out;
  std::vector<std::size_t> taken;
  while (!offers.empty() && static_cast<int>(out.size()) < kMaxAdd) {
    const Eigen::MatrixXd x =
        linear::solve_by_ldlt(information, weak);  // C w: rate of the variances with information
    std::size_t best = 0;
    double best_gain = -1;
    for (std::size_t c = 0; c < offers.size(); ++c) {
      if (std::find(taken.begin(), taken.end(), c) != taken.end()) continue;
      const double gain = (x.transpose() * offers[c] * x).trace();
      if (gain > best_gain) {
        best_gain = gain;
        best = c;
      }
    }
    if (best_gain < 0) break;
    taken.push_back(best);
    information += offers[best];
    out.push_back(candidates[best]);
  }
  return out;
}

}  // namespace

const std::vector<TableAngles>& candidate_attitudes() {
  static const std::vector<TableAngles> attitudes = [] {
    std::vector<TableAngles> out;
    for (int pitch = -90; pitch <= 90; pitch += 45) {
      for (int roll = -135; roll <= 180; roll += 45) {
        for (int azimuth = 0; azimuth < 360; azimuth += 45)
          out.push_back({to_rad(azimuth), to_rad(pitch), to_rad(roll)});
      }
    }
    return out;
  }();
  return attitudes;
}

Eigen::MatrixXd information_of(const JointProblem& problem, const JointState& state,
                               const TableAngles& angles, double f_nT) {
  JointProblem one;
  one.geometry = problem.geometry;
  one.effects = problem.effects;
  one.common_field = problem.common_field;
  one.has_angles = problem.has_angles;
  one.has_reference = problem.has_reference;
  JointPose pose = problem.poses.front();
  Pose recorded = *pose.pose;
  recorded.azimuth_rad = angles.azimuth_rad;
  recorded.pitch_rad = angles.pitch_rad;
  recorded.roll_rad = angles.roll_rad;
  pose.pose = &recorded;
  pose.T = sensor::table_rotation(angles.azimuth_rad, angles.pitch_rad, angles.roll_rad, 0.0, 0.0);
  pose.has_angles = problem.has_angles;
  pose.weight.setConstant(problem.poses.front().weight.maxCoeff());
  one.poses = {pose};
  JointState at = without_poses(state);
  at.nuisances = {Nuisance(0, 0, 0, f_nT)};
  if (!pose.has_angles) at.nuisances.front().head<3>() = pose.T * state.direction * f_nT;
  Eigen::MatrixXd S = reduce(one, at, 0).S;
  // What reduce holds because nothing observes it is no information.
  for (const int slot : problem.idle_slots()) S(slot, slot) = 0;
  return S;
}

Identifiability identifiability(const JointProblem& problem, const JointState& state,
                                const Eigen::MatrixXd& S, double f_nT,
                                const std::vector<TableAngles>& candidates) {
  const Eigen::VectorXd d = nanotesla(problem, f_nT);
  Eigen::MatrixXd information = d.cwiseInverse().asDiagonal() * S * d.cwiseInverse().asDiagonal();
  // The common rotation is made known, so that only what matters for the tensor can be weak.
  const Eigen::MatrixXd rotation = common_rotation(problem, d);
  information += information.diagonal().maxCoeff() * rotation * rotation.transpose();
  const linear::SymmetricEigen eigen = linear::symmetric_eigen(information);
  Identifiability out;
  const double rounding = 1e-14 * eigen.values.tail<1>()[0];
  const double least = eigen.values[0];
  out.condition = least > rounding ? std::sqrt(eigen.values.tail<1>()[0] / least)
                                   : std::numeric_limits<double>::infinity();
  for (int j = 0; j < kMaxWeak; ++j) {
    const double lambda = eigen.values[j];
    const double sd = lambda > rounding ? 1 / std::sqrt(lambda) : std::numeric_limits<double>::infinity();
    if (sd < kWeak_nT) break;
    WeakDirection weak{.sd_nT = sd, .parameters = {}, .direction = eigen.vectors.col(j)};
    name_parameters(problem, weak);
    out.weak.push_back(std::move(weak));
  }
  out.coverage = field_coverage(problem, state);
  if (out.weak.empty()) return out;
  out.add =
      best_additions(problem, state, S, eigen.vectors.leftCols(static_cast<Eigen::Index>(out.weak.size())), d,
                     f_nT, candidates);
  return out;
}

}  // namespace mgtd::calib::fit::joint
