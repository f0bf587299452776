// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/rivals.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mgtd::calib {
namespace {

constexpr double kPossible = 2.6;   ///< one true name in 200 would be lost
constexpr double kShown = 0.999;    ///< pairs that are told apart better than this are no rivals
constexpr double kNothing = 1e-3;   ///< of a chi-square
constexpr double kHopeless = 0.25;  ///< of the winner's fall of chi-square: z is above kPossible then

/// The space of a hypothesis and its fit to the residual.
struct Explained {
  Eigen::MatrixXd U;
  Eigen::VectorXd v;
};

Explained explained(const ScoredFamily& family, const Score& score) {
  const Signature& s = family.signatures[score.variant];
  const OneStep step = one_step(s, family.suspect->hypotheses[score.hypothesis]);
  Explained out{.U = s.columns * step.basis, .v = {}};
  out.v = out.U * (step.basis.transpose() * s.by_residual);
  return out;
}

Rival compare(const Score& won, const Explained& a, const ScoredFamily& family, const Score& score) {
  const Explained b = explained(family, score);
  const double lambda_ba = (b.v - a.U * (a.U.transpose() * b.v)).squaredNorm();
  const double lambda_ab = (a.v - b.U * (b.U.transpose() * a.v)).squaredNorm();
  const double deficit = (won.S - won.k) - (score.S - score.k);
  Rival out{.effect = family.suspect->name,
            .where = family.suspect->hypotheses[score.hypothesis].where,
            .spec = spec_of(*family.suspect, family.suspect->hypotheses[score.hypothesis], score.variant)};
  out.z = (deficit + lambda_ba) / (2 * std::sqrt(std::max(lambda_ba, 1e-12)));
  out.alike = 1 - lambda_ba / std::max(b.v.squaredNorm(), kNothing);
  out.possible = out.z < kPossible || lambda_ba < kNothing || out.alike > kAlike;
  out.p_right = told_right(lambda_ab);
  return out;
}

}  // namespace

double told_right(double lambda) { return 0.5 * std::erfc(-std::sqrt(lambda / 8)); }

std::vector<Rival> rivals_of(const std::vector<ScoredFamily>& families, std::size_t a) {
  const Score& won = families[a].winner();
  const Explained best = explained(families[a], won);
  std::vector<Rival> out;
  for (std::size_t b = 0; b < families.size(); ++b) {
    if (b == a) continue;
    Rival closest{.z = std::numeric_limits<double>::infinity()};
    for (const Score& score : families[b].scores) {
      if (score.S < kHopeless * (won.S - won.k)) continue;
      Rival rival = compare(won, best, families[b], score);
      if (rival.z < closest.z) closest = std::move(rival);
    }
    if (closest.possible || closest.p_right < kShown) out.push_back(std::move(closest));
  }
  std::sort(out.begin(), out.end(), [](const Rival& x, const Rival& y) { return x.z < y.z; });
  return out;
}

}  // namespace mgtd::calib
