// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "calib/fit/joint/joint_cost.h"
#include "calib/fit/joint/unrolled_channels.h"
#include "calib/linear/cholesky4.h"
#include "calib/linear/parts.h"

namespace mgtd::calib::fit::joint {
namespace {

/// Poses eliminated per rank update: enough for a blocked product, small enough for the cache.
constexpr int kBatch = 32;

/// Slots that no observation reaches are held by a unit information.
void hold_idle_slots(const JointProblem& problem, Eigen::MatrixXd& S) {
  for (const int slot : problem.idle_slots()) S(slot, slot) = 1;
}

void add_direction_prior(const JointProblem& problem, const Eigen::Vector3d& n, Reduced& out) {
  const double w = problem.direction_weight;
  const int site = problem.slots().site();
  const auto observe = [&](const std::optional<double>& known, double now, const Eigen::RowVector2d& row) {
    if (!known) return;
    const double r = w * std::remainder(*known - now, 2 * std::numbers::pi);
    out.S.block<2, 2>(site, site) += w * w * row.transpose() * row;
    out.g.segment<2>(site) += w * r * row.transpose();
    out.cost.priors += r * r;
  };
  const Eigen::Matrix2d rows = inclination_declination_rows(n);
  observe(problem.known_inclination_rad, inclination_of(n), rows.row(0));
  observe(problem.known_declination_rad, declination_of(n), rows.row(1));
}

void add_priors(const JointProblem& problem, const JointState& state, Reduced& out) {
  const Eigen::VectorXd x = state.fixed();
  for (const LinearPrior& prior : problem.priors) {
    const double r = prior.weight * (prior.target - prior.row.dot(x));
    out.S.noalias() += prior.weight * prior.weight * prior.row * prior.row.transpose();
    out.g += prior.weight * r * prior.row;
    out.cost.priors += r * r;
  }
  if (problem.has_angles) add_direction_prior(problem, state.direction, out);
}

/// Adds what one pose costs; what the priors cost is no pose's.
void add_cost(const JointCost& pose, JointCost& sum) {
  sum.readings += pose.readings;
  sum.scalar += pose.scalar;
  sum.attitude += pose.attitude;
  sum.reference += pose.reference;
}

void scalar_row(const JointProblem& problem, const JointState& state, const JointPose& pose,
                const PoseLinear& linear, ScalarRow& row) {
  const double w = pose.f_weight;
  const double observed = problem.common_field ? state.f_nT : pose.f_nT;
  row.residual = w * (observed - linear.f_nT);
  row.nuisance = w * linear.f_nuisance;
  row.global = w * linear.f_global;
  if (problem.common_field) row.global[problem.slots().field() - problem.slots().sensor_block()] -= w;
}

/// Those columns of a few rows of the globals that are not zero, each row times its weight: an effect of an
/// axis is felt by its own sensor only, and a model has a hundred of them.
struct Felt {
  std::vector<Eigen::Index> slots;
  Eigen::Matrix<double, 3, Eigen::Dynamic> rows;

  void take(const PoseLinear& linear, const Channels& weight, int sensor, int sensor_block) {
    slots.clear();
    rows.resize(3, linear.d_global.cols());
    for (Eigen::Index j = 0; j < linear.d_global.cols(); ++j) {
      const Eigen::Vector3d column = linear.d_global.col(j).segment<3>(3 * sensor);
      if (column.isZero(0)) continue;
      rows.col(static_cast<Eigen::Index>(slots.size())) = weight.segment<3>(3 * sensor).cwiseProduct(column);
      slots.push_back(sensor_block + j);
    }
  }
};

/// Adds J' J and J' r of the fixed block, lower triangle, reading rows then scalar row.
void add_fixed(const FixedSlots& slots, const PoseBlocks& b, const JointPose& pose, Felt& felt,
               Reduced& out) {
  const int block = slots.sensor_block();
  for (int i = 0; i < slots.sensors; ++i) {
    const auto& A = b.by_sensor[static_cast<std::size_t>(i)];
    const Eigen::Vector3d r = b.residual.segment<3>(3 * i);
    const int at = sensor::kSensorParameters * i;
    // lazyProduct: these are too small for blocking to pay.
    out.S.block<sensor::kSensorParameters, sensor::kSensorParameters>(at, at) += A.lazyProduct(A.transpose());
    out.g.segment<sensor::kSensorParameters>(at) += A.lazyProduct(r);
    felt.take(b.linear, pose.weight, i, block);
    for (std::size_t j = 0; j < felt.slots.size(); ++j) {
      const Eigen::Vector3d column = felt.rows.col(static_cast<Eigen::Index>(j));
      const Eigen::Index slot = felt.slots[j];
      out.S.row(slot).segment<sensor::kSensorParameters>(at) += A.lazyProduct(column).transpose();
      for (std::size_t k = j; k < felt.slots.size(); ++k)
        out.S(felt.slots[k], slot) += column.dot(felt.rows.col(static_cast<Eigen::Index>(k)));
      out.g[slot] += column.dot(r);
    }
  }
  for (Eigen::Index j = 0; j < b.scalar.global.size(); ++j) {
    const double x = b.scalar.global[j];
    if (x == 0) continue;
    out.S.col(block + j).segment(block + j, b.scalar.global.size() - j) +=
        x * b.scalar.global.tail(b.scalar.global.size() - j).transpose();
    out.g[block + j] += b.scalar.residual * x;
  }
}

}  // namespace

void assemble(const JointProblem& problem, const PoseModel& model, const JointState& state, std::size_t k,
              Blocks wanted, PoseBlocks& out) {
  const JointPose& pose = problem.poses[k];
  model.linearise(pose, state.nuisances[k], out.linear,
                  wanted == Blocks::own ? Derivatives::own : Derivatives::fixed);
  out.residual = pose.weight.cwiseProduct(pose.y_nT - out.linear.y_nT);
  scalar_row(problem, state, pose, out.linear, out.scalar);
  out.N = pose.weight.asDiagonal() * out.linear.d_nuisance;
  over_unrolled_channels(out.residual.size(), [&](auto rows) {
    const auto N = out.N.topRows(rows);
    const auto residual = out.residual.head(rows);
    out.H = N.transpose().lazyProduct(N);
    out.g = N.transpose().lazyProduct(residual);
    out.cost.readings = residual.squaredNorm();
  });
  out.H += out.scalar.nuisance.transpose() * out.scalar.nuisance;
  out.g += out.scalar.residual * out.scalar.nuisance.transpose();
  out.cost.scalar = out.scalar.residual * out.scalar.residual;
  out.cost.attitude = out.cost.priors = out.cost.reference = 0;
  if (pose.has_angles) {
    const double w2 = pose.attitude_weight * pose.attitude_weight;
    out.H.diagonal().head<3>().array() += w2;
    out.g.head<3>() -= w2 * state.nuisances[k].head<3>();
    out.cost.attitude = w2 * state.nuisances[k].head<3>().squaredNorm();
    if (pose.reference_weight > 0) {
      const double w = pose.reference_weight;
      const double off_nT = pose.reference_nT.norm() - state.nuisances[k][3];
      out.H(3, 3) += w * w;
      out.g[3] += w * w * off_nT;
      out.cost.reference = w * w * off_nT * off_nT;
    }
  } else {
    out.H(3, 3) += 1;  // the idle slot
    const bool known = pose.reference_weight > 0;
    if (known) {
      const double w2 = pose.reference_weight * pose.reference_weight;
      const Eigen::Vector3d off_nT = pose.reference_nT - state.nuisances[k].head<3>();
      out.H.diagonal().head<3>().array() += w2;
      out.g.head<3>() += w2 * off_nT;
      out.cost.reference = w2 * off_nT.squaredNorm();
    }
    if (pose.weight.isZero(0) && !known) out.H.diagonal().head<3>().array() += 1;  // nothing tells its field
  }
  if (wanted != Blocks::border) return;
  const Eigen::Index globals = out.linear.d_global.cols();
  out.U.resize(problem.slots().sensor_block() + globals, kNuisances);
  out.by_sensor.resize(problem.geometry.sensors());
  for (int i = 0; i < problem.sensors(); ++i) {
    auto& A = out.by_sensor[static_cast<std::size_t>(i)];
    A = out.linear.d_sensor.middleRows<3>(3 * i).transpose() * pose.weight.segment<3>(3 * i).asDiagonal();
    out.U.middleRows<sensor::kSensorParameters>(sensor::kSensorParameters * i) =
        A.lazyProduct(out.N.middleRows<3>(3 * i));
  }
  const sensor::ChannelRows<kNuisances> wN = pose.weight.asDiagonal() * out.N;
  over_unrolled_channels(wN.rows(), [&](auto rows) {
    out.U.bottomRows(globals) = out.linear.d_global.topRows(rows).transpose().lazyProduct(wN.topRows(rows));
  });
  out.U.bottomRows(globals) += out.scalar.global.transpose().lazyProduct(out.scalar.nuisance);
}

namespace {

Reduced nothing(int fixed) {
  return {.S = Eigen::MatrixXd::Zero(fixed, fixed), .g = Eigen::VectorXd::Zero(fixed), .cost = {}};
}

/// Of the poses from `from` on, before `to`: the lower triangle, without priors.
Reduced reduce_poses(const JointProblem& problem, const PoseModel& model, const JointState& state,
                     double damping, std::size_t from, std::size_t to) {
  const int p = problem.fixed();
  Reduced out = nothing(p);
  PoseBlocks b;
  Felt felt;
  Eigen::MatrixXd batch(p, kBatch * kNuisances);
  int filled = 0;
  const auto flush = [&] {
    if (filled == 0) return;  // Eigen divides by the size
    out.S.selfadjointView<Eigen::Lower>().rankUpdate(batch.leftCols(filled * kNuisances), -1);
    filled = 0;
  };
  for (std::size_t k = from; k < to; ++k) {
    assemble(problem, model, state, k, Blocks::border, b);
    add_fixed(problem.slots(), b, problem.poses[k], felt, out);
    add_cost(b.cost, out.cost);
    b.H.diagonal() *= 1 + damping;
    const linear::Cholesky4 H(b.H);
    auto Y = batch.middleCols<kNuisances>(filled * kNuisances);
    Y = b.U;
    H.whiten(Y.transpose());
    const Nuisance half = H.whitened(b.g);
    out.g.noalias() -= Y * half;
    out.predicted_decrease += half.squaredNorm();
    if (++filled == kBatch) flush();
  }
  flush();
  return out;
}

}  // namespace

Reduced reduce(const JointProblem& problem, const JointState& state, double damping) {
  const PoseModel model(problem, state);
  std::vector<Reduced> parts(linear::parts_of_poses(problem.poses.size()));
  linear::for_each_poses(problem.poses.size(), [&](std::size_t part, std::size_t from, std::size_t to) {
    parts[part] = reduce_poses(problem, model, state, damping, from, to);
  });
  Reduced out = parts.empty() ? nothing(problem.fixed()) : std::move(parts.front());
  for (std::size_t part = 1; part < parts.size(); ++part) {
    out.S += parts[part].S;
    out.g += parts[part].g;
    out.predicted_decrease += parts[part].predicted_decrease;
    add_cost(parts[part].cost, out.cost);
  }
  out.S.triangularView<Eigen::StrictlyUpper>() = out.S.transpose();
  hold_idle_slots(problem, out.S);
  add_priors(problem, state, out);
  out.S.diagonal() *= 1 + damping;
  return out;
}

JointCost cost_of(const JointProblem& problem, const JointState& state) {
  Reduced out = nothing(problem.fixed());
  const PoseModel model(problem, state);
  std::vector<JointCost> parts(linear::parts_of_poses(problem.poses.size()));
  linear::for_each_poses(problem.poses.size(), [&](std::size_t part, std::size_t from, std::size_t to) {
    PoseBlocks b;
    for (std::size_t k = from; k < to; ++k) {
      assemble(problem, model, state, k, Blocks::own, b);
      add_cost(b.cost, parts[part]);
    }
  });
  for (const JointCost& part : parts) add_cost(part, out.cost);
  add_priors(problem, state, out);
  return out.cost;
}

}  // namespace mgtd::calib::fit::joint
