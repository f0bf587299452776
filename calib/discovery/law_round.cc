// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/law_round.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <span>
#include <utility>

#include "calib/discovery/random_offset.h"
#include "calib/linear/parts.h"

namespace mgtd::calib::discovery {
namespace {

/// Formulas whose inner number is refined.
constexpr std::size_t kRefined = 30;
/// A law of the library is a name and a coefficient.
constexpr int kLibrarySymbols = 2;
constexpr int kRandomSymbols = 2;
/// The same law: S differs by less than this share, or by this much; a difference of more than the last is
/// evidence, however large S is.
constexpr double kSameShare = 2e-3, kSameFall = 0.3, kSameAtMost = 10;

double log10_p_of(const Tried& t, const criticism::tests::NoiseReference& noise, int channels) {
  const auto axes = static_cast<int>(t.place.channels(channels).size());
  return std::min(0.0,
                  noise.log10_p(t.S, t.k, std::min(axes, channels)) + std::log10(t.place.alike(channels)));
}

/// The library's effects stand in the ranking; those that are a formula already only lend it their name.
void add_library(const Workbench& bench, std::vector<RankedLaw>& ranked) {
  std::vector<RankedLaw> more;
  for (RankedLaw& law : rank_library(bench.library)) {
    const auto same = std::find_if(ranked.begin(), ranked.end(), [&](const RankedLaw& formula) {
      return formula.where == law.where && formula.k == law.k && formula.effect.empty() &&
             std::abs(formula.S - law.S) < kSameFall + std::min(kSameShare * law.S, kSameAtMost) &&
             law.S > 2 * law.k + 8;
    });
    if (same == ranked.end())
      more.push_back(std::move(law));
    else
      same->effect = law.effect;
  }
  ranked.insert(ranked.end(), more.begin(), more.end());
}

/// Where it is asked whether an offset walks, or jumps, beside a law: where the law acts, and on all axes.
/// Jumps of all axes are noise that is larger than it is said to be, which is judged beforehand; of the only
/// sensor each axis is asked about alone.
std::vector<Place> places_of(RandomOffset kind, const Place& law, int channels) {
  const bool array = law.kind == Place::Kind::array, gradient = law.kind == Place::Kind::gradient;
  if (kind == RandomOffset::walk) {
    std::vector<Place> out{law};
    if (!array && channels > 3) out.push_back({Place::Kind::array, 0});
    return out;
  }
  if (array || gradient) return {};
  if (law.kind != Place::Kind::sensor || channels > 3) return {law};
  return {{Place::Kind::axis, 0}, {Place::Kind::axis, 1}, {Place::Kind::axis, 2}};
}

/// The better place counts.
void add_random(const Workbench& bench, const ChannelSums& sums, LawRound& round) {
  const int channels = sums.channels();
  struct Asked {
    RandomOffset kind;
    Place place;
    double score{0};
  };
  std::vector<Asked> all;
  for (const RandomOffset kind : {RandomOffset::walk, RandomOffset::jumps})
    for (const Place& place : places_of(kind, round.head.place, channels)) all.push_back({kind, place});
  linear::for_each_part(all.size(), [&](std::size_t i) {
    Asked& asked = all[i];
    asked.score = evidence_of(asked.kind, asked.place.channels(channels), sums, bench.problem) -
                  2 * std::log(asked.place.alike(channels)) - 2 * kSymbolPrice * kRandomSymbols;
  });
  double best = round.walk = round.jumps = -std::numeric_limits<double>::infinity();
  for (const Asked& asked : all) {
    double& of_kind = asked.kind == RandomOffset::walk ? round.walk : round.jumps;
    of_kind = std::max(of_kind, asked.score);
    if (!(asked.score > best)) continue;
    best = asked.score;
    round.random_where = asked.place.name();
  }
}

/// 2 ln of the sum of all evidence.
double together(const std::vector<RankedLaw>& ranked) {
  double sum = 0;
  for (const RankedLaw& law : ranked) sum += std::exp((law.score - ranked.front().score) / 2);
  return ranked.front().score + 2 * std::log(sum);
}

/// The smallest log10 p of each draw, with what one kind of question found in it.
void lower_to(const LawSearch::Largest& of_kind, const criticism::tests::NoiseReference& noise, int channels,
              std::span<double> log10_p) {
  const double price = std::log10(of_kind.alike);
  for (std::size_t i = 0; i < log10_p.size(); ++i) {
    const auto S = static_cast<double>(of_kind.S[static_cast<Eigen::Index>(i)]);
    log10_p[i] = std::min(log10_p[i], noise.log10_p(S, of_kind.k, std::min(of_kind.axes, channels)) + price);
  }
}

}  // namespace

double limit_log10_p(int looks) { return std::log10(kFalseDiscovery / looks); }

bool stands_out(double log10_p, int looks) { return log10_p < limit_log10_p(looks); }

std::vector<RankedLaw> rank_library(const std::vector<criticism::tests::ScoredFamily>& library) {
  std::vector<RankedLaw> out;
  for (const criticism::tests::ScoredFamily& family : library) {
    const auto& hypotheses = family.candidate_effect->hypotheses;
    const auto values = static_cast<double>(std::max<std::size_t>(1, family.signatures.size()));
    for (std::size_t h = 0; h < hypotheses.size(); ++h) {
      RankedLaw law{.kind = RankedLaw::Kind::library,
                    .effect = family.candidate_effect->name,
                    .place = {},
                    .where = hypotheses[h].where,
                    .symbols = kLibrarySymbols};
      double best = 0, sum = 0;
      for (const criticism::tests::Score& score : family.scores) {
        if (score.hypothesis != h) continue;
        const double q = price_paid(score.S, score.k);
        if (sum == 0 || q > best) {
          sum = sum * std::exp((best - q) / 2) + 1;
          best = q, law.S = score.S, law.k = score.k;
        } else {
          sum += std::exp((q - best) / 2);
        }
      }
      if (sum == 0) continue;
      law.score = best + 2 * std::log(sum / values) - 2 * std::log(hypotheses[h].alike) -
                  2 * kSymbolPrice * law.symbols;
      out.push_back(std::move(law));
    }
  }
  return out;
}

Result<LawRound> law_round(const Workbench& bench, const ChannelSums& sums, bool with_library) {
  if (bench.problem.stop.stop_requested()) return fail(ErrorCode::state, "the search was stopped");
  const LawSearch search(bench.products, sums);
  const std::vector<Tried> tried = search.scores();
  LawRound out{.hypotheses = tried.size()};
  for (const Tried& t : tried)
    out.log10_p_best = std::min(out.log10_p_best, log10_p_of(t, bench.noise, sums.channels()));
  out.ranked = rank_formulas(tried, bench.products.values(), sums.channels());
  if (out.ranked.empty()) return fail(ErrorCode::refused, "no formula can be tried on these poses");
  if (const auto ok = refine_inner(out.ranked, kRefined, bench.grammar, bench.inputs, sums); !ok)
    return tl::unexpected(ok.error());
  if (with_library) add_library(bench, out.ranked);
  share_probability(out.ranked);
  out.score = together(out.ranked);
  out.head = *std::find_if(out.ranked.begin(), out.ranked.end(),
                           [](const RankedLaw& law) { return law.kind == RankedLaw::Kind::formula; });
  add_random(bench, sums, out);
  return out;
}

std::vector<double> best_of_noise(const LawSearch& search, const ChannelSums& sums,
                                  const criticism::tests::NoiseReference& noise, int draws,
                                  std::uint64_t seed) {
  constexpr std::size_t kTogether = 250;  // scores of every formula on every draw: some ten megabytes
  std::mt19937_64 random(seed);
  const std::vector<Eigen::MatrixXf> unit_columns = search.unit_columns();
  std::vector<double> out(static_cast<std::size_t>(draws), 0.0);
  for (std::span<double> rest(out); !rest.empty();) {
    std::vector<std::span<double>> of_draws;
    std::vector<Eigen::MatrixXd> drawn;
    while (!rest.empty() && drawn.size() < linear::threads()) {
      of_draws.push_back(rest.first(std::min(kTogether, rest.size())));
      rest = rest.subspan(of_draws.back().size());
      drawn.push_back(sums.noise(static_cast<Eigen::Index>(of_draws.back().size()), random));
    }
    linear::for_each_part(drawn.size(), [&](std::size_t i) {
      for (const LawSearch::Largest& of_kind :
           search.largest(sums.scores_of(std::move(drawn[i])), unit_columns))
        lower_to(of_kind, noise, sums.channels(), of_draws[i]);
    });
  }
  return out;
}

}  // namespace mgtd::calib::discovery
