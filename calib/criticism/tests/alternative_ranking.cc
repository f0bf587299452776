// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/alternative_ranking.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "calib/linear/normal_draws.h"
#include "calib/stats/chi_square.h"

namespace mgtd::calib::criticism::tests {
namespace {

constexpr double kHopeless = 0.25;  ///< of the winner's fall of chi-square
/// Of L behind the winner. A truth that lies D behind needs noise of sqrt(D) standard deviations for it.
constexpr double kFarBehind = 30;
/// Of the winner's fall: an alike one stays in sight at any size.
constexpr double kInSight = 0.1;
/// Values of one searched number. All that were tried take part: in another run another one of them would
/// fit best, and with those near the winner alone a search would seem to win less easily than it does.
constexpr std::size_t kValues = 30;
constexpr std::size_t kMostKept = 200;
constexpr double kNever = -1e9;

RankedAlternative ranked_alternative_of(const ScoredFamily& family, std::size_t f, const Score& score,
                                        double S0) {
  const int alike = family.candidate_effect->hypotheses[score.hypothesis].alike;
  RankedAlternative out{.family = f, .score = &score};
  out.price =
      S0 + 2 * std::log(10.0) * (stats::chi_square_log10_p(S0, score.k) + std::log10(alike * family.asked));
  out.L = score.S - out.price;
  return out;
}

/// The best of each question, and of all no more than are needed.
std::vector<RankedAlternative> nearest(const std::vector<ScoredFamily>& families, std::size_t a) {
  const double S0 = families[a].winner().S;
  std::vector<RankedAlternative> found;
  for (std::size_t f = 0; f < families.size(); ++f) {
    for (const Score& score : families[f].scores)
      if (score.S >= kHopeless * S0) found.push_back(ranked_alternative_of(families[f], f, score, S0));
  }
  std::sort(found.begin(), found.end(),
            [](const RankedAlternative& x, const RankedAlternative& y) { return x.L > y.L; });
  const double sight = std::max(kFarBehind, kInSight * S0);
  std::vector<RankedAlternative> out;
  std::map<std::pair<std::size_t, std::size_t>, std::size_t> values;
  for (const RankedAlternative& c : found) {
    if (out.size() == kMostKept || c.L < found.front().L - sight) break;
    if (values[{c.family, c.score->hypothesis}]++ < kValues) out.push_back(c);
  }
  return out;
}

}  // namespace

AlternativeRanking::AlternativeRanking(const std::vector<ScoredFamily>& families, std::size_t a)
    : families_(families.size()), all_(nearest(families, a)) {
  std::vector<Signature::Combination> combinations;
  Eigen::Index columns = 0;
  for (RankedAlternative& c : all_) {
    const ScoredFamily& family = families[c.family];
    const Signature& s = family.signatures[c.score->variant];
    combinations.push_back(
        {&s, orthonormal_combinations(s, family.candidate_effect->hypotheses[c.score->hypothesis])});
    c.first = columns, c.count = combinations.back().V.cols();
    columns += c.count;
  }
  gram_ = Signature::gram_of(combinations);
  t_.resize(columns);
  for (std::size_t i = 0; i < all_.size(); ++i)
    t_.segment(all_[i].first, all_[i].count) =
        combinations[i].V.transpose() * combinations[i].of->by_residual();
}

double AlternativeRanking::outside(const RankedAlternative& c, const RankedAlternative& other) const {
  const Eigen::VectorXd inside =
      gram_.block(other.first, c.first, other.count, c.count) * t_.segment(c.first, c.count);
  return std::max(0.0, length2(c) - inside.squaredNorm());
}

void AlternativeRanking::draw(std::uint64_t seed, int draws) {
  noise_ = linear::normal_draws(gram_, draws, seed);
}

double AlternativeRanking::deficit(const Eigen::VectorXd& best, std::size_t family) const {
  double others = kNever;
  for (std::size_t f = 0; f < families_; ++f)
    if (f != family) others = std::max(others, best[static_cast<Eigen::Index>(f)]);
  return others - best[static_cast<Eigen::Index>(family)];
}

double AlternativeRanking::behind(const RankedAlternative& truth) const {
  const Eigen::VectorXd shift =
      gram_.middleCols(truth.first, truth.count) * t_.segment(truth.first, truth.count);
  Eigen::VectorXd best(static_cast<Eigen::Index>(families_));
  const auto rank = [&](const auto& sums) {
    best.setConstant(kNever);
    for (const RankedAlternative& c : all_) {
      double& top = best[static_cast<Eigen::Index>(c.family)];
      top = std::max(top, sums.segment(c.first, c.count).squaredNorm() - c.price);
    }
    return deficit(best, truth.family);
  };
  const double seen = rank(t_);
  Eigen::Index noise_inflation = 1;
  for (Eigen::Index i = 0; i < noise_.cols(); ++i)
    noise_inflation += rank((noise_.col(i) + shift).eval()) >= seen ? 1 : 0;
  return static_cast<double>(noise_inflation) / static_cast<double>(noise_.cols() + 1);
}

}  // namespace mgtd::calib::criticism::tests
