// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/random_offset.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/fit/joint/slow_sums.h"
#include "calib/linear/product.h"

namespace mgtd::calib::discovery {
namespace {

/// A' G A = Q T Q' with T tridiagonal, and z = Q' A' s: every a takes a pass along the diagonal.
class Tridiagonal {
 public:
  Tridiagonal(const Eigen::MatrixXd& products, const Eigen::VectorXd& by_residual) {
    const Eigen::Tridiagonalization<Eigen::MatrixXd> of(products);
    diagonal_ = of.diagonal(), beside_ = of.subDiagonal();
    z_ = of.matrixQ().transpose() * by_residual;
  }

  [[nodiscard]] double largest_eigenvalue() const {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>()
        .computeFromTridiagonal(diagonal_, beside_, Eigen::EigenvaluesOnly)
        .eigenvalues()
        .tail<1>()
        .value();
  }

  /// a z' (1 + a T)^-1 z - ln det (1 + a T), by L D L'.
  [[nodiscard]] double two_ln_odds(double a) const {
    double out = 0, d = 1, w = 0;
    for (Eigen::Index i = 0; i < diagonal_.size(); ++i) {
      const double l = i == 0 ? 0 : a * beside_[i - 1] / d;
      d = 1 + a * diagonal_[i] - l * l * d;
      w = z_[i] - l * w;
      out += a * w * w / d - std::log(d);
    }
    return out;
  }

 private:
  Eigen::VectorXd diagonal_, beside_, z_;
};

/// Of all channels together: what one of them shows is in the residual of the others, too.
Tridiagonal of_walks(const Eigen::MatrixXd& A, const std::vector<int>& channels, const ChannelSums& sums) {
  const Eigen::Index n = A.cols(), count = static_cast<Eigen::Index>(channels.size());
  Eigen::VectorXd by_residual(n * count);
  Eigen::MatrixXd taken_up;
  for (Eigen::Index i = 0; i < count; ++i) {
    const int c = channels[static_cast<std::size_t>(i)];
    by_residual.segment(i * n, n) = A.transpose() * sums.score(c);
    const Eigen::MatrixXd of_channel = sums.taken_up(c, A);
    taken_up.conservativeResize(of_channel.rows(), n * count);
    taken_up.middleCols(i * n, n) = of_channel;
  }
  return {sums.before_projection(channels, std::vector<Eigen::MatrixXd>(channels.size(), A)) -
              linear::gram(taken_up),
          by_residual};
}

/// The same of every pose by itself.
Tridiagonal of_jumps(const std::vector<int>& channels, const ChannelSums& sums) {
  const Eigen::Index n = sums.poses(), count = static_cast<Eigen::Index>(channels.size());
  Eigen::MatrixXd products(n * count, n * count);
  Eigen::VectorXd by_residual(n * count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const int c = channels[static_cast<std::size_t>(i)];
    by_residual.segment(i * n, n) = sums.score(c);
    for (Eigen::Index j = 0; j <= i; ++j)
      products.block(i * n, j * n, n, n) = sums.products(c, channels[static_cast<std::size_t>(j)]);
  }
  return {products, by_residual};
}

/// A of a walk; empty where the poses have no time.
Eigen::MatrixXd walk_of(const fit::joint::JointProblem& problem) {
  const fit::joint::WanderingTerms terms = fit::joint::wandering_terms(problem);
  if (!terms.any()) return {};
  Eigen::MatrixXd out(static_cast<Eigen::Index>(problem.poses.size()), fit::joint::kWanderingTerms);
  for (Eigen::Index k = 0; k < out.rows(); ++k)
    out.row(k) = terms.at(problem.poses[static_cast<std::size_t>(k)].t_h).transpose();
  return out;
}

}  // namespace

double evidence_of(RandomOffset kind, const std::vector<int>& channels, const ChannelSums& sums,
                   const fit::joint::JointProblem& problem) {
  constexpr int kValues = 30;
  constexpr double kFirst = 1e-2, kLast = 1e5;  // of a, in units of one over the largest g
  constexpr double kNoOdds = -std::numeric_limits<double>::infinity();
  if (channels.empty() || channels.back() >= sums.total()) return kNoOdds;
  const bool walk = kind == RandomOffset::walk;
  const Eigen::MatrixXd A = walk ? walk_of(problem) : Eigen::MatrixXd();
  if (walk && A.size() == 0) return kNoOdds;
  const Tridiagonal all = walk ? of_walks(A, channels, sums) : of_jumps(channels, sums);
  const double largest = all.largest_eigenvalue();
  if (!(largest > 0)) return kNoOdds;
  std::vector<double> q;
  for (int i = 0; i < kValues; ++i)
    q.push_back(all.two_ln_odds(kFirst * std::pow(kLast / kFirst, i / (kValues - 1.0)) / largest));
  const double top = *std::max_element(q.begin(), q.end());
  double mean = 0;
  for (const double x : q) mean += std::exp((x - top) / 2) / kValues;
  return top + 2 * std::log(mean);
}

}  // namespace mgtd::calib::discovery
