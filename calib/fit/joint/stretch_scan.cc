// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/stretch_scan.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "calib/linear/cholesky.h"
#include "calib/stats/chi_square.h"

namespace mgtd::calib::fit::joint {
namespace {

/// Of the poses of the run.
constexpr double kShortest = 0.05, kLongest = 0.35;
/// Chance of a false stretch on a run of Gaussian noise.
constexpr double kFalse = 1e-4;
/// Norm of the shift over the channels, in standard deviations of a reading.
constexpr double kSmallest = 4;
/// So much more of chi-square must all sensors explain before they are blamed instead of one.
constexpr double kAllInstead = 60;
/// Poses at either end of the run that a stretch does not reach.
constexpr std::size_t kAtTheEnd = 3;
/// Keeps the information of a shift that the pose's own field takes up invertible.
constexpr double kRidge = 1e-3;

/// Sums over the first poses of the run; those of a window are differences.
struct Sums {
  Eigen::VectorXd score;        ///< by channels: projected residuals
  Eigen::MatrixXd information;  ///< channels by channels
  Eigen::MatrixXd fixed;        ///< fixed block by channels, whitened by the information of the fixed block
};

/// Rows of the channels by the fixed block, whitened.
Eigen::MatrixXd fixed_rows(const FixedSlots& slots, const PoseBlocks& b, const JointPose& pose, int fixed) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(slots.channels(), fixed);
  for (int i = 0; i < slots.sensors; ++i)
    out.block<3, sensor::kSensorParameters>(3 * i, sensor::kSensorParameters * i) =
        b.linear.d_sensor.middleRows<3>(3 * i);
  out.rightCols(b.linear.d_global.cols()) = b.linear.d_global;
  return pose.weight.matrix().asDiagonal() * out;
}

std::vector<Sums> sums_of(const JointProblem& problem, const JointState& state,
                          const linear::Cholesky& information) {
  const int channels = problem.channels(), fixed = problem.fixed();
  std::vector<Sums> out{{Eigen::VectorXd::Zero(channels), Eigen::MatrixXd::Zero(channels, channels),
                         Eigen::MatrixXd::Zero(fixed, channels)}};
  const PoseModel model(problem, state);
  PoseBlocks b;
  for (std::size_t k = 0; k < problem.poses.size(); ++k) {
    const JointPose& pose = problem.poses[k];
    assemble(problem, model, state, k, true, b);
    const Eigen::MatrixXd A = fixed_rows(problem.slots(), b, pose, fixed);
    const Eigen::LLT<Eigen::Matrix4d> H(b.H);
    const Eigen::MatrixXd N = b.N;
    const Eigen::MatrixXd taken = H.solve(N.transpose());
    Eigen::MatrixXd kept = Eigen::MatrixXd((pose.weight.array() > 0).cast<double>().matrix().asDiagonal());
    kept -= N * taken;
    const Eigen::MatrixXd by_fixed = A.transpose() - b.U * taken;
    Sums next = out.back();
    next.score += b.residual - N * H.solve(b.g);
    next.information += kept;
    next.fixed += information.whiten(by_fixed);
    out.push_back(std::move(next));
  }
  return out;
}

struct Shift {
  double chi2{0}, norm{0};
};

/// The score test of a shift of these channels in poses [from, to).
Shift shift_in(const std::vector<Sums>& sums, std::size_t from, std::size_t to, int first, int count) {
  const Sums &a = sums[from], &b = sums[to];
  const Eigen::MatrixXd taken = (b.fixed - a.fixed).middleCols(first, count);
  Eigen::MatrixXd information = (b.information - a.information).block(first, first, count, count);
  information.noalias() -= taken.transpose() * taken;
  information.diagonal().array() += kRidge * static_cast<double>(to - from);
  const Eigen::VectorXd score = (b.score - a.score).segment(first, count);
  const Eigen::LLT<Eigen::MatrixXd> L(information);
  if (L.info() != Eigen::Success) return {};
  const Eigen::VectorXd shift = L.solve(score);
  return {score.dot(shift), shift.norm()};
}

struct Best {
  std::size_t from{0}, to{0};
  Shift shift{};
  int windows{0};
};

Best best_window(const std::vector<Sums>& sums, int first, int count) {
  const auto n = static_cast<double>(sums.size() - 1);
  const auto shortest = static_cast<std::size_t>(std::ceil(kShortest * n));
  const auto longest = static_cast<std::size_t>(kLongest * n);
  Best out;
  for (std::size_t length = shortest; length <= longest; ++length) {
    for (std::size_t from = 0; from + length < sums.size(); ++from) {
      const Shift shift = shift_in(sums, from, from + length, first, count);
      ++out.windows;
      if (shift.chi2 > out.shift.chi2) out.from = from, out.to = from + length, out.shift = shift;
    }
  }
  return out;
}

}  // namespace

std::optional<ShiftedStretch> shifted_stretch(const JointProblem& problem, const JointSolution& solution) {
  const auto information = linear::Cholesky::of(solution.reduced.S);
  if (!information || problem.has_reference) return std::nullopt;
  const std::vector<Sums> sums = sums_of(problem, solution.state, *information);
  Best best, all = best_window(sums, 0, problem.channels());
  int sensor = 0;
  for (int i = 0; i < problem.sensors(); ++i) {
    const Best one = best_window(sums, 3 * i, 3);
    if (one.shift.chi2 > best.shift.chi2) best = one, sensor = i;
  }
  const bool whole = all.shift.chi2 > best.shift.chi2 + kAllInstead;
  const Best& found = whole ? all : best;
  const int count = whole ? problem.channels() : 3;
  const int tried = found.windows * (problem.sensors() + 1);
  if (found.shift.norm < kSmallest || found.from < kAtTheEnd || found.to + kAtTheEnd > problem.poses.size() ||
      found.shift.chi2 < stats::chi_square_limit(kFalse / std::max(tried, 1), count))
    return std::nullopt;
  const unsigned long long mask = (1ULL << static_cast<unsigned>(count)) - 1;
  return ShiftedStretch{.first = found.from,
                        .last = found.to - 1,
                        .rows = Rows(whole ? mask : mask << static_cast<unsigned>(3 * sensor)),
                        .chi2 = found.shift.chi2};
}

}  // namespace mgtd::calib::fit::joint
