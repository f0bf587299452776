// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/law_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/criticism/tests/multiplicity.h"

namespace mgtd::calib::discovery {
namespace {

std::string name_of(std::size_t law) { return fmt::format("law{}", law + 1); }

/// Each law is looked for again beside the others, until nothing changes.
Result<void> sweep(const Workbench& bench, const ChannelSums& bare, double questions,
                   std::vector<ChosenLaw>& laws) {
  constexpr int kSweeps = 2;
  for (int round = 0; round < kSweeps && laws.size() > 1; ++round) {
    bool changed = false;
    for (std::size_t i = 0; i < laws.size(); ++i) {
      ChannelSums sums = bare;
      for (std::size_t j = 0; j < laws.size(); ++j)
        if (j != i) take_out(laws[j].head, sums);
      const auto again = law_round(bench, sums, i == 0);
      if (!again) return tl::unexpected(again.error());
      auto better = chosen_law(bench, sums, *again, questions, name_of(i));
      if (!better) return tl::unexpected(better.error());
      changed = changed || better->law.formulas.front().formula != laws[i].law.formulas.front().formula;
      laws[i] = *std::move(better);
    }
    if (!changed) break;
  }
  return {};
}

/// Models of the first m laws, alone and with an offset that walks or jumps beside them.
struct Models {
  double laws{-std::numeric_limits<double>::infinity()}, walk{laws}, jumps{laws};
  std::size_t with_random{0};  ///< m of the best model with a random offset
  std::string random_where{};

  void add(std::size_t m, double T, const LawRound& left) {
    laws = std::max(laws, m == 0 ? laws : T);
    const double random = std::max(left.walk, left.jumps);
    if (T + random > std::max(walk, jumps)) with_random = m, random_where = left.random_where;
    walk = std::max(walk, T + left.walk);
    jumps = std::max(jumps, T + left.jumps);
  }
};

void hold_against_random(const Models& models, FoundLaw& first) {
  first.over_walk = models.laws - models.walk;
  first.over_jumps = models.laws - models.jumps;
  first.random_where = models.random_where;
  first.random_beside = models.with_random > 0 && std::max(models.walk, models.jumps) > models.laws;
  const double top = std::max({models.laws, models.walk, models.jumps});
  const double laws = std::exp((models.laws - top) / 2), walk = std::exp((models.walk - top) / 2),
               jumps = std::exp((models.jumps - top) / 2), all = laws + walk + jumps;
  first.walk_P = walk / all;
  first.jumps_P = jumps / all;
  if (!first.random_beside)
    for (FoundFormula& formula : first.formulas) formula.P *= laws / all;
}

}  // namespace

Result<LawSequence> law_sequence(const Workbench& bench, const ChannelSums& bare, double questions) {
  LawSequence out{.laws = {}, .left = bare};
  Models models;
  double T = 0;
  while (true) {
    const auto round = law_round(bench, out.left, out.laws.empty());
    if (!round) return tl::unexpected(round.error());
    if (out.laws.empty()) out.hypotheses = round->hypotheses;
    models.add(out.laws.size(), T, *round);
    const bool more = stands_out(criticism::tests::best_of(round->log10_p_best, questions));
    if (out.laws.size() >= kMostLaws || (!out.laws.empty() && !more)) break;
    auto one = chosen_law(bench, out.left, *round, questions, name_of(out.laws.size()));
    if (!one) return tl::unexpected(one.error());
    out.laws.push_back(*std::move(one));
    T += round->score;
    if (!more) {
      models.laws = T;
      break;
    }
    take_out(out.laws.back().head, out.left);
  }
  // What is random beside fewer laws takes the place of the later ones.
  if (std::max(models.walk, models.jumps) > models.laws)
    out.laws.resize(std::max<std::size_t>(1, models.with_random));
  if (const auto ok = sweep(bench, bare, questions, out.laws); !ok) return tl::unexpected(ok.error());
  hold_against_random(models, out.laws.front().law);
  out.left = bare;
  if (out.laws.front().law.stands_out)
    for (const ChosenLaw& law : out.laws) take_out(law.head, out.left);
  const auto left = law_round(bench, out.left, false);
  if (!left) return tl::unexpected(left.error());
  out.log10_p_left = criticism::tests::best_of(left->log10_p_best, questions);
  return out;
}

}  // namespace mgtd::calib::discovery
