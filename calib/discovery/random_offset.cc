// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/random_offset.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/fit/joint/wandering_estimate.h"
#include "calib/linear/symmetric_eigen.h"

namespace mgtd::calib::discovery {
namespace {

struct Spectrum {
  Eigen::ArrayXd g, z2;
};

/// Of all channels together: what one of them shows is in the residual of the others, too.
Spectrum spectrum(const Eigen::MatrixXd& A, const std::vector<int>& channels, const ChannelSums& sums) {
  const Eigen::Index n = A.cols(), count = static_cast<Eigen::Index>(channels.size());
  Eigen::MatrixXd products(n * count, n * count);
  Eigen::VectorXd by_residual(n * count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const int c = channels[static_cast<std::size_t>(i)];
    by_residual.segment(i * n, n) = A.transpose() * sums.score(c);
    for (Eigen::Index j = 0; j <= i; ++j)
      products.block(i * n, j * n, n, n) =
          A.transpose() * sums.product(c, channels[static_cast<std::size_t>(j)], A);
  }
  const linear::SymmetricEigen eigen = linear::symmetric_eigen(products);
  return {.g = eigen.values.array().max(0.0),
          .z2 = (eigen.vectors.transpose() * by_residual).array().square()};
}

Eigen::MatrixXd factor_of(RandomOffset kind, const fit::joint::JointProblem& problem) {
  const auto poses = static_cast<Eigen::Index>(problem.poses.size());
  if (kind == RandomOffset::jumps) return Eigen::MatrixXd::Identity(poses, poses);
  const fit::joint::WanderingTerms terms = fit::joint::wandering_terms(problem);
  if (!terms.any()) return {};
  Eigen::MatrixXd out(poses, fit::joint::kWanderingTerms);
  for (Eigen::Index k = 0; k < poses; ++k)
    out.row(k) = terms.at(problem.poses[static_cast<std::size_t>(k)].t_h).transpose();
  return out;
}

}  // namespace

double evidence_of(RandomOffset kind, const std::vector<int>& channels, const ChannelSums& sums,
                   const fit::joint::JointProblem& problem) {
  constexpr int kValues = 30;
  constexpr double kFirst = 1e-2, kLast = 1e5;  // of a, in units of one over the largest g
  constexpr double kNever = -std::numeric_limits<double>::infinity();
  const Eigen::MatrixXd A = factor_of(kind, problem);
  if (A.size() == 0 || channels.empty() || channels.back() >= sums.channels()) return kNever;
  const Spectrum all = spectrum(A, channels, sums);
  const double largest = all.g.maxCoeff();
  if (!(largest > 0)) return kNever;
  std::vector<double> q;
  for (int i = 0; i < kValues; ++i) {
    const double a = kFirst * std::pow(kLast / kFirst, i / (kValues - 1.0)) / largest;
    q.push_back((a * all.z2 / (1 + a * all.g) - (1 + a * all.g).log()).sum());
  }
  const double top = *std::max_element(q.begin(), q.end());
  double mean = 0;
  for (const double x : q) mean += std::exp((x - top) / 2) / kValues;
  return top + 2 * std::log(mean);
}

}  // namespace mgtd::calib::discovery
