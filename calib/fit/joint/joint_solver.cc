// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/joint_solver.h"

#include <fmt/format.h>

#include "calib/fit/joint/single_samples.h"
#include "calib/fit/joint/unrolled_channels.h"
#include "calib/linear/cholesky.h"
#include "calib/linear/cholesky4.h"
#include "calib/linear/parts.h"

namespace mgtd::calib::fit::joint {
namespace {

/// Each pose's own step, given the step of the fixed block: its residuals move by J_f step first.
void move_nuisances(const JointProblem& problem, const JointState& from, const Eigen::VectorXd& step,
                    double damping, JointState& to) {
  const PoseModel model(problem, from);
  linear::for_each_poses(problem.poses.size(), [&](std::size_t, std::size_t first, std::size_t end) {
    PoseBlocks b;
    for (std::size_t k = first; k < end; ++k) {
      assemble(problem, model, from, k, Blocks::rows, b);
      const auto globals = step.tail(b.linear.d_global.cols());
      Channels moved = b.linear.d_global.lazyProduct(globals);
      for (int i = 0; i < problem.sensors(); ++i) {
        moved.segment<3>(3 * i) += b.linear.d_sensor.middleRows<3>(3 * i) *
                                   step.segment<sensor::kSensorParameters>(sensor::kSensorParameters * i);
      }
      moved = problem.poses[k].weight.cwiseProduct(moved);
      over_unrolled_channels(moved.size(),
                             [&](auto n) { b.g -= b.N.topRows(n).transpose() * moved.head(n); });
      b.g -= b.scalar.global.dot(globals) * b.scalar.nuisance.transpose();
      b.H.diagonal() *= 1 + damping;
      to.nuisances[k] += linear::Cholesky4(b.H).solve(b.g);
    }
  });
}

/// Along what is weakly known a step without damping is far too long, and one with the first that would do
/// for a bad start is far too short: between them the damping is searched.
double harder(double damping) {
  if (damping == 0) return kLeastDamping;
  return damping * (damping < kFirstDamping ? 100 : 10);
}

double softer(double damping) { return damping <= kLeastDamping ? 0 : damping / 10; }

}  // namespace

Result<JointSolution> solve(const JointProblem& problem, JointState start, double enough,
                            JointState* unsettled) {
  JointSolution best{.state = std::move(start), .reduced = {}, .iterations = 0};
  double damping = 0, failed = -1;  // the latter from the same state; negative: none did
  best.reduced = reduce(problem, best.state, damping);
  double before = best.reduced.cost.total();
  const bool recording = is_recording(problem) && !problem.has_angles;
  if (recording) enough = std::max(enough, kRecordingConverged);
  // The field of each sample, known from three readings alone, follows long steps on a curve from the first
  // step on. Beside an effect with edges, as the width of a hysteresis, it may fall off the curve.
  const bool on_curve = recording && problem.effects.empty();
  for (; best.iterations < kMaxIterations; ++best.iterations) {
    if (problem.stop.stop_requested()) return fail(ErrorCode::state, "the fit was stopped");
    if (best.iterations == kMaxIterations - kSlowIterations) before = best.reduced.cost.total();
    if (const auto information = linear::Cholesky::of(best.reduced.S)) {
      const Eigen::VectorXd step = information->solve(best.reduced.g);
      const double decrease = best.reduced.predicted_decrease + step.dot(best.reduced.g);
      if (decrease < enough + kRelativeDecrease * best.reduced.cost.total()) {
        if (damping == 0) return best;
        if (softer(damping) > failed) {  // a damped step is short by nature: ask again with less
          damping = softer(damping);
          best.reduced = reduce(problem, best.state, damping);
          continue;
        }
      }
      JointState next = best.state.moved(step);
      move_nuisances(problem, best.state, step, damping, next);
      if (on_curve) refit_nuisances(problem, next);
      const double next_damping = softer(damping);
      const double limit = best.reduced.cost.total() * (1 + kRelativeDecrease);
      Reduced reduced = reduce(problem, next, next_damping);
      if (reduced.cost.total() > limit && !on_curve) {
        // A long step along what is weakly known: the poses' own unknowns follow it on a curve.
        refit_nuisances(problem, next);
        reduced = reduce(problem, next, next_damping);
      }
      if (reduced.cost.total() <= limit) {
        damping = next_damping;
        failed = -1;
        best.state = std::move(next);
        best.reduced = std::move(reduced);
        continue;
      }
    }
    failed = damping;
    damping = harder(damping);
    if (damping > kMaxDamping) break;
    best.reduced = reduce(problem, best.state, damping);
  }
  const double now = best.reduced.cost.total();
  if (best.iterations == kMaxIterations && before - now < kSlowFall + kRelativeSlowFall * now) {
    best.reduced = reduce(problem, best.state, 0);
    best.slow_progress = true;
    return best;
  }
  if (unsettled != nullptr) *unsettled = best.state;
  return fail(
      ErrorCode::refused,
      fmt::format("the joint fit did not settle in {} iterations: chi-square {:.6g} with {} poses",
                  best.iterations, best.reduced.cost.total(), problem.poses.size()),
      "turn the rig through more attitudes on at least two axes, and look for poses with wrong readings");
}

void refit_nuisances(const JointProblem& problem, JointState& state) {
  // The field enters almost linearly: two steps settle it, further ones cost nothing once it is settled.
  constexpr int kSteps = 8;
  const PoseModel model(problem, state);
  linear::for_each_poses(problem.poses.size(), [&](std::size_t, std::size_t first, std::size_t end) {
    PoseBlocks b;
    for (std::size_t k = first; k < end; ++k) {
      for (int i = 0; i < kSteps; ++i) {
        assemble(problem, model, state, k, Blocks::own, b);
        const Nuisance step = linear::Cholesky4(b.H).solve(b.g);
        state.nuisances[k] += step;
        if (step.dot(b.g) < kConverged) break;
      }
    }
  });
}

}  // namespace mgtd::calib::fit::joint
