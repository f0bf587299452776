// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/forward_step.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace mgtd::calib::criticism::search {
namespace {

/// Whether coefficients laid out as `whole` can be those laid out as `part`.
bool holds(const effects::Where& whole, const effects::Where& part) {
  if (whole == part || whole.scale == effects::Where::Scale::each_axis) return true;
  return whole.scale == effects::Where::Scale::each_sensor &&
         (part.scale == effects::Where::Scale::sensor || part.scale == effects::Where::Scale::all);
}

bool holds(const effects::Effect& whole, const effects::Effect& part) {
  if (whole.name() != part.name()) return false;
  const auto a = effects::EffectSpec::parse(whole.spec()), b = effects::EffectSpec::parse(part.spec());
  if (!a || !b || a->parameters != b->parameters) return false;
  if (!a->where) return whole.level() != effects::Level::axis;
  return b->where && holds(*a->where, *b->where);
}

/// The axis "s3.z" of a law is in the model with a number of its own.
bool has_axis(const std::vector<effects::EffectPtr>& model, const tests::ScoredFamily& winner,
              const std::string& axis) {
  if (winner.candidate_effect->parameter.empty()) return false;
  return std::any_of(model.begin(), model.end(), [&](const effects::EffectPtr& effect) {
    if (effect->name() != winner.candidate_effect->name) return false;
    const auto& all = effect->coefficients();
    return std::any_of(all.begin(), all.end(), [&](const effects::Coefficient& c) { return c.name == axis; });
  });
}

/// One axis and one value of the searched number.
struct Pick {
  std::size_t hypothesis{0}, variant{0};
  double S{0};
};

/// Picks one column of the winner's family after the other, each time that with the largest score once those
/// before are taken out: a pivoted Cholesky decomposition of the Gram matrix of all of them.
class Picking {
 public:
  Picking(const tests::ScoredFamily& winner, const std::vector<effects::EffectPtr>& model) {
    std::vector<tests::Signature::Combination> columns;
    const auto& hypotheses = winner.candidate_effect->hypotheses;
    for (std::size_t h = 0; h < hypotheses.size(); ++h) {
      const tests::Hypothesis& axis = hypotheses[h];
      if (axis.axes != 1 || axis.combine.cols() != 1 || has_axis(model, winner, axis.where)) continue;
      for (std::size_t v = 0; v < winner.signatures.size(); ++v) {
        const tests::Signature& s = winner.signatures[v];
        if (axis.combine.rows() != s.cols()) continue;  // of another form of the law
        all_.push_back({.hypothesis = h, .variant = v});
        columns.push_back({&s, axis.combine});
      }
    }
    gram_ = tests::Signature::gram_of(columns);
    left_.resize(gram_.rows());
    for (std::size_t i = 0; i < columns.size(); ++i)
      left_[static_cast<Eigen::Index>(i)] = columns[i].V.col(0).dot(columns[i].of->by_residual());
    own_ = gram_.diagonal();
    L_.resize(gram_.rows(), 0);
  }

  /// With S = 0 where none is left.
  [[nodiscard]] Pick next() {
    constexpr double kOwn = 1e-6;  // of a squared length: less is what the others hold already
    Eigen::Index best = -1;
    double S = 0;
    for (Eigen::Index i = 0; i < own_.size(); ++i) {
      const bool picked = std::find(axes_.begin(), axes_.end(), at(i).hypothesis) != axes_.end();
      if (picked || !(own_[i] > kOwn * gram_(i, i))) continue;
      if (const double here = left_[i] * left_[i] / own_[i]; here > S) S = here, best = i;
    }
    if (best < 0) return {};
    const Eigen::VectorXd column = (gram_.col(best) - L_ * L_.row(best).transpose()) / std::sqrt(own_[best]);
    left_ -= column * (left_[best] / std::sqrt(own_[best]));
    own_ -= column.cwiseAbs2();
    L_.conservativeResize(Eigen::NoChange, L_.cols() + 1);
    L_.rightCols<1>() = column;
    Pick out = at(best);
    axes_.push_back(out.hypothesis);
    out.S = S;
    return out;
  }

 private:
  [[nodiscard]] const Pick& at(Eigen::Index i) const { return all_[static_cast<std::size_t>(i)]; }

  std::vector<Pick> all_;
  std::vector<std::size_t> axes_;  ///< of those that were picked
  Eigen::MatrixXd gram_, L_;
  Eigen::VectorXd left_;  ///< products with what the picked ones leave of the residual
  Eigen::VectorXd own_;   ///< squared lengths of what the picked ones leave of the columns
};

/// The few axes that make up the winner; empty where they are many or do not.
std::vector<Pick> few_axes(const tests::ScoredFamily& winner, const std::vector<effects::EffectPtr>& model) {
  constexpr double kStandsOut = 20, kWorthwhile = 0.01;  // of the largest
  constexpr std::size_t kFew = 4;
  constexpr double kMost = 0.8;  // of the winner's score
  std::vector<Pick> picked;
  Picking picking(winner, model);
  double sum = 0;
  while (picked.size() <= kFew) {
    const Pick next = picking.next();
    if (next.S < kStandsOut || (!picked.empty() && next.S < kWorthwhile * picked.front().S)) break;
    sum += next.S;
    picked.push_back(next);
  }
  if (picked.size() > kFew || sum < kMost * winner.winner().S) picked.clear();
  return picked;
}

}  // namespace

Result<ForwardStep> forward_step(const std::vector<effects::EffectPtr>& model,
                                 const tests::ScoredFamily& winner) {
  ForwardStep out;
  const tests::CandidateEffect& candidate_effect = *winner.candidate_effect;
  const bool one_axis = winner.where().axes == 1;
  std::vector<Pick> picked;
  if (winner.candidate_effect->level == effects::Level::axis && !one_axis) picked = few_axes(winner, model);
  if (picked.empty()) {
    if (one_axis && has_axis(model, winner, winner.where().where)) {
      return fail(ErrorCode::refused,
                  winner.candidate_effect->name + " of " + winner.where().where + " is in the model already");
    }
    const std::size_t variant = winner.winner().variant;
    auto added = candidate_effect.dipole_at
                     ? Result<effects::EffectPtr>(candidate_effect.variants[variant])
                     : candidate_effect.make(&winner.where(), candidate_effect.values[variant]);
    if (!added) return tl::unexpected(added.error());
    out.added.push_back(*std::move(added));
  }
  for (const Pick& p : picked) {
    auto added =
        candidate_effect.make(&candidate_effect.hypotheses[p.hypothesis], candidate_effect.values[p.variant]);
    if (!added) return tl::unexpected(added.error());
    out.added.push_back(*std::move(added));
  }
  for (const effects::EffectPtr& effect : model) {
    if (std::none_of(out.added.begin(), out.added.end(),
                     [&](const effects::EffectPtr& added) { return holds(*added, *effect); }))
      out.model.push_back(effect);
  }
  out.model.insert(out.model.end(), out.added.begin(), out.added.end());
  return out;
}

}  // namespace mgtd::calib::criticism::search
