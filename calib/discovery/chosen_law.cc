// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/chosen_law.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "calib/criticism/tests/alternatives.h"
#include "calib/criticism/tests/multiplicity.h"
#include "calib/discovery/formula_text.h"

namespace mgtd::calib::discovery {
namespace {

/// Formulas whose probabilities add up to this are the set; of a large set those that lead are described, and
/// the others counted.
constexpr double kShownSet = 0.99;
constexpr std::size_t kMostShown = 40;
/// Of a fall of chi-square: two formulas that differ by less are the same on these poses.
constexpr double kAlike = 1e-9;

/// Of the formulas alone: beside an effect of the library all of theirs may be too small for a number.
std::vector<Share> shares(const std::vector<RankedLaw>& ranked, double of_head,
                          const std::function<std::string(const RankedLaw&)>& name) {
  constexpr double kShown = 0.001;
  std::map<std::string, double> sums;
  double all = 0;
  for (const RankedLaw& law : ranked) {
    if (law.kind != RankedLaw::Kind::formula) continue;
    const double P = std::exp((law.score - of_head) / 2);
    sums[name(law)] += P;
    all += P;
  }
  std::vector<Share> out;
  for (const auto& [of, P] : sums)
    if (P > kShown * all) out.push_back({of, P / all});
  std::stable_sort(out.begin(), out.end(), [](const Share& a, const Share& b) { return a.P > b.P; });
  return out;
}

double gradient_size_nT(LawOnChannels law, const ChannelSums& sums) {
  for (Eigen::VectorXd& component : law)
    if (component.size() > 0) component.array() -= component.mean();
  std::vector<int> components;
  std::vector<Eigen::MatrixXd> values;
  for (int c = sums.channels(); c < sums.total(); ++c) {
    components.push_back(c);
    values.emplace_back(law[static_cast<std::size_t>(c)]);
  }
  double weights = 0;
  for (int c = 0; c < sums.channels(); ++c) weights += sums.before_of_one(c).sum();
  return std::sqrt(sums.before_projection(components, values).sum() / weights);
}

/// Rms of what a law adds to the readings; of a gradient each counts by its weight.
double size_nT(const FittedLaw& law, const ChannelSums& sums) {
  if (law.place.kind == Place::Kind::gradient) return gradient_size_nT(law.law, sums);
  double squares = 0;
  Eigen::Index n = 0;
  for (const Eigen::VectorXd& on_channel : law.law) {
    if (on_channel.size() == 0) continue;
    squares += (on_channel.array() - on_channel.mean()).square().sum();
    n += on_channel.size();
  }
  return n == 0 ? 0 : std::sqrt(squares / static_cast<double>(n));
}

FoundFormula described(const RankedLaw& ranked, const FittedLaw& fitted, const Family& family,
                       const std::string& name, const ChannelSums& sums) {
  FoundFormula out{.formula = shown(fitted.columns, fitted.place),
                   .columns = fitted.columns,
                   .where = fitted.place.name(),
                   .library = ranked.effect,
                   .specs = specs_of(fitted.columns, fitted.place, name)};
  for (const std::string& covariate : family.covariates)
    out.covariates.push_back(shown_covariate(covariate, fitted.place));
  out.P = ranked.P, out.S = fitted.S, out.k = fitted.k, out.symbols = family.symbols;
  out.size_nT = size_nT(fitted, sums);
  if (family.refined) out.inner = ranked.inner, out.inner_unit = family.inner_unit;
  const auto places = coefficient_places(fitted.columns, fitted.place, sums.channels());
  const std::string unit = fitted.place.kind == Place::Kind::gradient ? "nT/m" : "nT";
  for (Eigen::Index i = 0; i < fitted.value.size(); ++i) {
    const double variance = fitted.covariance(i, i);
    if (variance > 0)
      out.coefficients.push_back(
          {places[static_cast<std::size_t>(i)], fitted.value[i], std::sqrt(variance), unit});
  }
  return out;
}

FoundFormula described(const RankedLaw& library) {
  FoundFormula out{
      .formula = library.effect, .columns = {}, .where = library.where, .library = library.effect};
  out.P = library.P, out.S = library.S, out.k = library.k, out.symbols = library.symbols;
  return out;
}

/// Numbers the formulas that these poses cannot tell from one another, and says at which size each would be
/// told from the first.
void sort_into_classes(const std::vector<std::optional<FittedLaw>>& fitted, const ChannelSums& sums,
                       std::vector<FoundFormula>& formulas) {
  int classes = 0;
  for (std::size_t i = 0; i < formulas.size(); ++i) {
    formulas[i].same_as = 0;
    for (std::size_t j = 0; j < i && fitted[i] && formulas[i].same_as == 0; ++j)
      if (fitted[j] && beyond(*fitted[j], *fitted[i], sums) < criticism::tests::kToldApart)
        formulas[i].same_as = formulas[j].same_as;
    if (formulas[i].same_as == 0) formulas[i].same_as = ++classes;
    if (i > 0 && fitted[0] && fitted[i]) {
      const double left = beyond(*fitted[0], *fitted[i], sums);
      formulas[i].needed_nT = left > kAlike * fitted[0]->S
                                  ? formulas[0].size_nT * std::sqrt(criticism::tests::kToldApart / left)
                                  : std::numeric_limits<double>::infinity();
    }
  }
}

}  // namespace

Result<ChosenLaw> chosen_law(const Workbench& bench, const ChannelSums& sums, const LawRound& round,
                             double questions, const std::string& name) {
  ChosenLaw out;
  out.law.log10_p = criticism::tests::best_of(round.log10_p_best, questions);
  out.law.stands_out = stands_out(out.law.log10_p, bench.looks);
  out.law.where = shares(round.ranked, round.head.score, [](const RankedLaw& law) { return law.where; });
  out.law.covariates = shares(round.ranked, round.head.score, [&](const RankedLaw& law) {
    std::string all;
    for (const std::string& covariate : bench.grammar.families[law.family].covariates)
      all += (all.empty() ? "" : ", ") + shown_covariate(covariate, law.place);
    return all;
  });
  double sum = 0;
  std::vector<std::optional<FittedLaw>> fitted;
  for (const RankedLaw& law : round.ranked) {
    if (sum > kShownSet) break;
    sum += law.P;
    if (out.law.formulas.size() >= kMostShown) {
      ++out.law.more;
      continue;
    }
    if (law.kind == RankedLaw::Kind::library) {
      out.law.formulas.push_back(described(law));
      fitted.emplace_back();
      continue;
    }
    const Family& family = bench.grammar.families[law.family];
    auto one = fitted_law(family.columns(law.inner), law.place, bench.inputs, sums);
    if (!one) return tl::unexpected(one.error());
    out.law.formulas.push_back(described(law, *one, family, name, sums));
    fitted.emplace_back(*std::move(one));
  }
  sort_into_classes(fitted, sums, out.law.formulas);
  const Family& family = bench.grammar.families[round.head.family];
  auto head = fitted_law(family.columns(round.head.inner), round.head.place, bench.inputs, sums);
  if (!head) return tl::unexpected(head.error());
  out.head = *std::move(head);
  out.law.d = out.head.d(), out.score = round.head.score;
  out.covariates = family.covariates;
  for (std::size_t i = 0; i < fitted.size(); ++i) {
    if (!fitted[i] || !(fitted[i]->place == out.head.place)) continue;
    if (bench.grammar.families[round.ranked[i].family].covariates == out.covariates)
      out.alike.push_back(*fitted[i]);
    out.set.push_back(*std::move(fitted[i]));
  }
  return out;
}

}  // namespace mgtd::calib::discovery
