// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/stretch_scan.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "calib/linear/cholesky.h"
#include "calib/linear/symmetric_eigen.h"
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

/// Sums over the first poses of the run; those of a window are differences. Everything is whitened.
struct Sums {
  Eigen::VectorXd score;        ///< of the columns: products with the projected residual
  Eigen::MatrixXd information;  ///< columns by columns
  Eigen::MatrixXd fixed;        ///< fixed block by columns, whitened by the information of the fixed block
};

Eigen::MatrixXd sensor_rows(const PoseBlocks& b, const JointPose& pose, int sensor) {
  return pose.weight.segment<3>(3 * sensor).matrix().asDiagonal() *
         b.linear.d_sensor.middleRows<3>(3 * sensor);
}

/// Rows of the channels by the fixed block.
Eigen::MatrixXd fixed_rows(const FixedSlots& slots, const PoseBlocks& b, const JointPose& pose, int fixed) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(slots.channels(), fixed);
  for (int i = 0; i < slots.sensors; ++i)
    out.block<3, sensor::kSensorParameters>(3 * i, sensor::kSensorParameters * i) = sensor_rows(b, pose, i);
  out.rightCols(b.linear.d_global.cols()) = pose.weight.matrix().asDiagonal() * b.linear.d_global;
  return out;
}

/// `columns_of(blocks, pose)` gives the channels by columns of the change that is tested.
template <class ColumnsOf>
std::vector<Sums> sums_of(const JointProblem& problem, const JointState& state,
                          const linear::Cholesky& information, const ColumnsOf& columns_of) {
  std::vector<Sums> out;
  const PoseModel model(problem, state);
  PoseBlocks b;
  for (std::size_t k = 0; k < problem.poses.size(); ++k) {
    const JointPose& pose = problem.poses[k];
    assemble(problem, model, state, k, Blocks::border, b);
    const Eigen::MatrixXd Z = columns_of(b, pose), N = b.N;
    if (out.empty())
      out.push_back({Eigen::VectorXd::Zero(Z.cols()), Eigen::MatrixXd::Zero(Z.cols(), Z.cols()),
                     Eigen::MatrixXd::Zero(problem.fixed(), Z.cols())});
    const Eigen::LLT<Eigen::Matrix4d> H(b.H);
    const Eigen::MatrixXd own = N.transpose() * Z, taken = H.solve(own);
    const Eigen::VectorXd residual = b.residual;
    const Eigen::MatrixXd by_fixed =
        fixed_rows(problem.slots(), b, pose, problem.fixed()).transpose() * Z - b.U * taken;
    Sums next = out.back();
    next.score += Z.transpose() * residual - taken.transpose() * b.g;
    next.information += Z.transpose() * Z - own.transpose() * taken;
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
  const auto decomposed = linear::Cholesky::of_unscaled(information);
  if (!decomposed) return {};
  const Eigen::VectorXd shift = decomposed->solve(score);
  return {score.dot(shift), shift.norm()};
}

/// The score test of all columns in the poses from `from` on; what the calibration absorbs is left out.
double change_from(const std::vector<Sums>& sums, std::size_t from) {
  constexpr double kAbsorbed = 1e-3;  // of the information before the projection
  const Sums &a = sums[from], &b = sums.back();
  const Eigen::MatrixXd whole = b.information - a.information, taken = b.fixed - a.fixed;
  const Eigen::VectorXd scale =
      whole.diagonal().cwiseMax(std::numeric_limits<double>::min()).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd own = scale.asDiagonal() * (whole - taken.transpose() * taken) * scale.asDiagonal();
  const linear::SymmetricEigen eigen = linear::symmetric_eigen(own);
  const Eigen::VectorXd score = scale.cwiseProduct(b.score - a.score);
  const Eigen::VectorXd along = eigen.vectors.transpose() * score;
  return (eigen.values.array() > kAbsorbed).select(along.array().square() / eigen.values.array(), 0.0).sum();
}

/// The largest score test of a sensor whose offset, scale factors and angles changed at some pose, for good.
double best_change(const JointProblem& problem, const JointState& state,
                   const linear::Cholesky& information) {
  double out = 0;
  for (int i = 0; i < problem.sensors(); ++i) {
    const std::vector<Sums> sums =
        sums_of(problem, state, information, [&](const PoseBlocks& b, const JointPose& pose) {
          Eigen::MatrixXd Z = Eigen::MatrixXd::Zero(problem.channels(), sensor::kSensorParameters);
          Z.middleRows<3>(3 * i) = sensor_rows(b, pose, i);
          return Z;
        });
    for (std::size_t from = kAtTheEnd; from + kAtTheEnd < sums.size(); ++from)
      out = std::max(out, change_from(sums, from));
  }
  return out;
}

struct Best {
  std::size_t from{0}, to{0};
  Shift shift{};
  double windows{0};
};

/// In a long run the ends of the windows move by a part of their length.
Best best_window(const std::vector<Sums>& sums, int first, int count) {
  constexpr std::size_t kPart = 64;
  const auto n = static_cast<double>(sums.size() - 1);
  const auto shortest = static_cast<std::size_t>(std::ceil(kShortest * n));
  const auto longest = static_cast<std::size_t>(kLongest * n);
  Best out;
  for (std::size_t length = shortest, step = 1; length <= longest; length += step) {
    step = std::max<std::size_t>(length / kPart, 1);
    for (std::size_t from = 0; from + length < sums.size(); from += step) {
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
  if (!information || problem.platform_reference()) return std::nullopt;
  const std::vector<Sums> sums =
      sums_of(problem, solution.state, *information, [](const PoseBlocks&, const JointPose& pose) {
        return Eigen::MatrixXd((pose.weight.array() > 0).cast<double>().matrix().asDiagonal());
      });
  Best best, all = best_window(sums, 0, problem.channels());
  int sensor = 0;
  for (int i = 0; i < problem.sensors(); ++i) {
    const Best one = best_window(sums, 3 * i, 3);
    if (one.shift.chi2 > best.shift.chi2) best = one, sensor = i;
  }
  const bool whole = all.shift.chi2 > best.shift.chi2 + kAllInstead;
  const Best& found = whole ? all : best;
  const int count = whole ? problem.channels() : 3;
  const double tried = found.windows * (problem.sensors() + 1);
  if (found.shift.norm < kSmallest || found.from < kAtTheEnd || found.to + kAtTheEnd > problem.poses.size() ||
      found.shift.chi2 < stats::chi_square_limit(kFalse / std::max(tried, 1.0), count))
    return std::nullopt;
  if (best_change(problem, solution.state, *information) >= found.shift.chi2) return std::nullopt;
  const unsigned long long mask = (1ULL << static_cast<unsigned>(count)) - 1;
  return ShiftedStretch{.first = found.from,
                        .last = found.to - 1,
                        .rows = Rows(whole ? mask : mask << static_cast<unsigned>(3 * sensor)),
                        .chi2 = found.shift.chi2};
}

}  // namespace mgtd::calib::fit::joint
