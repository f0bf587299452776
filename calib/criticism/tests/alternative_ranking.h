// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "calib/criticism/tests/score.h"

/// Ranks on one scale all hypotheses that fit almost as well as the winner, and says how they would rank in
/// other runs. alternatives.h defines the scale L.
namespace mgtd::calib::criticism::tests {

struct RankedAlternative {
  std::size_t family{0};
  const Score* score{nullptr};
  Eigen::Index first{0}, count{0};  ///< columns of the joint space
  double price{0}, L{0};
};

class AlternativeRanking {
 public:
  /// Of the winner of `families[a]`.
  AlternativeRanking(const std::vector<ScoredFamily>& families, std::size_t a);

  [[nodiscard]] const std::vector<RankedAlternative>& all() const { return all_; }
  /// Orthonormal within each hypothesis.
  [[nodiscard]] Eigen::MatrixXd space(const RankedAlternative& c) const {
    return U_.middleCols(c.first, c.count);
  }
  /// What it makes of the residual.
  [[nodiscard]] Eigen::VectorXd signature(const RankedAlternative& c) const {
    return U_.middleCols(c.first, c.count) * t_.segment(c.first, c.count);
  }

  /// Draws of the noise, from which behind() takes all its runs.
  void draw(std::uint64_t seed, int draws);
  /// Chance that the family of `truth` falls as far behind all others as it did, if `truth` acts with the
  /// size that was fitted.
  [[nodiscard]] double behind(const RankedAlternative& truth) const;

 private:
  [[nodiscard]] double deficit(const Eigen::VectorXd& best, std::size_t family) const;

  std::size_t families_{0};
  std::vector<RankedAlternative> all_;
  Eigen::MatrixXd U_;
  Eigen::VectorXd t_;
  Eigen::MatrixXd noise_;  ///< columns of the space x draws
};

}  // namespace mgtd::calib::criticism::tests
