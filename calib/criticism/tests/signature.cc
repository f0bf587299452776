// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/signature.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <utility>

#include "calib/linear/product.h"

namespace mgtd::calib::criticism::tests {
namespace {

constexpr Eigen::Index kPosesAtOnce = 128, kRowsAtOnce = 1536;
constexpr Eigen::Index kPosesHeld = 1000;  ///< a run of so many counts as short

/// Calls `use` with the rows of some poses, one block after the other; copies them only where they do not lie
/// so.
template <class Use>
decltype(auto) with_rows_of(const Eigen::MatrixXd& all, std::span<const Eigen::Index> poses,
                            Eigen::Index block, const Use& use) {
  using Rows = Eigen::Ref<const Eigen::MatrixXd>;
  const auto n = static_cast<Eigen::Index>(poses.size());
  const bool in_order = std::adjacent_find(poses.begin(), poses.end(), [](Eigen::Index a, Eigen::Index b) {
                          return b != a + 1;
                        }) == poses.end();
  if (n > 0 && in_order) return use(Rows(all.middleRows(poses.front() * block, n * block)));
  Eigen::MatrixXd out(n * block, all.cols());
  for (Eigen::Index i = 0; i < n; ++i)
    out.middleRows(i * block, block) = all.middleRows(poses[static_cast<std::size_t>(i)] * block, block);
  return use(Rows(out));
}

/// The next poses in the order of time; none at the end.
std::span<const Eigen::Index> next_poses(const Whitener& whitener, std::size_t from) {
  const std::span<const Eigen::Index> all = whitener.order();
  return all.subspan(from, std::min(all.size() - from, static_cast<std::size_t>(kPosesAtOnce)));
}

Eigen::MatrixXd whitened(Whitener::Walk& walk, const Eigen::MatrixXd& rows, std::size_t poses,
                         Eigen::Index block) {
  const auto n = static_cast<Eigen::Index>(poses);
  Eigen::MatrixXd out(n * block, rows.cols());
  const Eigen::Index in = n == 0 ? 0 : rows.rows() / n;
  for (Eigen::Index i = 0; i < n; ++i)
    walk.next(rows.middleRows(i * in, in), out.middleRows(i * block, block));
  return out;
}

}  // namespace

/// Whitened combinations of the columns, piece by piece in the order of time.
class Signature::Pieces {
 public:
  Pieces(const Signature& columns, Eigen::MatrixXd V)
      : columns_(columns), V_(columns.kept_.asDiagonal() * V) {
    if (columns.projection_ && !columns.held_) walk_.emplace(columns.projection_->whitener(), V_.cols());
  }

  /// Without rows at the end.
  [[nodiscard]] Eigen::MatrixXd next() {
    if (!columns_.projection_) {
      const Eigen::MatrixXd& all = *columns_.held_;
      const Eigen::Index from = std::exchange(row_, std::min(all.rows(), row_ + kRowsAtOnce));
      return all.middleRows(from, row_ - from) * V_;
    }
    const Whitener& whitener = columns_.projection_->whitener();
    const auto poses = next_poses(whitener, pose_);
    pose_ += poses.size();
    const Eigen::Index block = whitener.rows_per_pose();
    if (columns_.held_)
      return with_rows_of(*columns_.held_, poses, block,
                          [&](const auto& held) -> Eigen::MatrixXd { return held * V_; });
    return whitened(*walk_, columns_.source_.of(poses) * V_, poses.size(), block);
  }

 private:
  const Signature& columns_;
  Eigen::MatrixXd V_;
  std::optional<Whitener::Walk> walk_;
  std::size_t pose_{0};
  Eigen::Index row_{0};
};

Signature::Signature(Eigen::MatrixXd projected, const Eigen::VectorXd& residual, double absorbed)
    : held_(std::make_shared<const Eigen::MatrixXd>(std::move(projected))),
      absorbed_(absorbed),
      norms_(held_->colwise().norm()),
      by_residual_(held_->transpose() * residual),
      kept_(Eigen::VectorXd::Ones(held_->cols())),
      gram_(linear::gram(*held_)) {}

Signature::Signature(const Residual& residual, RowSource source)
    : projection_(residual.projection()), source_(std::move(source)), absorbed_(residual.absorbed()) {
  const Whitener& whitener = projection_->whitener();
  const Eigen::Index n = source_.columns, block = whitener.rows_per_pose();
  const Eigen::MatrixXd &B = projection_->basis(), r = residual.value();
  const bool hold = residual.poses() <= kPosesHeld;
  Eigen::MatrixXd all(hold ? residual.poses() * block : 0, n);
  Eigen::VectorXd before = Eigen::VectorXd::Zero(n);
  gram_ = Eigen::MatrixXd::Zero(n, n);
  by_basis_ = Eigen::MatrixXd::Zero(B.cols(), n);
  by_residual_ = Eigen::VectorXd::Zero(n);
  Whitener::Walk walk(whitener, n);
  for (std::size_t at = 0; at < whitener.order().size();) {
    const auto poses = next_poses(whitener, at);
    at += poses.size();
    const Eigen::MatrixXd rows = source_.of(poses);
    before += rows.colwise().squaredNorm().transpose();
    const Eigen::MatrixXd W = whitened(walk, rows, poses.size(), block);
    linear::add_gram(W, gram_);
    with_rows_of(B, poses, block,
                 [&](const auto& of_basis) { by_basis_ += linear::transposed_product(of_basis, W); });
    with_rows_of(r, poses, block, [&](const auto& left) { by_residual_ += W.transpose() * left; });
    Eigen::Index row = 0;
    for (const Eigen::Index k : hold ? poses : std::span<const Eigen::Index>()) {
      all.middleRows(k * block, block) = W.middleRows(row, block);
      row += block;
    }
  }
  if (hold) {
    held_ = std::make_shared<const Eigen::MatrixXd>(std::move(all));
    source_.of = {};
  }
  // What the unknowns of the poses take whole is rounding, and no direction.
  norms_ = gram_.diagonal().cwiseSqrt();
  kept_ = (norms_.array() < kRankTolerance * before.array().sqrt()).select(0.0, Eigen::VectorXd::Ones(n)) /
          residual.unit();
  norms_ = kept_.cwiseProduct(norms_);
  by_basis_ = by_basis_ * kept_.asDiagonal();
  by_residual_ = kept_.cwiseProduct(by_residual_);
  gram_.triangularView<Eigen::StrictlyUpper>() = gram_.transpose();
  gram_ = kept_.asDiagonal() * gram_ * kept_.asDiagonal();
  gram_ -= linear::gram(by_basis_);
}

Eigen::Index Signature::rows() const { return projection_ ? projection_->basis().rows() : held_->rows(); }

Eigen::MatrixXd Signature::seen() const {
  constexpr double kShare = 3e-5;  // of the length before, above which rounding is 1e-6 of its square
  const auto enough = gram_.diagonal().array() > kShare * kShare * norms_.array().square();
  return enough.select(Eigen::VectorXd::Ones(cols()), 0.0).asDiagonal().toDenseMatrix();
}

Eigen::MatrixXd Signature::times(const Eigen::MatrixXd& V) const {
  if (!projection_) return *held_ * V;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows(), V.cols());
  if (held_) {
    out.topRows(held_->rows()).noalias() = *held_ * (kept_.asDiagonal() * V);
  } else {
    const Whitener& whitener = projection_->whitener();
    const Eigen::Index block = whitener.rows_per_pose();
    Pieces pieces(*this, V);
    for (std::size_t at = 0; at < whitener.order().size();) {
      const auto poses = next_poses(whitener, at);
      at += poses.size();
      const Eigen::MatrixXd white = pieces.next();
      Eigen::Index row = 0;
      for (const Eigen::Index k : poses) {
        out.middleRows(k * block, block) = white.middleRows(row, block);
        row += block;
      }
    }
  }
  linear::subtract_product(projection_->basis(), by_basis_ * V, out);
  return out;
}

Eigen::MatrixXd Signature::transposed_times(const Eigen::MatrixXd& X) const {
  if (!projection_) return linear::transposed_product(*held_, X);
  if (held_) return kept_.asDiagonal() * linear::transposed_product(*held_, X.topRows(held_->rows()));
  // X are few columns: W'X costs less than W.
  const Whitener& whitener = projection_->whitener();
  const Eigen::MatrixXd back = whitener.apply_transposed(X);
  const Eigen::Index block = back.rows() / static_cast<Eigen::Index>(whitener.order().size());
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(cols(), X.cols());
  for (std::size_t at = 0; at < whitener.order().size();) {
    const auto poses = next_poses(whitener, at);
    at += poses.size();
    with_rows_of(back, poses, block,
                 [&](const auto& rows) { out += linear::transposed_product(source_.of(poses), rows); });
  }
  return kept_.asDiagonal() * out;
}

Eigen::MatrixXd Signature::gram_of(const std::vector<Combination>& all) {
  std::vector<Eigen::Index> first;
  std::map<const Signature*, std::vector<std::size_t>> of_one;
  Eigen::Index n = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    first.push_back(n);
    n += all[i].V.cols();
    of_one[all[i].of].push_back(i);
  }
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n, n);
  if (n == 0) return out;
  std::map<const Signature*, Pieces> pieces;
  for (const auto& [of, combinations] : of_one) {
    Eigen::Index columns = 0, at = 0;
    for (const std::size_t i : combinations) columns += all[i].V.cols();
    Eigen::MatrixXd V(of->cols(), columns);
    for (const std::size_t i : combinations) {
      V.middleCols(at, all[i].V.cols()) = all[i].V;
      at += all[i].V.cols();
    }
    pieces.try_emplace(of, *of, std::move(V));
  }
  Eigen::MatrixXd side_by_side;
  for (Eigen::Index rows = 1; rows > 0;) {
    for (auto& [of, next] : pieces) {
      const Eigen::MatrixXd piece = next.next();
      rows = piece.rows();
      side_by_side.resize(rows, n);
      Eigen::Index at = 0;
      for (const std::size_t i : of_one.at(of)) {
        side_by_side.middleCols(first[i], all[i].V.cols()) = piece.middleCols(at, all[i].V.cols());
        at += all[i].V.cols();
      }
    }
    linear::add_gram(side_by_side, out);
  }
  out.triangularView<Eigen::StrictlyUpper>() = out.transpose();
  if (!all.front().of->projection_) return out;
  Eigen::MatrixXd by_basis(all.front().of->by_basis_.rows(), n);
  for (std::size_t i = 0; i < all.size(); ++i)
    by_basis.middleCols(first[i], all[i].V.cols()).noalias() = all[i].of->by_basis_ * all[i].V;
  return out - linear::gram(by_basis);
}

}  // namespace mgtd::calib::criticism::tests
