// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/formula_products.h"

namespace mgtd::calib::discovery {

FormulaProducts::FormulaProducts(const FormulaValues& values, const ChannelSums& sums) : values_(&values) {
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(sums.poses());
  std::vector<Eigen::MatrixXd> taken_up;
  for (int c = 0; c < sums.total(); ++c) {
    const Eigen::VectorXd of_channel = sums.before_projection(c, c, one);
    by_one_.emplace_back(of_channel.transpose() * values.on(c));
    of_one_.push_back(of_channel.sum());
    taken_up.push_back(sums.taken_up_by_model(c, values.on(c)));
  }
  mark(sums);
  for (int a = 0; a < sums.total(); ++a)
    for (int b = 0; b <= a; ++b) fill(sums, taken_up, a, b);
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

/// For some members at a time: of all they would fill the memory.
void FormulaProducts::fill(const ChannelSums& sums, const std::vector<Eigen::MatrixXd>& taken_up, int a,
                           int b) {
  constexpr Eigen::Index kTogether = 256;  // columns
  Pair& pair = pairs_[index(a, b)];
  const auto& members = values_->members();
  const Eigen::MatrixXd& taken_a = taken_up[static_cast<std::size_t>(a)];
  const Eigen::MatrixXd& taken_b = taken_up[static_cast<std::size_t>(b)];
  for (std::size_t from = 0, to = 0; from < members.size(); from = to) {
    Eigen::Index columns = 0;
    for (to = from; to < members.size() && columns < kTogether; ++to)
      if (pair.at[to] >= 0) columns += members[to].count;
    if (columns == 0) continue;
    Eigen::MatrixXd some(sums.poses(), columns);
    Eigen::Index at = 0;
    for (std::size_t i = from; i < to; ++i) {
      if (pair.at[i] < 0) continue;
      some.middleCols(at, members[i].count) = values_->on(b).middleCols(members[i].first, members[i].count);
      at += members[i].count;
    }
    some = sums.before_projection(a, b, some);
    at = 0;
    for (std::size_t i = from; i < to; ++i) {
      if (pair.at[i] < 0) continue;
      const Eigen::Index first = members[i].first, count = members[i].count;
      const auto size = static_cast<std::size_t>(count * count);
      pair.at[i] = static_cast<Eigen::Index>(pair.products.size());
      pair.products.resize(pair.products.size() + 2 * size);
      double* const data = pair.products.data() + pair.at[i];
      Eigen::Map<Eigen::MatrixXd> before(data, count, count), left(data + size, count, count);
      for (Eigen::Index j = 0; j < count; ++j) {
        for (Eigen::Index k = 0; k < count; ++k) {
          before(k, j) = values_->on(a).col(first + k).dot(some.col(at + j));
          left(k, j) = before(k, j) - taken_a.col(first + k).dot(taken_b.col(first + j));
        }
      }
      at += count;
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
