// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/law_checks.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "calib/criticism/tests/rows.h"
#include "calib/linear/parts.h"

namespace mgtd::calib::discovery {
namespace {

namespace tests = criticism::tests;

constexpr std::size_t kFolds = 8, kBlock = 8;
/// Poses that a part needs beside the parameters of the calibration.
constexpr std::size_t kFewest = 30;

/// The same fit of a part of its poses, nothing fitted anew.
fit::joint::JointFit part_of(const fit::joint::JointFit& fit, const std::vector<std::size_t>& poses) {
  fit::joint::JointFit out = fit;
  out.problem.poses.clear();
  out.state.nuisances.clear();
  for (const std::size_t k : poses) {
    out.problem.poses.push_back(fit.problem.poses[k]);
    out.state.nuisances.push_back(fit.state.nuisances[k]);
  }
  return out;
}

LawOnChannels part_of(const LawOnChannels& law, const std::vector<std::size_t>& poses) {
  LawOnChannels out(law.size());
  for (std::size_t c = 0; c < law.size(); ++c) {
    if (law[c].size() == 0) continue;
    out[c].resize(static_cast<Eigen::Index>(poses.size()));
    for (std::size_t i = 0; i < poses.size(); ++i)
      out[c][static_cast<Eigen::Index>(i)] = law[c][static_cast<Eigen::Index>(poses[i])];
  }
  return out;
}

std::vector<std::size_t> poses_where(std::size_t count, const std::function<bool(std::size_t)>& wanted) {
  std::vector<std::size_t> out;
  for (std::size_t k = 0; k < count; ++k)
    if (wanted(k)) out.push_back(k);
  return out;
}

/// Rows of the poses of a part, from those of all.
Eigen::MatrixXd rows_of(const Eigen::MatrixXd& all, Eigen::Index block,
                        const std::vector<std::size_t>& poses) {
  Eigen::MatrixXd out(block * static_cast<Eigen::Index>(poses.size()), all.cols());
  for (std::size_t i = 0; i < poses.size(); ++i)
    out.middleRows(static_cast<Eigen::Index>(i) * block, block) =
        all.middleRows(static_cast<Eigen::Index>(poses[i]) * block, block);
  return out;
}

/// Whitened rows of all poses: by the parameters of the calibration and, in the last column, the residual;
/// and the priors of those.
struct AllRows {
  Eigen::MatrixXd white;
  tests::PriorRows priors;
};

/// By how much the law that the other poses find lowers chi-square of the poses of one fold; empty where no
/// formula can be tried on the others.
Result<std::optional<double>> fall_in_fold(std::size_t fold, const fit::joint::JointFit& fit,
                                           const tests::Residual& residual, const Workbench& bench,
                                           const AllRows& all) {
  const std::size_t count = fit.problem.poses.size();
  const auto seen = poses_where(count, [&](std::size_t k) { return k % kFolds != fold; });
  const auto held = poses_where(count, [&](std::size_t k) { return k % kFolds == fold; });
  const fit::joint::JointFit part = part_of(fit, seen);
  tests::Residual of_part(part.problem, part.state, 0);
  of_part.measure_by(residual.unit() * residual.unit());
  const ChannelSums sums(part, of_part);
  auto inputs = LawInputs::of(part, bench.inputs.run());
  if (!inputs) return tl::unexpected(inputs.error());
  const FormulaValues values = bench.products.values().at(seen);
  const std::vector<RankedLaw> ranked =
      rank_formulas(LawSearch(FormulaProducts(values, sums), sums).scores(), values, sums.channels());
  if (ranked.empty()) return std::nullopt;
  const Columns columns = bench.grammar.families[ranked.front().family].columns(ranked.front().inner);
  // The law on all poses, as its columns with coefficients of the part.
  const auto on_part = fitted_law(columns, ranked.front().place, *inputs, sums);
  if (!on_part) return tl::unexpected(on_part.error());
  LawInputs whole = bench.inputs.copy();
  const auto law =
      law_on(columns, ranked.front().place, on_part->value, whole, fit.problem.channels(), sums.total());
  if (!law) return tl::unexpected(law.error());
  const Eigen::VectorXd z =
      residual.whitener().apply(law_rows(*law, fit.problem, gradient_rows(fit.problem, fit.state))) /
      residual.unit();
  // Parameters of the calibration follow from the poses that were seen, without the law and with it.
  const Eigen::Index p = all.priors.fixed.cols(), block = residual.rows_per_pose();
  const Eigen::MatrixXd train = rows_of(all.white, block, seen), test = rows_of(all.white, block, held),
                        z_train = rows_of(z, block, seen), z_test = rows_of(z, block, held);
  Eigen::MatrixXd J(train.rows() + all.priors.fixed.rows(), p), r(J.rows(), 2);
  J << train.leftCols(p), all.priors.fixed;
  r << train.col(p), train.col(p) - z_train, all.priors.residual, all.priors.residual;
  const Eigen::MatrixXd step = Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(J).solve(r);
  return (test.col(p) - test.leftCols(p) * step.col(0)).squaredNorm() -
         (test.col(p) - z_test.col(0) - test.leftCols(p) * step.col(1)).squaredNorm();
}

}  // namespace

std::optional<double> halves_ratio(const fit::joint::JointFit& fit, double scale2, const FittedLaw& law) {
  double size[2];
  for (std::size_t half = 0; half < 2; ++half) {
    const auto poses =
        poses_where(fit.problem.poses.size(), [&](std::size_t k) { return k / kBlock % 2 == half; });
    if (poses.size() < kFewest) return std::nullopt;
    const fit::joint::JointFit part = part_of(fit, poses);
    tests::Residual residual(part.problem, part.state, 0);
    residual.measure_by(scale2);
    const ChannelSums sums(part, residual);
    const LawOnChannels on_half = part_of(law.law, poses);
    const double length2 = sums.product(on_half, on_half);
    if (!(length2 > 0)) return std::nullopt;
    size[half] = sums.by_residual(on_half) / length2;
  }
  return size[1] / size[0];
}

Result<std::optional<double>> held_out_fall(const fit::joint::JointFit& fit, const tests::Residual& residual,
                                            const Workbench& bench) {
  const std::size_t count = fit.problem.poses.size();
  if (residual.whitener().rho() != 0 || residual.whitener().wanders() || count < 2 * kFewest)
    return std::nullopt;
  const tests::LinearRows linear = tests::linear_rows(fit.problem, fit.state);
  Eigen::MatrixXd both(linear.fixed.rows(), linear.fixed.cols() + 1);
  both << linear.fixed, linear.residual;
  const AllRows all{.white = residual.whitener().apply(both) / residual.unit(),
                    .priors = tests::prior_rows(fit.problem, fit.state)};
  std::vector<Result<std::optional<double>>> falls(kFolds);
  linear::for_each_part(
      kFolds, [&](std::size_t fold) { falls[fold] = fall_in_fold(fold, fit, residual, bench, all); });
  double out = 0;
  for (const Result<std::optional<double>>& fall : falls) {
    if (!fall || !*fall) return fall;
    out += **fall;
  }
  return out;
}

Result<std::optional<double>> extrapolation_spread(const std::vector<FittedLaw>& formulas,
                                                   const PoseTable& run, const fit::joint::JointFit& fit) {
  constexpr double kStretch = 1.5;
  if (formulas.size() < 2) return std::nullopt;
  auto inputs = LawInputs::of(fit, run);
  if (!inputs) return tl::unexpected(inputs.error());
  // What a formula adds to a constant in the run is taken out of it outside, too.
  std::vector<Eigen::VectorXd> outside;
  for (const FittedLaw& formula : formulas) {
    if (!(formula.place == formulas.front().place)) continue;
    inputs->stretch(kStretch);
    const auto far = law_on(formula.columns, formula.place, formula.value, *inputs, fit.problem.channels(),
                            static_cast<int>(formula.law.size()));
    if (!far) return tl::unexpected(far.error());
    Eigen::VectorXd all(0);
    for (std::size_t c = 0; c < far->size(); ++c) {
      if ((*far)[c].size() == 0) continue;
      const Eigen::Index n = all.size();
      all.conservativeResize(n + (*far)[c].size());
      all.tail((*far)[c].size()) = (*far)[c].array() - formula.law[c].mean();
    }
    outside.push_back(std::move(all));
  }
  if (outside.size() < 2 || !(outside.front().norm() > 0)) return std::nullopt;
  double out = 0;
  for (const Eigen::VectorXd& other : outside)
    out = std::max(out, (other - outside.front()).norm() / outside.front().norm());
  return out;
}

LeftOn left_on(const ChannelSums& sums) {
  LeftOn out;
  for (int c = 0; c < sums.channels(); ++c) {
    const ChannelSums::Moments G = sums.moments(c);
    const double sigmas = (sums.score(c).squaredNorm() - G.trace) / std::sqrt(2 * G.squares);
    if (sigmas > out.sigmas || c == 0) out = {c, sigmas};
  }
  return out;
}

}  // namespace mgtd::calib::discovery
