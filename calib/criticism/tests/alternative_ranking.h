// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "calib/criticism/tests/score.h"

/// An AlternativeRanking ranks on one scale all hypotheses that fit almost as well as the winner, and says
/// how they would rank in other runs. alternatives.h defines the scale L.
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
  /// What a question makes of the residual, z: its length in squares.
  [[nodiscard]] double length2(const RankedAlternative& c) const {
    return t_.segment(c.first, c.count).squaredNorm();
  }
  /// Of z, what lies outside the space of another question: its length in squares.
  [[nodiscard]] double outside(const RankedAlternative& c, const RankedAlternative& other) const;

  /// Draws of the noise, from which behind() takes all its runs.
  void draw(std::uint64_t seed, int draws);
  /// Chance that the family of `truth` falls as far behind all others as it did, if `truth` acts with the
  /// size that was fitted.
  [[nodiscard]] double behind(const RankedAlternative& truth) const;

 private:
  [[nodiscard]] double deficit(const Eigen::VectorXd& best, std::size_t family) const;

  std::size_t families_{0};
  std::vector<RankedAlternative> all_;
  Eigen::MatrixXd gram_;   ///< U'U, the columns U of each question orthonormal
  Eigen::VectorXd t_;      ///< U'r
  Eigen::MatrixXd noise_;  ///< columns of the space x draws
};

}  // namespace mgtd::calib::criticism::tests
