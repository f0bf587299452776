// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/rows.h"

#include <cmath>
#include <memory>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "calib/fit/joint/joint_solver.h"

namespace mgtd::calib::criticism::tests {
namespace {

Eigen::Index row_of(const fit::joint::JointProblem& problem, std::size_t pose) {
  return static_cast<Eigen::Index>(pose) * problem.pose_rows();
}

void fill_attitude(const fit::joint::JointPose& pose, const fit::joint::Nuisance& nuisance, Eigen::Index row,
                   LinearRows& out) {
  const Eigen::Index first = row + pose.y_nT.size() + 1;
  if (pose.has_angles) {
    out.residual.segment<3>(first) = -pose.attitude_weight * nuisance.head<3>();
    out.nuisance.block<3, 3>(first, 0).diagonal().setConstant(pose.attitude_weight);
    if (!(pose.reference_weight > 0)) return;
    out.residual[first + 3] = pose.reference_weight * (pose.reference_nT.norm() - nuisance[3]);
    out.nuisance(first + 3, 3) = pose.reference_weight;
    return;
  }
  if (pose.reference_weight > 0) {
    out.residual.segment<3>(first) = pose.reference_weight * (pose.reference_nT - nuisance.head<3>());
    out.nuisance.block<3, 3>(first, 0).diagonal().setConstant(pose.reference_weight);
    out.nuisance(first + 3, 3) = 1;
    return;
  }
  out.nuisance(first, 3) = 1;
}

/// By the slots of the fixed block, into the rows of one pose.
void fill_fixed(const fit::joint::JointProblem& problem, const fit::joint::JointPose& pose,
                const fit::joint::PoseBlocks& b, Eigen::Ref<Eigen::MatrixXd> out) {
  const Eigen::Index channels = problem.channels(), block = problem.slots().sensor_block();
  for (int i = 0; i < problem.sensors(); ++i) {
    out.block<3, sensor::kSensorParameters>(3 * i, sensor::kSensorParameters * i) =
        pose.weight.segment<3>(3 * i).asDiagonal() * b.linear.d_sensor.middleRows<3>(3 * i);
  }
  const Eigen::Index globals = b.linear.d_global.cols();
  out.block(0, block, channels, globals) = pose.weight.asDiagonal() * b.linear.d_global;
  out.block(channels, block, 1, globals) = b.scalar.global;
}

/// `fixed` where it has rows.
void fill(const fit::joint::JointProblem& problem, const fit::joint::JointState& state, LinearRows& out) {
  const auto rows = row_of(problem, problem.poses.size());
  out.residual = Eigen::VectorXd::Zero(rows);
  out.nuisance = Eigen::MatrixXd::Zero(rows, fit::joint::kNuisances);
  const fit::joint::PoseModel model(problem, state);
  fit::joint::PoseBlocks b;
  const Eigen::Index channels = problem.channels();
  for (std::size_t k = 0; k < problem.poses.size(); ++k) {
    const fit::joint::JointPose& pose = problem.poses[k];
    const Eigen::Index row = row_of(problem, k);
    fit::joint::assemble(problem, model, state, k, fit::joint::Blocks::rows, b);
    out.residual.segment(row, channels) = b.residual;
    out.residual[row + channels] = b.scalar.residual;
    out.nuisance.middleRows(row, channels) = b.N;
    out.nuisance.row(row + channels) = b.scalar.nuisance;
    if (out.fixed.rows() > 0) fill_fixed(problem, pose, b, out.fixed.middleRows(row, problem.pose_rows()));
    fill_attitude(pose, state.nuisances[k], row, out);
  }
}

}  // namespace

LinearRows linear_rows(const fit::joint::JointProblem& problem, const fit::joint::JointState& state) {
  LinearRows out;
  out.fixed = Eigen::MatrixXd::Zero(row_of(problem, problem.poses.size()), problem.fixed());
  fill(problem, state, out);
  return out;
}

LinearRows observation_rows(const fit::joint::JointProblem& problem, const fit::joint::JointState& state) {
  LinearRows out;
  fill(problem, state, out);
  return out;
}

RowSource fixed_source(const fit::joint::JointProblem& problem, const fit::joint::JointState& state) {
  const auto model = std::make_shared<const fit::joint::PoseModel>(problem, state);
  return {.columns = problem.fixed(), .of = [&problem, &state, model](std::span<const Eigen::Index> poses) {
            const Eigen::Index block = problem.pose_rows();
            Eigen::MatrixXd out =
                Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(poses.size()) * block, problem.fixed());
            fit::joint::PoseBlocks b;
            Eigen::Index row = 0;
            for (const Eigen::Index k : poses) {
              const auto pose = static_cast<std::size_t>(k);
              fit::joint::assemble(problem, *model, state, pose, fit::joint::Blocks::rows, b);
              fill_fixed(problem, problem.poses[pose], b, out.middleRows(row, block));
              row += block;
            }
            return out;
          }};
}

Eigen::MatrixXd effect_rows(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
                            const effects::EffectPtr& effect) {
  return effect_rows(problem, state, effect,
                     Eigen::VectorXd::Zero(static_cast<Eigen::Index>(effect->coefficients().size())));
}

namespace {

/// The model with an effect more than it has.
class Wider {
 public:
  Wider(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
        effects::EffectPtr effect, const Eigen::VectorXd& coefficients)
      : problem_(problem),
        state_(state),
        effect_(std::move(effect)),
        wider_(with_effect()),
        at_(at(coefficients)),
        model_(wider_, at_),
        coefficients_(coefficients),
        axis_({effect_}, effects::Level::axis),
        added_(coefficients.size()) {}

  [[nodiscard]] Eigen::MatrixXd rows(std::span<const Eigen::Index> poses) const {
    const Eigen::Index channels = problem_.channels(), block = problem_.pose_rows();
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(poses.size()) * block, added_);
    fit::joint::PoseLinear linear;
    effects::TermSum terms;
    Eigen::Index row = 0;
    for (const Eigen::Index k : poses) {
      const auto pose_index = static_cast<std::size_t>(k);
      const fit::joint::JointPose& pose = problem_.poses[pose_index];
      if (!axis_.empty()) {
        of_axes(pose, state_.nuisances[pose_index], terms, out.middleRows(row, channels));
      } else if (effect_->missing(*pose.pose).empty()) {
        model_.linearise(pose, state_.nuisances[pose_index], linear);
        out.middleRows(row, channels) = pose.weight.asDiagonal() * linear.d_global.rightCols(added_);
        out.row(row + channels) = pose.f_weight * linear.f_global.tail(added_);
      }
      row += block;
    }
    return out;
  }

 private:
  /// A term of an axis adds to its reading and to nothing else, so that its own derivatives are the rows.
  void of_axes(const fit::joint::JointPose& pose, const fit::joint::Nuisance& nuisance,
               effects::TermSum& terms, Eigen::Ref<Eigen::MatrixXd> out) const {
    const fit::joint::Channels in_nT = model_.axis_inputs_nT(pose, nuisance);
    for (int i = 0; i < problem_.sensors(); ++i) {
      axis_.sum(pose.conditions(), i, {in_nT.data() + std::ptrdiff_t{3} * i, 3}, coefficients_, terms);
      out.middleRows<3>(3 * i) = pose.weight.segment<3>(3 * i).asDiagonal() * terms.d_coefficient;
    }
  }
  [[nodiscard]] fit::joint::JointProblem with_effect() const {
    fit::joint::JointProblem out;
    out.geometry = problem_.geometry;
    out.effects = problem_.effects;
    out.common_field = problem_.common_field;
    out.effects.push_back(effect_);
    return out;
  }
  [[nodiscard]] fit::joint::JointState at(const Eigen::VectorXd& coefficients) const {
    fit::joint::JointState out{.sensors = state_.sensors,
                               .direction = state_.direction,
                               .R_SR = state_.R_SR,
                               .f_nT = state_.f_nT,
                               .coefficients = state_.coefficients,
                               .nuisances = {}};
    out.coefficients.conservativeResize(state_.coefficients.size() + coefficients.size());
    out.coefficients.tail(coefficients.size()) = coefficients;
    return out;
  }

  const fit::joint::JointProblem& problem_;
  const fit::joint::JointState& state_;
  effects::EffectPtr effect_;
  fit::joint::JointProblem wider_;
  fit::joint::JointState at_;
  fit::joint::PoseModel model_;
  Eigen::VectorXd coefficients_;
  effects::LevelTerms axis_;  ///< of an effect of another level: empty
  Eigen::Index added_;
};

}  // namespace

Eigen::MatrixXd effect_rows(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
                            const effects::EffectPtr& effect, const Eigen::VectorXd& coefficients) {
  std::vector<Eigen::Index> all(problem.poses.size());
  std::iota(all.begin(), all.end(), Eigen::Index{0});
  return Wider(problem, state, effect, coefficients).rows(all);
}

RowSource effect_source(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
                        const effects::EffectPtr& effect, const Eigen::VectorXd& coefficients) {
  const auto wider = std::make_shared<const Wider>(problem, state, effect, coefficients);
  return {.columns = coefficients.size(),
          .of = [wider](std::span<const Eigen::Index> poses) { return wider->rows(poses); }};
}

RowSource effect_source(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
                        const effects::EffectPtr& effect) {
  return effect_source(problem, state, effect,
                       Eigen::VectorXd::Zero(static_cast<Eigen::Index>(effect->coefficients().size())));
}

PriorRows prior_rows(const fit::joint::JointProblem& problem, const fit::joint::JointState& state) {
  const Eigen::VectorXd x = state.fixed();
  const auto n = static_cast<Eigen::Index>(problem.priors.size());
  PriorRows out{.residual = Eigen::VectorXd::Zero(n + 2),
                .fixed = Eigen::MatrixXd::Zero(n + 2, problem.fixed())};
  for (Eigen::Index i = 0; i < n; ++i) {
    const fit::joint::LinearPrior& prior = problem.priors[static_cast<std::size_t>(i)];
    out.residual[i] = prior.weight * (prior.target - prior.row.dot(x));
    out.fixed.row(i) = prior.weight * prior.row;
  }
  if (!problem.has_angles) return out;
  const double w = problem.direction_weight;
  const Eigen::Matrix2d rows = fit::joint::inclination_declination_rows(state.direction);
  const auto observe = [&](const std::optional<double>& known, double now, Eigen::Index i) {
    if (!known) return;
    out.residual[n + i] = w * std::remainder(*known - now, 2 * std::numbers::pi);
    out.fixed.block<1, 2>(n + i, problem.slots().site()) = w * rows.row(i);
  };
  observe(problem.known_inclination_rad, fit::joint::inclination_of(state.direction), 0);
  observe(problem.known_declination_rad, fit::joint::declination_of(state.direction), 1);
  return out;
}

}  // namespace mgtd::calib::criticism::tests
