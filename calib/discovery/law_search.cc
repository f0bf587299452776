// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/law_search.h"

#include <map>

#include "calib/linear/parts.h"
#include "calib/linear/product.h"

namespace mgtd::calib::discovery {

LawSearch::LawSearch(const FormulaProducts& products, const ChannelSums& sums)
    : values_(products.values()), sums_(sums), channels_(static_cast<std::size_t>(sums.total())) {
  linear::for_each_part(channels_.size(),
                        [&](std::size_t c) { channels_[c] = on_channel(products, static_cast<int>(c)); });
  std::vector<Place> of_several;
  for (const Place& place : places(sums.channels(), sums.has_gradient()))
    if (place.kind != Place::Kind::axis) of_several.push_back(place);
  wide_.resize(of_several.size());
  linear::for_each_part(wide_.size(), [&](std::size_t i) { wide_[i] = wide(products, of_several[i]); });
}

LawSearch::OnChannel LawSearch::on_channel(const FormulaProducts& products, int c) const {
  OnChannel out{.basis = std::vector<Eigen::MatrixXd>(values_.members().size()),
                .by_laws = sums_.taken_up_by_laws(c, values_.on(c))};
  for (std::size_t i = 0; i < values_.members().size(); ++i)
    if (products.have(i, c, c)) out.basis[i] = basis_on(products, i, c, out.by_laws);
  return out;
}

Eigen::MatrixXd LawSearch::basis_on(const FormulaProducts& products, std::size_t i, int c,
                                    const Eigen::MatrixXd& by_laws) const {
  const FormulaValues::Member& m = values_.members()[i];
  const auto before = products.before(i, c, c);
  if (m.count == 1) {
    const double whole2 = before(0, 0), by_one = products.by_one(c)[m.first];
    const double scale =
        one_over_length_left(products.left(i, c, c)(0, 0) - by_laws.col(m.first).squaredNorm(),
                             whole2 - by_one * by_one / products.of_one(c), whole2, sums_.absorbed_share());
    return Eigen::MatrixXd::Constant(1, scale == 0 ? 0 : 1, scale);
  }
  const auto laws = by_laws.middleCols(m.first, m.count);
  const Eigen::MatrixXd left = products.left(i, c, c) - laws.transpose() * laws;
  const Eigen::ArrayXd about_mean2 =
      before.diagonal().array() -
      products.by_one(c).segment(m.first, m.count).transpose().array().square() / products.of_one(c);
  const Eigen::VectorXd scale =
      one_over_length_left(left.diagonal(), about_mean2, before.diagonal(), sums_.absorbed_share());
  return scale.asDiagonal() * combinations(scale.asDiagonal() * left * scale.asDiagonal(),
                                           scale.asDiagonal() * before * scale.asDiagonal(),
                                           sums_.absorbed_share());
}

LawSearch::Wide LawSearch::wide(const FormulaProducts& products, const Place& place) const {
  const std::vector<int> on = place.channels(sums_.channels());
  const auto& members = values_.members();
  Wide out{.place = place, .combinations = {}};
  std::vector<Eigen::Index> first(on.size() + 1, 0);  // rows of each channel's combinations
  for (std::size_t i = 0; i < members.size(); ++i) {
    const FormulaValues::Member& m = members[i];
    if (!values_.asked(values_.grammar().families[m.family], place)) continue;
    const auto channel = [&](std::size_t a) -> const OnChannel& {
      return channels_[static_cast<std::size_t>(on[a])];
    };
    for (std::size_t a = 0; a < on.size(); ++a) first[a + 1] = first[a] + channel(a).rank(i);
    const Eigen::Index n = first.back();
    if (n == 0) continue;
    Eigen::MatrixXd left(n, n), before(n, n);
    for (std::size_t a = 0; a < on.size(); ++a) {
      const Eigen::MatrixXd& of_a = channel(a).basis[i];
      for (std::size_t b = 0; b <= a && of_a.cols() > 0; ++b) {
        const Eigen::MatrixXd& of_b = channel(b).basis[i];
        if (of_b.cols() == 0) continue;
        const Eigen::MatrixXd left_ab =
            products.left(i, on[a], on[b]) - channel(a).by_laws.middleCols(m.first, m.count).transpose() *
                                                 channel(b).by_laws.middleCols(m.first, m.count);
        left.block(first[a], first[b], of_a.cols(), of_b.cols()) = of_a.transpose() * left_ab * of_b;
        before.block(first[a], first[b], of_a.cols(), of_b.cols()) =
            of_a.transpose() * products.before(i, on[a], on[b]) * of_b;
      }
    }
    Eigen::MatrixXd basis = combinations(left, before, sums_.absorbed_share());
    if (basis.cols() > 0) out.combinations.push_back({i, std::move(basis)});
  }
  return out;
}

std::vector<Tried> LawSearch::scores() const {
  std::vector<Eigen::RowVectorXd> by_column;
  for (int c = 0; c < sums_.total(); ++c) by_column.emplace_back(sums_.score(c).transpose() * values_.on(c));
  const auto& members = values_.members();
  const auto unit_scores = [&](int c, std::size_t i) -> Eigen::RowVectorXd {
    const auto channel = static_cast<std::size_t>(c);
    return by_column[channel].segment(members[i].first, members[i].count) * channels_[channel].basis[i];
  };
  std::vector<Tried> out;
  for (int c = 0; c < sums_.channels(); ++c) {
    const Place place{Place::Kind::axis, c};
    for (std::size_t i = 0; i < members.size(); ++i) {
      const int k = channels_[static_cast<std::size_t>(c)].rank(i);
      if (k == 0 || !values_.asked(values_.grammar().families[members[i].family], place)) continue;
      out.push_back({i, place, k, unit_scores(c, i).squaredNorm()});
    }
  }
  for (const Wide& wide : wide_) {
    const std::vector<int> on = wide.place.channels(sums_.channels());
    for (const Combination& combination : wide.combinations) {
      Eigen::RowVectorXd v(combination.basis.rows());
      Eigen::Index at = 0;
      for (const int c : on) {
        const int rank = channels_[static_cast<std::size_t>(c)].rank(combination.member);
        if (rank > 0) v.segment(at, rank) = unit_scores(c, combination.member);
        at += rank;
      }
      out.push_back({combination.member, wide.place, static_cast<int>(combination.basis.cols()),
                     (v * combination.basis).squaredNorm()});
    }
  }
  return out;
}

std::vector<Eigen::MatrixXf> LawSearch::unit_columns() const {
  const auto& members = values_.members();
  std::vector<Eigen::MatrixXf> out;
  for (int c = 0; c < sums_.total(); ++c) {
    const Eigen::MatrixXd& G = values_.on(c);
    const OnChannel& channel = channels_[static_cast<std::size_t>(c)];
    Eigen::MatrixXf columns = Eigen::MatrixXf::Zero(G.rows(), G.cols());
    for (std::size_t i = 0; i < members.size(); ++i)
      if (channel.rank(i) > 0)
        columns.middleCols(members[i].first, channel.rank(i)) =
            (G.middleCols(members[i].first, members[i].count) * channel.basis[i]).cast<float>();
    out.push_back(std::move(columns));
  }
  return out;
}

std::vector<LawSearch::Largest> LawSearch::largest(const Scores& draws,
                                                   const std::vector<Eigen::MatrixXf>& unit_columns) const {
  const Eigen::Index n = draws.front().cols();
  std::vector<Eigen::MatrixXf> by_column;  // a row a draw
  for (std::size_t c = 0; c < unit_columns.size(); ++c)
    by_column.push_back(linear::transposed_product(Eigen::MatrixXf(draws[c].cast<float>()), unit_columns[c]));
  const auto& members = values_.members();
  std::map<std::pair<Place::Kind, int>, Largest> out;
  const auto top = [&](const Place& place, int k) -> Eigen::ArrayXf& {
    Largest& at = out[{place.kind, k}];
    if (at.S.size() == 0)
      at = {place.kind, k, place.alike(sums_.channels()),
            static_cast<int>(place.channels(sums_.channels()).size()), Eigen::ArrayXf::Zero(n)};
    return at.S;
  };
  for (int c = 0; c < sums_.channels(); ++c) {
    const Place place{Place::Kind::axis, c};
    const auto channel = static_cast<std::size_t>(c);
    for (std::size_t i = 0; i < members.size(); ++i) {
      const int k = channels_[channel].rank(i);
      if (k == 0 || !values_.asked(values_.grammar().families[members[i].family], place)) continue;
      Eigen::ArrayXf& S = top(place, k);
      S = S.max(by_column[channel].middleCols(members[i].first, k).rowwise().squaredNorm().array());
    }
  }
  Eigen::MatrixXf v, projected;
  for (const Wide& wide : wide_) {
    const std::vector<int> on = wide.place.channels(sums_.channels());
    for (const Combination& combination : wide.combinations) {
      v.resize(n, combination.basis.rows());
      Eigen::Index at = 0;
      for (const int c : on) {
        const auto channel = static_cast<std::size_t>(c);
        const int rank = channels_[channel].rank(combination.member);
        v.middleCols(at, rank) = by_column[channel].middleCols(members[combination.member].first, rank);
        at += rank;
      }
      projected.noalias() = v * combination.basis.cast<float>();
      Eigen::ArrayXf& S = top(wide.place, static_cast<int>(combination.basis.cols()));
      S = S.max(projected.rowwise().squaredNorm().array());
    }
  }
  std::vector<Largest> all;
  for (auto& [key, largest] : out) all.push_back(std::move(largest));
  return all;
}

}  // namespace mgtd::calib::discovery
