// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "calib/discovery/channel_sums.h"
#include "calib/discovery/formula_values.h"

/// FormulaProducts holds the inner products of the columns of each formula, computed once for all rounds of a
/// search: on every two channels that a place has together, before projection, g_a' h_ab g_b, and less what
/// the model's own parameters take up, g_a' G_ab g_b (channel_sums.h). They stay as they are when laws are
/// taken out of the residual.
namespace mgtd::calib::discovery {

class FormulaProducts {
 public:
  /// `values` must outlive this.
  FormulaProducts(const FormulaValues& values, const ChannelSums& sums);

  [[nodiscard]] const FormulaValues& values() const { return *values_; }
  /// b no later than a.
  [[nodiscard]] bool have(std::size_t member, int a, int b) const { return pair(a, b).at[member] >= 0; }
  /// A row a column on channel a, a column one on b.
  using Products = Eigen::Map<const Eigen::MatrixXd>;
  [[nodiscard]] Products before(std::size_t member, int a, int b) const;
  [[nodiscard]] Products left(std::size_t member, int a, int b) const;
  /// Before projection, of a constant with every column on a channel, and with itself.
  [[nodiscard]] const Eigen::RowVectorXd& by_one(int channel) const {
    return by_one_[static_cast<std::size_t>(channel)];
  }
  [[nodiscard]] double of_one(int channel) const { return of_one_[static_cast<std::size_t>(channel)]; }

 private:
  struct Pair {
    std::vector<Eigen::Index> at;  ///< by member, of its first product; negative: it has none
    std::vector<double> products;  ///< of a member those before projection, then those left
  };
  [[nodiscard]] const Pair& pair(int a, int b) const { return pairs_[index(a, b)]; }
  [[nodiscard]] std::size_t index(int a, int b) const {
    return static_cast<std::size_t>(a) * by_one_.size() + static_cast<std::size_t>(b);
  }
  void mark(const ChannelSums& sums);
  struct Piece;
  [[nodiscard]] Piece next_piece(const ChannelSums& sums, const Piece& last) const;
  void fill(const ChannelSums& sums, const std::vector<Eigen::MatrixXd>& taken_up, const Piece& piece, int a,
            int b);

  const FormulaValues* values_;
  std::vector<Eigen::RowVectorXd> by_one_;
  std::vector<double> of_one_;
  std::vector<Pair> pairs_;
};

}  // namespace mgtd::calib::discovery
