// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <vector>

/// A HypothesisDistance says how far apart two descriptions of one residual stand on a set of poses, and
/// which further poses set them apart.
///
/// Rows are whitened, nuisances of their poses eliminated. Let F be the columns by the calibration's
/// parameters and Z_i those of description i, with the coefficients g_i that it has on the run. If a is true,
/// b falls short of it in the mean by
///     lambda_ab = min over x of |Z_a g_a - [F Z_b] x|^2
/// of chi-square: twice the expected logarithm of their likelihood ratio. With poses W behind the rows so
/// far, x* and K = ([F Z_b]'[F Z_b])^-1 of those, exactly:
///     lambda_ab' = lambda_ab + e'(1 + W K W')^-1 e,   e = W_a g_a - [W_F W_b] x*
/// (recursive least squares). Pure linear algebra; knows neither poses nor effects.
namespace mgtd::calib::design {

struct Described {
  Eigen::Index first{0}, count{0};  ///< its columns
  Eigen::VectorXd size;             ///< g, as many
};

/// If `truth` is true and `other` is not.
struct HypothesisPair {
  std::size_t truth{0}, other{0};
  double weight{1};  ///< P of the one times P of the other
};

/// Weight of a pair times the probability that the wrong one of the two wins.
[[nodiscard]] double still_open(const HypothesisPair& pair, double lambda);

class HypothesisDistance {
 public:
  /// `rows`: of the run; the first `fixed` columns are F.
  HypothesisDistance(const Eigen::MatrixXd& rows, Eigen::Index fixed, std::vector<Described> described,
                     const std::vector<HypothesisPair>& pairs);

  /// Between the pair of that number, with all rows that were added.
  [[nodiscard]] double lambda(std::size_t pair) const { return pairs_[pair].lambda; }
  /// Pairs, that which is most open first.
  [[nodiscard]] std::vector<std::size_t> worst_first() const;
  /// What more rows would add to it.
  [[nodiscard]] double gain(std::size_t pair, const Eigen::MatrixXd& rows) const;
  void add(const Eigen::MatrixXd& rows);

 private:
  struct State {
    HypothesisPair pair;
    Eigen::VectorXd x;
    Eigen::MatrixXd K;
    double lambda{0};
  };
  struct Innovation {
    Eigen::MatrixXd columns;  ///< W
    Eigen::VectorXd e;
    Eigen::MatrixXd S;  ///< 1 + W K W'
  };
  [[nodiscard]] Eigen::MatrixXd columns_of(std::size_t other, const Eigen::MatrixXd& rows) const;
  [[nodiscard]] Eigen::VectorXd signature_of(std::size_t truth, const Eigen::MatrixXd& rows) const;
  [[nodiscard]] Innovation innovation(const State& state, const Eigen::MatrixXd& rows) const;

  Eigen::Index fixed_;
  std::vector<Described> described_;
  std::vector<State> pairs_;
};

/// One more pose that could be measured.
struct PossiblePose {
  Eigen::MatrixXd rows;
  double minutes{1};
};

/// That of a group which adds most a minute to the lambda of the pair that is most open, or of the next,
/// where none of the group adds anything to that.
[[nodiscard]] std::size_t best_of(const HypothesisDistance& distance, const std::vector<PossiblePose>& group);

/// The best of each group in turn, those before it measured. Returns the place within each group.
[[nodiscard]] std::vector<std::size_t> placed(HypothesisDistance distance,
                                              const std::vector<std::vector<PossiblePose>>& groups);

}  // namespace mgtd::calib::design
