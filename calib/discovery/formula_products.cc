// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/formula_products.h"

#include <algorithm>

#include "calib/linear/parts.h"

namespace mgtd::calib::discovery {

/// Some members: the whitened columns of all at once would fill the memory.
struct FormulaProducts::Piece {
  std::size_t from{0}, to{0};            ///< members
  Eigen::Index first{0}, columns{0};     ///< of FormulaValues::on
  std::vector<Eigen::MatrixXd> white{};  ///< ChannelSums::whitened, by channel, where the noise is correlated
};

FormulaProducts::FormulaProducts(const FormulaValues& values, const ChannelSums& sums) : values_(&values) {
  const auto total = static_cast<std::size_t>(sums.total());
  std::vector<Eigen::MatrixXd> taken_up(total);
  by_one_.resize(total), of_one_.resize(total);
  linear::for_each_part(total, [&](std::size_t at) {
    const auto c = static_cast<int>(at);
    by_one_[at] = sums.before_of_one(c).transpose() * values.on(c);
    of_one_[at] = sums.before_of_one(c).sum();
    taken_up[at] = sums.taken_up_by_model(c, values.on(c));
  });
  mark(sums);
  const auto& members = values.members();
  for (Piece piece; piece.to < members.size();) {
    piece = next_piece(sums, piece);
    linear::for_each_part(total * total, [&](std::size_t pair) {
      const auto a = static_cast<int>(pair / total), b = static_cast<int>(pair % total);
      if (b <= a) fill(sums, taken_up, piece, a, b);
    });
  }
}

FormulaProducts::Piece FormulaProducts::next_piece(const ChannelSums& sums, const Piece& last) const {
  constexpr Eigen::Index kWhite = 2'000'000;  // values
  const auto& members = values_->members();
  if (!sums.correlated())
    return {.from = 0, .to = members.size(), .first = 0, .columns = values_->on(0).cols()};
  const Eigen::Index each = sums.poses() * sums.total() * sums.channels();
  Piece out{.from = last.to, .to = last.to, .first = last.first + last.columns};
  while (out.to < members.size() &&
         (out.to == out.from || (out.columns + members[out.to].count) * each < kWhite))
    out.columns += members[out.to++].count;
  out.white.resize(by_one_.size());
  linear::for_each_part(out.white.size(), [&](std::size_t at) {
    const auto c = static_cast<int>(at);
    out.white[at] = sums.whitened(c, values_->on(c).middleCols(out.first, out.columns));
  });
  return out;
}

/// Members that are asked about on two channels together.
void FormulaProducts::mark(const ChannelSums& sums) {
  const auto& members = values_->members();
  pairs_.assign(by_one_.size() * by_one_.size(),
                {.at = std::vector<Eigen::Index>(members.size(), -1), .products = {}});
  for (const Place& place : places(sums.channels(), sums.has_gradient())) {
    const std::vector<int> on_channels = place.channels(sums.channels());
    for (std::size_t i = 0; i < members.size(); ++i) {
      const Family& family = values_->grammar().families[members[i].family];
      const bool asked = values_->asked(family, place);
      const bool alone =
          place.kind == Place::Kind::axis || (place.kind == Place::Kind::gradient && family.common);
      if (!asked && !alone) continue;
      for (const int a : on_channels)
        for (const int b : on_channels)
          if (b == a || (b < a && asked)) pairs_[index(a, b)].at[i] = 0;
    }
  }
}

void FormulaProducts::fill(const ChannelSums& sums, const std::vector<Eigen::MatrixXd>& taken_up,
                           const Piece& piece, int a, int b) {
  Pair& pair = pairs_[index(a, b)];
  const auto& members = values_->members();
  const auto of_a = static_cast<std::size_t>(a), of_b = static_cast<std::size_t>(b);
  const Eigen::VectorXd h =
      sums.correlated() ? Eigen::VectorXd()
                        : Eigen::VectorXd(sums.before_projection(a, b, Eigen::VectorXd::Ones(sums.poses())));
  const auto product = [&](Eigen::Index i, Eigen::Index j) -> double {
    if (sums.correlated())
      return piece.white[of_a].col(i - piece.first).dot(piece.white[of_b].col(j - piece.first));
    return values_->on(a).col(i).cwiseProduct(h).dot(values_->on(b).col(j));
  };
  for (std::size_t i = piece.from; i < piece.to; ++i) {
    if (pair.at[i] < 0) continue;
    const Eigen::Index first = members[i].first, count = members[i].count;
    const auto size = static_cast<std::size_t>(count * count);
    pair.at[i] = static_cast<Eigen::Index>(pair.products.size());
    pair.products.resize(pair.products.size() + 2 * size);
    double* const data = pair.products.data() + pair.at[i];
    Eigen::Map<Eigen::MatrixXd> before(data, count, count), left(data + size, count, count);
    for (Eigen::Index j = 0; j < count; ++j) {
      for (Eigen::Index k = 0; k < count; ++k) {
        before(k, j) = product(first + k, first + j);
        left(k, j) = before(k, j) - taken_up[of_a].col(first + k).dot(taken_up[of_b].col(first + j));
      }
    }
  }
}

FormulaProducts::Products FormulaProducts::before(std::size_t member, int a, int b) const {
  const Eigen::Index count = values_->members()[member].count;
  const Pair& of = pair(a, b);
  return {of.products.data() + of.at[member], count, count};
}

FormulaProducts::Products FormulaProducts::left(std::size_t member, int a, int b) const {
  const Eigen::Index count = values_->members()[member].count;
  const Pair& of = pair(a, b);
  return {of.products.data() + of.at[member] + count * count, count, count};
}

}  // namespace mgtd::calib::discovery
