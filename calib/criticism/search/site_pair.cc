// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/site_pair.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "calib/criticism/search/narrow_model.h"
#include "calib/criticism/tests/dipole_search.h"
#include "calib/criticism/tests/noise.h"
#include "calib/criticism/tests/scan_refinement.h"
#include "calib/effects/added_effects.h"

namespace mgtd::calib::criticism::search {
namespace {

constexpr std::string_view kDipole = "site.dipole";
constexpr double kLeftOut = 3 * 3;
/// By name; two of them at most are kDipole.
constexpr std::array<std::array<std::string_view, 2>, 3> kPairs{{
    {kDipole, kDipole},
    {kDipole, "site.gradient"},
    {"site.gradient", "site.curvature"},
}};

struct SitePair {
  std::vector<effects::EffectPtr> effects{};          ///< two
  Eigen::VectorXd start{};                            ///< of their coefficients
  std::shared_ptr<const fit::joint::JointFit> fit{};  ///< of the model with both
  double cost{0};
};

const tests::CandidateEffect* candidate(const EffectSearch& search, std::string_view name) {
  const auto& all = search.candidate_effects.testable;
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const tests::CandidateEffect& c) { return c.name == name; });
  return found == all.end() ? nullptr : &*found;
}

Eigen::Index coefficients_of(const std::vector<effects::EffectPtr>& effects) {
  Eigen::Index out = 0;
  for (const effects::EffectPtr& effect : effects)
    out += static_cast<Eigen::Index>(effect->coefficients().size());
  return out;
}

/// Where the search for places is linear: a state of the model that was asked about.
struct Point {
  const fit::joint::JointProblem& problem;
  const fit::joint::JointState& state;
  tests::Residual residual;

  Point(const fit::joint::JointProblem& p, const fit::joint::JointState& s)
      : problem(p), state(s), residual(p, s, tests::pose_correlation(p, s)) {}
};

/// Orthonormal columns of an effect, projected as the residual is.
Eigen::MatrixXd columns_of(const Point& point, const effects::EffectPtr& effect) {
  const tests::Signature s(point.residual, tests::effect_source(point.problem, point.state, effect));
  const auto n = static_cast<Eigen::Index>(effect->coefficients().size());
  return s.times(tests::orthonormal_combinations(
      s, tests::Hypothesis{.combine = Eigen::MatrixXd::Identity(n, n), .names = {}}));
}

/// The two effects of a pair, dipoles at the places that fit best; empty where the run cannot test them.
std::optional<SitePair> placed(const std::array<std::string_view, 2>& names, const EffectSearch& search,
                               const Point& point) {
  const auto dipoles = static_cast<int>(std::count(names.begin(), names.end(), kDipole));
  SitePair out;
  Eigen::MatrixXd beside(point.residual.value().size(), 0);
  for (const std::string_view name : names) {
    const tests::CandidateEffect* const family = candidate(search, name);
    if (family == nullptr) return std::nullopt;
    if (name == kDipole) continue;
    out.effects.push_back(family->variants.front());
    if (dipoles > 0) beside = columns_of(point, out.effects.back());
  }
  Eigen::VectorXd of_dipoles(0);
  if (dipoles > 0) {
    const tests::CandidateEffect& family = *candidate(search, kDipole);
    const auto found = tests::find_dipoles(
        point.problem, point.state, point.residual,
        [&](const Eigen::Vector3d& place_S_m) { return family.dipole_at(place_S_m, std::nullopt); }, dipoles,
        beside);
    if (!found) return std::nullopt;
    of_dipoles = Eigen::VectorXd::Zero(coefficients_of(found->effects));
    for (Eigen::Index i = 0; i < dipoles; ++i)
      of_dipoles.segment<3>(6 * i) = found->moments_Am2.segment<3>(3 * i);
    out.effects.insert(out.effects.begin(), found->effects.begin(), found->effects.end());
  }
  out.start = Eigen::VectorXd::Zero(coefficients_of(out.effects));
  out.start.head(of_dipoles.size()) = of_dipoles;
  return out;
}

/// Readings that count for nothing.
int left_out(const fit::joint::JointFit& fit) {
  int out = 0;
  for (const fit::joint::JointPose& pose : fit.problem.poses)
    out += static_cast<int>((pose.weight.array() == 0).count());
  return out;
}

/// Of a model with so many coefficients; by the readings alone. One that is left out is priced as one three
/// standard deviations off, or a model could buy its fit with what it leaves out.
double cost_of(const fit::joint::JointFit& fit, const fit::joint::JointFit& base, Eigen::Index coefficients) {
  const double n = base.dof;
  const double residual = residual_of(fit);
  return n * std::log(residual * residual) + static_cast<double>(coefficients) * std::log(n) +
         kLeftOut * left_out(fit);
}

/// The model that was asked about with `more` effects.
fit::joint::JointOptions given_and(const EffectSearch& search, const std::vector<effects::EffectPtr>& more) {
  fit::joint::JointOptions out = search.joint;
  out.effects = search.given;
  out.effects.insert(out.effects.end(), more.begin(), more.end());
  return out;
}

/// Fits the model with a pair, from where the search for its places ended.
bool fit_with(const EffectSearch& search, const fit::joint::JointFit& base,
              const fit::joint::JointState& from, SitePair& pair) {
  fit::joint::JointOptions options = given_and(search, pair.effects);
  options.noise_inflation = base.noise_inflation;
  fit::joint::JointState start = from;
  start.coefficients.resize(from.coefficients.size() + pair.start.size());
  start.coefficients << from.coefficients, pair.start;
  auto fit = fit::joint::fit_joint_at_size(search.table, options, &start);
  if (!fit) return false;
  pair.cost = cost_of(*fit, base, coefficients_of(options.effects));
  pair.fit = std::make_shared<const fit::joint::JointFit>(*std::move(fit));
  return true;
}

/// The first dipole that a fit has beyond what was given, and a second one: searched with the first in the
/// model, about that fit without its other effects. The place of the one is known well, and so are the
/// sensors' parameters, where the fit has something in the place of the other; both places at once are
/// searched about parameters that two dipoles have bent.
std::optional<SitePair> with_second(const EffectSearch& search, const fit::joint::JointFit& known) {
  const std::vector<effects::EffectPtr> added = effects::added_effects(known.problem.effects, search.given);
  const auto dipole = std::find_if(
      added.begin(), added.end(), [](const effects::EffectPtr& effect) { return effect->name() == kDipole; });
  const tests::CandidateEffect* const family = candidate(search, kDipole);
  if (dipole == added.end() || family == nullptr) return std::nullopt;
  const auto narrow = narrow_model(search.table, given_and(search, {*dipole}), known);
  if (!narrow) return std::nullopt;
  const Point point(narrow->problem, narrow->state);
  const auto found = tests::find_dipoles(
      point.problem, point.state, point.residual,
      [&](const Eigen::Vector3d& place_S_m) { return family->dipole_at(place_S_m, std::nullopt); }, 1,
      Eigen::MatrixXd(point.residual.value().size(), 0));
  if (!found) return std::nullopt;
  SitePair out;
  out.effects = {*dipole, found->effects.front()};
  out.start = Eigen::VectorXd::Zero(coefficients_of(out.effects));
  out.start.head<6>() = narrow->state.coefficients.tail<6>();  // moment and shift
  out.start.segment<3>(6) = found->moments_Am2;
  return out;
}

/// Adds the pairs that can be fitted: with places searched about one point, and two dipoles with the second
/// searched beside one that `known` has. Best first; of two with the same names the better one.
void add_pairs(const EffectSearch& search, const fit::joint::JointFit& base,
               const fit::joint::JointState& about, const fit::joint::JointFit& known,
               std::vector<SitePair>& out) {
  const auto add = [&](std::optional<SitePair> pair) {
    if (pair && fit_with(search, base, about, *pair)) out.push_back(*std::move(pair));
  };
  const Point point(base.problem, about);
  for (const auto& names : kPairs) add(placed(names, search, point));
  add(with_second(search, known));
  std::stable_sort(out.begin(), out.end(),
                   [](const SitePair& a, const SitePair& b) { return a.cost < b.cost; });
  std::set<std::multiset<std::string>> seen;
  std::erase_if(out, [&](const SitePair& pair) {
    std::multiset<std::string> names;
    for (const effects::EffectPtr& effect : pair.effects) names.emplace(effect->name());
    return !seen.insert(std::move(names)).second;
  });
}

/// Best first. Strong sources bend the fit without them, and places that are searched about it are wrong by
/// more than the noise: so they are searched again about the best fit that is known, as long as that helps.
std::vector<SitePair> pairs_of(const EffectSearch& search, const fit::joint::JointFit& base,
                               double of_rounds) {
  constexpr int kMostSearches = 4;
  std::vector<SitePair> out;
  add_pairs(search, base, base.state, base, out);
  double least = std::numeric_limits<double>::infinity();
  for (int i = 1; i < kMostSearches; ++i) {
    const bool rounds = out.empty() || of_rounds < out.front().cost;
    const double cost = rounds ? of_rounds : out.front().cost;
    if (cost > least - kClearly) break;
    least = cost;
    const fit::joint::JointFit& best = rounds ? search.fit : *out.front().fit;
    const auto about = narrow_model(search.table, given_and(search, {}), best);
    if (!about) break;
    add_pairs(search, base, about->state, best, out);
  }
  return out;
}

/// Effects of pairs that cost no more than kClearly above `cost`.
std::set<std::string> in_reach(const std::vector<SitePair>& pairs, double cost) {
  std::set<std::string> out;
  for (const SitePair& pair : pairs) {
    if (pair.cost > cost + kClearly) continue;
    for (const effects::EffectPtr& effect : pair.effects) out.emplace(effect->name());
  }
  return out;
}

bool of_any_pair(const std::string& name) {
  return std::any_of(kPairs.begin(), kPairs.end(), [&](const auto& pair) {
    return std::find(pair.begin(), pair.end(), name) != pair.end();
  });
}

/// What other pairs of about the same odds have besides becomes possible.
void name_pairs_in_reach(const std::vector<SitePair>& pairs, ExplainReport& report) {
  std::set<std::string> others = in_reach(pairs, pairs.front().cost);
  for (const effects::EffectPtr& effect : pairs.front().effects) others.erase(std::string(effect->name()));
  report.rounds.front().possible.assign(others.begin(), others.end());
}

/// Beside rounds that are such a pair themselves, what stands in no other pair of about the same odds is
/// possible no more: it was judged while the other of the two was missing.
void exclude_pairs_out_of_reach(const std::vector<SitePair>& pairs, double of_rounds, ExplainReport& report) {
  const std::set<std::string> left = in_reach(pairs, of_rounds);
  const auto excluded = [&](const std::string& name) { return of_any_pair(name) && !left.contains(name); };
  for (Round& round : report.rounds) {
    std::erase_if(round.possible, excluded);
    for (tests::Alternative& alternative : round.added.alternatives)
      alternative.possible = alternative.possible && !excluded(alternative.effect);
  }
}

/// Adds one effect of a pair as a round. False where this run cannot test it or no fit settles with it.
bool add_of_pair(const effects::EffectPtr& effect, const fit::joint::JointState& start, EffectSearch& search,
                 ExplainReport& report) {
  const auto family =
      std::find_if(search.criticism.families.begin(), search.criticism.families.end(),
                   [&](const tests::ScoredFamily& f) { return f.candidate_effect->name == effect->name(); });
  if (family == search.criticism.families.end()) return false;
  if (effect->name() == kDipole)
    tests::put_at_place(search.fit.problem, search.fit.state, search.criticism.residual,
                        search.criticism.noise.reference, effect, *family);
  Round round{.added = tests::candidate_of(*family, search.criticism, search.fit.noise_inflation)};
  const auto f = static_cast<std::size_t>(family - search.criticism.families.begin());
  tests::weigh_poses(search.fit, search.criticism.evidence_by_pose(f), round.added);
  round.effects = {effect};
  fit::joint::JointOptions wider = search.joint;
  wider.effects.push_back(effect);
  wider.noise_inflation = search.fit.noise_inflation;
  const auto refit = fit::joint::fit_joint_at_size(search.table, wider, &start);
  if (!refit) return false;
  add_round(std::move(round), std::move(wider), *refit, search, report);
  return true;
}

/// Of the model without its last effect.
fit::joint::JointState without_last(const fit::joint::JointState& state, const effects::EffectPtr& last) {
  fit::joint::JointState out = state;
  out.coefficients.conservativeResize(state.coefficients.size() - coefficients_of({last}));
  return out;
}

/// Goes back to the model that was asked about.
void begin_anew(EffectSearch& search, ExplainReport& report) {
  search.joint.effects = search.given;
  search.failed.clear(), search.absurd.clear();
  report.rounds.clear(), report.next.clear();
  search.judge_anew(*report.fit);
}

}  // namespace

std::vector<effects::EffectPtr> effects_of(const std::vector<Round>& rounds) {
  std::vector<effects::EffectPtr> out;
  for (const Round& round : rounds) out.insert(out.end(), round.effects.begin(), round.effects.end());
  return out;
}

bool is_site_pair(const std::vector<effects::EffectPtr>& effects) {
  if (effects.size() != 2) return false;
  const std::array names{effects.front()->name(), effects.back()->name()};
  return std::any_of(kPairs.begin(), kPairs.end(), [&](const auto& pair) {
    return std::is_permutation(pair.begin(), pair.end(), names.begin());
  });
}

bool site_pair_instead(EffectSearch& search, ExplainReport& report) {
  const fit::joint::JointFit& base = *report.fit;
  const double of_rounds = cost_of(search.fit, base, coefficients_of(search.joint.effects));
  const std::vector<SitePair> pairs = pairs_of(search, base, of_rounds);
  if (pairs.empty() || pairs.front().cost > of_rounds - kClearly) {
    if (is_site_pair(effects_of(report.rounds)) && !search.criticism.rejects())
      exclude_pairs_out_of_reach(pairs, of_rounds, report);
    return false;
  }
  const SitePair& best = pairs.front();
  const fit::joint::JointState &both = best.fit->state, first = without_last(both, best.effects.back());
  begin_anew(search, report);
  if (!add_of_pair(best.effects.front(), first, search, report) ||
      !add_of_pair(best.effects.back(), both, search, report)) {
    begin_anew(search, report);
    return false;
  }
  name_pairs_in_reach(pairs, report);
  return true;
}

}  // namespace mgtd::calib::criticism::search
