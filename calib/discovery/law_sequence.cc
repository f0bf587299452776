// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/law_sequence.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/criticism/tests/multiplicity.h"
#include "calib/discovery/library_beside.h"

namespace mgtd::calib::discovery {
namespace {

std::string name_of(std::size_t law) { return fmt::format("law{}", law + 1); }

/// Each law is looked for again beside the others, until nothing changes. True where one did.
Result<bool> sweep(const Workbench& bench, const ChannelSums& bare, const Eigen::MatrixXd& of_gradient,
                   double questions, std::vector<ChosenLaw>& laws) {
  constexpr int kSweeps = 2;
  bool any = false;
  for (int round = 0; round < kSweeps && laws.size() > 1; ++round) {
    bool changed = false;
    for (std::size_t i = 0; i < laws.size(); ++i) {
      ChannelSums sums = bare;
      std::vector<const FittedLaw*> others;
      for (std::size_t j = 0; j < laws.size(); ++j) {
        if (j == i) continue;
        take_out(laws[j].head, sums);
        others.push_back(&laws[j].head);
      }
      Workbench beside = bench;
      if (i == 0) beside.library = library_beside(bench, others, of_gradient);
      const auto again = law_round(beside, sums, i == 0);
      if (!again) return tl::unexpected(again.error());
      auto better = chosen_law(beside, sums, *again, questions, name_of(i));
      if (!better) return tl::unexpected(better.error());
      changed = changed || better->law.stands_out != laws[i].law.stands_out ||
                better->law.formulas.front().formula != laws[i].law.formulas.front().formula;
      laws[i] = *std::move(better);
    }
    if (!changed) break;
    any = true;
  }
  return any;
}

/// Says of each law which effects of the library describe it as well.
void compare_with_library(const Workbench& bench, const Eigen::MatrixXd& of_gradient,
                          std::vector<ChosenLaw>& laws) {
  const double as_well = 2 * std::log(100.0);
  for (ChosenLaw& law : laws) {
    std::vector<const FittedLaw*> others;
    for (const ChosenLaw& other : laws)
      if (&other != &law) others.push_back(&other.head);
    for (const RankedLaw& effect :
         rank_library(others.empty() ? bench.library : library_beside(bench, others, of_gradient)))
      if (effect.score > law.score - as_well) law.law.as_well.push_back({effect.effect, effect.where});
  }
}

constexpr double kNever = -std::numeric_limits<double>::infinity();

/// Evidence of the first m laws, alone and with an offset that walks or jumps beside them.
struct Model {
  double alone{kNever}, walk{kNever}, jumps{kNever};
  std::string random_where{};

  [[nodiscard]] double random() const { return std::max(walk, jumps); }
  [[nodiscard]] double best() const { return std::max(alone, random()); }
};

/// For m = 0, 1, ...; no law at all and nothing random is no model here: the p-value judges that.
using Models = std::vector<Model>;

Model model_of(std::size_t m, double T, const LawRound& left) {
  return {.alone = m == 0 ? kNever : T,
          .walk = T + left.walk,
          .jumps = T + left.jumps,
          .random_where = left.random_where};
}

double best_alone(const Models& models) {
  double out = kNever;
  for (const Model& model : models) out = std::max(out, model.alone);
  return out;
}

/// m of the best model with a random offset.
std::size_t best_random(const Models& models) {
  return static_cast<std::size_t>(
      std::max_element(models.begin(), models.end(),
                       [](const Model& a, const Model& b) { return a.random() < b.random(); }) -
      models.begin());
}

/// Law i stands in every model of more than i laws, whatever stands beside it there; a random offset stands
/// in its place in those of no more.
void hold_against_random(const Models& models, std::size_t i, FoundLaw& law) {
  double top = kNever, held = kNever, walk = kNever, jumps = kNever;
  for (const Model& model : models) top = std::max(top, model.best());
  const auto weight = [top](double evidence) { return std::exp((evidence - top) / 2); };
  double with = 0, walk_instead = 0, jumps_instead = 0, walk_beside = 0, jumps_beside = 0;
  double random = kNever;
  for (std::size_t m = 0; m < models.size(); ++m) {
    const Model& model = models[m];
    if (m > i) {
      held = std::max(held, model.best());
      with += weight(model.alone) + weight(model.walk) + weight(model.jumps);
      walk_beside += weight(model.walk), jumps_beside += weight(model.jumps);
      continue;
    }
    walk = std::max(walk, model.walk), jumps = std::max(jumps, model.jumps);
    walk_instead += weight(model.walk), jumps_instead += weight(model.jumps);
    if (model.random() > random) random = model.random(), law.random_where = model.random_where;
  }
  law.over_walk = held - walk, law.over_jumps = held - jumps;
  const std::size_t best = best_random(models);
  law.over_nothing_beside = models[best].random() - best_alone(models);
  law.random_beside = best > i && law.over_nothing_beside > 0;
  const double all = with + walk_instead + jumps_instead;
  law.walk_P = (law.random_beside ? walk_beside : walk_instead) / all;
  law.jumps_P = (law.random_beside ? jumps_beside : jumps_instead) / all;
  if (law.random_beside) law.random_where = models[best].random_where;
  for (FoundFormula& formula : law.formulas) formula.P *= with / all;
}

}  // namespace

Result<LawSequence> law_sequence(const Workbench& bench, const ChannelSums& bare,
                                 const Eigen::MatrixXd& of_gradient, double questions) {
  LawSequence out{.laws = {}, .left = bare};
  Models models;
  double T = 0;
  double log10_p_best = 0;  // of what the laws leave
  while (true) {
    const auto round = law_round(bench, out.left, out.laws.empty());
    if (!round) return tl::unexpected(round.error());
    if (out.laws.empty()) out.hypotheses = round->hypotheses;
    log10_p_best = round->log10_p_best;
    models.push_back(model_of(out.laws.size(), T, *round));
    const bool more = stands_out(criticism::tests::best_of(round->log10_p_best, questions), bench.looks);
    if (out.laws.size() >= kMostLaws || (!out.laws.empty() && !more)) break;
    auto one = chosen_law(bench, out.left, *round, questions, name_of(out.laws.size()));
    if (!one) return tl::unexpected(one.error());
    out.laws.push_back(*std::move(one));
    T += round->score;
    if (!more) {
      models.push_back({.alone = T});
      break;
    }
    take_out(out.laws.back().head, out.left);
  }
  // What is random beside fewer laws takes the place of the later ones.
  const std::size_t with_random = best_random(models), found = out.laws.size();
  if (models[with_random].random() > best_alone(models))
    out.laws.resize(std::max<std::size_t>(1, with_random));
  const auto changed = sweep(bench, bare, of_gradient, questions, out.laws);
  if (!changed) return tl::unexpected(changed.error());
  if (out.laws.front().law.stands_out) compare_with_library(bench, of_gradient, out.laws);
  for (std::size_t i = 0; i < out.laws.size(); ++i) hold_against_random(models, i, out.laws[i].law);
  if (*changed || out.laws.size() != found) {
    out.left = bare;
    if (out.laws.front().law.stands_out)
      for (const ChosenLaw& law : out.laws) take_out(law.head, out.left);
    const auto left = law_round(bench, out.left, false);
    if (!left) return tl::unexpected(left.error());
    log10_p_best = left->log10_p_best;
  }
  out.log10_p_left = criticism::tests::best_of(log10_p_best, questions);
  return out;
}

}  // namespace mgtd::calib::discovery
