// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/alternatives.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "calib/criticism/tests/alternative_ranking.h"
#include "calib/criticism/tests/detectable.h"

namespace mgtd::calib::criticism::tests {
namespace {

constexpr int kRuns = 2000;        ///< drawn, times looks: ten of them are the limit
constexpr int kBestQuestions = 3;  ///< the best questions of an alternative stand for all of its questions
constexpr double kSure = 0.99;     ///< with which a pair is told apart beyond its form
constexpr double kShown = 0.999;   ///< a pair that is told apart better than this is not listed
constexpr double kNothing = 1e-3;  ///< of a chi-square
/// Coefficients more than those of the winner: by chance they would hardly be what the winner makes them.
constexpr int kFreer = 3;
/// Behind the winner; to fall back so far a true one needs noise of four standard deviations.
constexpr double kGone = 16;

/// How many coefficients of a question would stand out if they were as large as the largest that was found.
int would_be_seen(const ScoredFamily& family, const Score& score) {
  const OneStep step =
      one_step(family.signatures[score.variant], family.candidate_effect->hypotheses[score.hypothesis]);
  const double largest = step.value.cwiseAbs().maxCoeff();
  return static_cast<int>((step.covariance.diagonal().array().sqrt() * kSeen < largest).count());
}

double share_inside(double length2, double outside) { return 1 - outside / std::max(length2, kNothing); }

/// `drawn`: the chance that it fell behind is asked for.
Alternative compare(const AlternativeRanking& ranking, const std::vector<ScoredFamily>& families,
                    const RankedAlternative& a, const RankedAlternative& b, bool drawn, int looks) {
  const ScoredFamily& family = families[b.family];
  const Hypothesis& h = family.candidate_effect->hypotheses[b.score->hypothesis];
  const double length2_a = ranking.length2(a);
  const double lambda_ba = ranking.outside(b, a), lambda_ab = ranking.outside(a, b);
  Alternative out{.effect = family.candidate_effect->name,
                  .where = h.where,
                  .spec = spec_of(*family.candidate_effect, h, b.score->variant)};
  out.alike = share_inside(ranking.length2(b), lambda_ba);
  const Hypothesis& won = families[a.family].candidate_effect->hypotheses[a.score->hypothesis];
  if (h.where == won.where) out.alike = std::max(out.alike, share_inside(length2_a, lambda_ab));
  // Of two fields of the site what a dipole has beyond its gradient is as exact as the gradient.
  const bool exact = family.candidate_effect->level == effects::Level::site &&
                     families[a.family].candidate_effect->level == effects::Level::site;
  const bool freer = would_be_seen(family, *b.score) >= a.score->k + kFreer;
  const bool alike = !exact && out.alike > kAlike &&
                     family.candidate_effect->reads == families[a.family].candidate_effect->reads;
  out.form_only = alike && !freer;
  out.p_right = probability_right(out.form_only ? beyond_form(lambda_ab, length2_a) : lambda_ab);
  if (drawn && a.L - b.L < kGone) out.p_behind = ranking.behind(b);
  if (alike && freer) out.p_right = 1 - out.p_behind;
  out.possible = out.p_behind >= kLost / looks || (out.form_only && out.p_right < kSure);
  return out;
}

bool nearer(const Alternative& x, const Alternative& y) {
  return std::make_pair(x.possible, x.p_behind) > std::make_pair(y.possible, y.p_behind);
}

}  // namespace

double probability_right(double lambda) { return 0.5 * std::erfc(-std::sqrt(lambda / 8)); }

double beyond_form(double lambda, double length2) { return std::max(0.0, lambda - (1 - kAlike) * length2); }

std::vector<Alternative> alternatives_of(const std::vector<ScoredFamily>& families, std::size_t a,
                                         std::uint64_t seed, int looks) {
  AlternativeRanking ranking(families, a);
  const auto& all = ranking.all();
  const auto winner = std::find_if(all.begin(), all.end(), [&](const RankedAlternative& c) {
    return c.family == a && c.score == &families[a].winner();
  });
  if (winner == all.end()) return {};
  ranking.draw(seed, kRuns * looks);
  std::vector<Alternative> out;
  for (std::size_t b = 0; b < families.size(); ++b) {
    if (b == a) continue;
    std::optional<Alternative> nearest;
    int asked = 0;
    for (const RankedAlternative& c : all) {
      if (c.family != b) continue;
      Alternative alternative = compare(ranking, families, *winner, c, asked++ < kBestQuestions, looks);
      if (!nearest || nearer(alternative, *nearest)) nearest = std::move(alternative);
    }
    if (nearest && (nearest->possible || nearest->p_right < kShown)) out.push_back(*std::move(nearest));
  }
  std::sort(out.begin(), out.end(), nearer);
  return out;
}

}  // namespace mgtd::calib::criticism::tests
