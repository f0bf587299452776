// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/law_search.h"

#include <algorithm>
#include <map>

#include "calib/linear/product.h"

namespace mgtd::calib::discovery {
namespace {

/// Values of the columns of one member; zeros where they have none.
Result<Eigen::MatrixXd> values_of(const Columns& columns, int channel, LawInputs& inputs) {
  Eigen::MatrixXd out(inputs.poses(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t j = 0; j < columns.size(); ++j) {
    const auto values = inputs(columns[j], channel);
    if (!values) return tl::unexpected(values.error());
    if (values->size() == 0) {
      out.col(static_cast<Eigen::Index>(j)).setZero();
    } else {
      out.col(static_cast<Eigen::Index>(j)) = *values;
    }
  }
  return out;
}

}  // namespace

Result<FormulaValues> FormulaValues::of(const Grammar& grammar, LawInputs& inputs) {
  FormulaValues out(grammar);
  Eigen::Index columns = 0;
  for (std::size_t f = 0; f < grammar.families.size(); ++f) {
    const Family& family = grammar.families[f];
    for (std::size_t i = 0; i < family.inner.size(); ++i) {
      const auto count = static_cast<Eigen::Index>(family.columns(family.inner[i]).size());
      out.members_.push_back({f, i, columns, count});
      columns += count;
    }
  }
  for (int c = 0; c < inputs.channels(); ++c) {
    Eigen::MatrixXd all(inputs.poses(), columns);
    for (const Member& m : out.members_) {
      const Family& family = grammar.families[m.family];
      if (c > 0 && family.common) {
        all.middleCols(m.first, m.count) = out.columns_.front().middleCols(m.first, m.count);
        continue;
      }
      const auto values = values_of(family.columns(family.inner[m.inner]), c, inputs);
      if (!values) return tl::unexpected(values.error());
      all.middleCols(m.first, m.count) = *values;
    }
    out.columns_.push_back(std::move(all));
  }
  return out;
}

FormulaValues FormulaValues::at(const std::vector<std::size_t>& poses) const {
  FormulaValues out(*grammar_);
  out.members_ = members_;
  for (const Eigen::MatrixXd& all : columns_) {
    Eigen::MatrixXd some(static_cast<Eigen::Index>(poses.size()), all.cols());
    for (std::size_t i = 0; i < poses.size(); ++i)
      some.row(static_cast<Eigen::Index>(i)) = all.row(static_cast<Eigen::Index>(poses[i]));
    out.columns_.push_back(std::move(some));
  }
  return out;
}

bool FormulaValues::asked(const Family& family, const Place& place) const {
  switch (place.kind) {
    case Place::Kind::axis:
      return family.foreign_sensor != place.at / 3 && family.foreign_axis != place.at % 3;
    case Place::Kind::sensor:
      return family.foreign_sensor != place.at;
    case Place::Kind::array:
      return family.whole_array;
    case Place::Kind::gradient:
      return family.of_site && family.common && family.foreign_sensor < 0;
  }
  return false;
}

LawSearch::LawSearch(const FormulaValues& values, const ChannelSums& sums) : values_(values), sums_(sums) {
  for (int c = 0; c < sums.total(); ++c) channels_.push_back(on_channel(c));
  for (const Place& place : places(sums.channels(), sums.has_gradient()))
    if (place.kind != Place::Kind::axis) wide_.push_back(wide(place));
}

LawSearch::OnChannel LawSearch::on_channel(int c) const {
  const bool of_gradient = c >= sums_.channels();
  const Eigen::MatrixXd& G = values_.on(of_gradient ? 0 : c);
  const Eigen::MatrixXd H = sums_.before_projection(c, c, G), U = sums_.taken_up(c, G);
  const Eigen::VectorXd one = Eigen::VectorXd::Ones(G.rows());
  const double of_one = one.dot(sums_.before_projection(c, c, one).col(0));
  OnChannel out{.columns = Eigen::MatrixXd::Zero(G.rows(), G.cols()),
                .taken = Eigen::MatrixXd::Zero(U.rows(), U.cols()),
                .rank = std::vector<int>(values_.members().size(), 0)};
  for (std::size_t i = 0; i < values_.members().size(); ++i) {
    const FormulaValues::Member& m = values_.members()[i];
    if (of_gradient && !values_.grammar().families[m.family].common) continue;
    const auto g = G.middleCols(m.first, m.count), h = H.middleCols(m.first, m.count),
               u = U.middleCols(m.first, m.count);
    const Eigen::MatrixXd before = g.transpose() * h;
    const Eigen::MatrixXd left = before - u.transpose() * u;
    const Eigen::ArrayXd length2 =
        before.diagonal().array() - (one.transpose() * h).transpose().array().square() / of_one;
    const Eigen::VectorXd scale =
        length_left(left.diagonal(), length2, before.diagonal(), sums_.absorbed_share());
    if (m.count == 1) {
      if (scale[0] == 0) continue;
      out.columns.col(m.first) = g.col(0) * scale[0];
      out.taken.col(m.first) = u.col(0) * scale[0];
      out.rank[i] = 1;
      continue;
    }
    const Eigen::MatrixXd basis =
        combinations(scale.asDiagonal() * left * scale.asDiagonal(),
                     scale.asDiagonal() * before * scale.asDiagonal(), sums_.absorbed_share());
    const Eigen::MatrixXd of_unit = scale.asDiagonal() * basis;
    out.rank[i] = static_cast<int>(basis.cols());
    out.columns.middleCols(m.first, basis.cols()) = g * of_unit;
    out.taken.middleCols(m.first, basis.cols()) = u * of_unit;
  }
  return out;
}

LawSearch::Wide LawSearch::wide(const Place& place) const {
  const std::vector<int> on = place.channels(sums_.channels());
  const auto& members = values_.members();
  // Of each pair of channels, for some members at a time: of all they would fill the memory.
  constexpr std::size_t kTogether = 128;
  std::vector<std::vector<Eigen::MatrixXd>> before(on.size());
  Eigen::Index begin = 0;
  const auto make_before = [&](std::size_t i) {
    const FormulaValues::Member& last = members[std::min(i + kTogether, members.size()) - 1];
    begin = members[i].first;
    for (std::size_t a = 0; a < on.size(); ++a) {
      before[a].clear();
      for (std::size_t b = 0; b <= a; ++b)
        before[a].push_back(
            sums_.before_projection(on[a], on[b],
                                    channels_[static_cast<std::size_t>(on[b])].columns.middleCols(
                                        begin, last.first + last.count - begin)));
    }
  };
  Wide out{.place = place, .combinations = {}};
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (i % kTogether == 0) make_before(i);
    const FormulaValues::Member& m = members[i];
    if (!values_.asked(values_.grammar().families[m.family], place)) continue;
    const Eigen::Index n = m.count * static_cast<Eigen::Index>(on.size());
    Eigen::MatrixXd left = Eigen::MatrixXd::Zero(n, n), whole = left;
    int columns = 0;
    for (std::size_t a = 0; a < on.size(); ++a) {
      const OnChannel& channel = channels_[static_cast<std::size_t>(on[a])];
      const auto at = static_cast<Eigen::Index>(a) * m.count;
      columns += channel.rank[i];
      for (std::size_t b = 0; b <= a; ++b) {
        auto block = left.block(at, static_cast<Eigen::Index>(b) * m.count, m.count, m.count);
        block = channel.columns.middleCols(m.first, m.count).transpose() *
                before[a][b].middleCols(m.first - begin, m.count);
        whole.block(at, static_cast<Eigen::Index>(b) * m.count, m.count, m.count) = block;
        block -= channel.taken.middleCols(m.first, m.count).transpose() *
                 channels_[static_cast<std::size_t>(on[b])].taken.middleCols(m.first, m.count);
      }
    }
    if (columns == 0) continue;
    Eigen::MatrixXd basis = combinations(left, whole, sums_.absorbed_share());
    if (basis.cols() > 0) out.combinations.push_back({i, std::move(basis)});
  }
  return out;
}

template <class Scalar>
std::vector<Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>> LawSearch::column_scores(
    const Scores& scores) const {
  std::vector<Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>> out;
  for (std::size_t c = 0; c < channels_.size(); ++c)
    out.push_back(linear::transposed_product(
        Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>(channels_[c].columns.cast<Scalar>()),
        Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic>(scores[c].cast<Scalar>())));
  return out;
}

std::vector<Tried> LawSearch::scores() const {
  Scores residual;
  for (int c = 0; c < sums_.total(); ++c) residual.emplace_back(sums_.score(c));
  const auto by_column = column_scores<double>(residual);
  const auto& members = values_.members();
  std::vector<Tried> out;
  for (int c = 0; c < sums_.channels(); ++c) {
    const Place place{Place::Kind::axis, c};
    const OnChannel& channel = channels_[static_cast<std::size_t>(c)];
    for (std::size_t i = 0; i < members.size(); ++i) {
      if (channel.rank[i] == 0 || !values_.asked(values_.grammar().families[members[i].family], place))
        continue;
      const auto v =
          by_column[static_cast<std::size_t>(c)].col(0).segment(members[i].first, members[i].count);
      out.push_back({i, place, channel.rank[i], v.squaredNorm()});
    }
  }
  for (const Wide& wide : wide_) {
    const std::vector<int> on = wide.place.channels(sums_.channels());
    for (const Combination& combination : wide.combinations) {
      const FormulaValues::Member& m = members[combination.member];
      Eigen::VectorXd v(combination.basis.rows());
      for (std::size_t a = 0; a < on.size(); ++a)
        v.segment(static_cast<Eigen::Index>(a) * m.count, m.count) =
            by_column[static_cast<std::size_t>(on[a])].col(0).segment(m.first, m.count);
      out.push_back({combination.member, wide.place, static_cast<int>(combination.basis.cols()),
                     (combination.basis.transpose() * v).squaredNorm()});
    }
  }
  return out;
}

std::vector<LawSearch::Largest> LawSearch::largest(const Scores& draws) const {
  const Eigen::Index n = draws.front().cols();
  const auto by_column = column_scores<float>(draws);
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
    const OnChannel& channel = channels_[static_cast<std::size_t>(c)];
    // Row by row would walk over all draws of a column each time: squares first, transposed.
    const Eigen::MatrixXf squares = by_column[static_cast<std::size_t>(c)].transpose().cwiseAbs2();
    for (std::size_t i = 0; i < members.size(); ++i) {
      const int k = channel.rank[i];
      if (k == 0 || !values_.asked(values_.grammar().families[members[i].family], place)) continue;
      Eigen::ArrayXf& S = top(place, k);
      if (members[i].count == 1) {
        S = S.max(squares.col(members[i].first).array());
      } else {
        S = S.max(squares.middleCols(members[i].first, members[i].count).rowwise().sum().array());
      }
    }
  }
  for (const Wide& wide : wide_) {
    const std::vector<int> on = wide.place.channels(sums_.channels());
    for (const Combination& combination : wide.combinations) {
      const FormulaValues::Member& m = members[combination.member];
      Eigen::MatrixXf v(combination.basis.rows(), n);
      for (std::size_t a = 0; a < on.size(); ++a)
        v.middleRows(static_cast<Eigen::Index>(a) * m.count, m.count) =
            by_column[static_cast<std::size_t>(on[a])].middleRows(m.first, m.count);
      const Eigen::MatrixXf projected = combination.basis.cast<float>().transpose() * v;
      Eigen::ArrayXf& S = top(wide.place, static_cast<int>(combination.basis.cols()));
      S = S.max(projected.colwise().squaredNorm().transpose().array());
    }
  }
  std::vector<Largest> all;
  for (auto& [key, largest] : out) all.push_back(std::move(largest));
  return all;
}

}  // namespace mgtd::calib::discovery
