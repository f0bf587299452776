// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/effect_search.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "calib/criticism/search/forward_step.h"
#include "calib/criticism/search/nonlinear_parameters.h"
#include "calib/criticism/search/second_look.h"
#include "calib/criticism/search/site_pair.h"
#include "calib/criticism/search/temperature_dependence.h"
#include "calib/criticism/tests/candidate.h"
#include "calib/criticism/tests/judgement.h"
#include "calib/design/next_measurement.h"
#include "calib/effects/added_effects.h"
#include "calib/fit/joint/pose_residuals.h"
#include "calib/linear/qr.h"

namespace mgtd::calib::criticism::search {
namespace {

constexpr double kHalf = 0.5;     ///< of the winner's d: a sketch of a memory fits so well at least
constexpr double kOnePose = 0.5;  ///< of the evidence

/// Without the path of the table between its poses the equation of a memory is a sketch of it: a sketch that
/// stands out by itself stays possible.
void keep_memory_possible(const EffectSearch& search, const tests::Criticism& c, Round& round) {
  constexpr std::string_view kMemory = "axis.hysteresis";
  if (!search.table.path.empty() || round.added.effect == kMemory || search.slow) return;
  for (std::size_t f = 0; f < c.families.size() && c.rejects_named(f); ++f) {
    if (c.families[f].candidate_effect->name != kMemory || c.families[f].winner().d() < kHalf * round.added.d)
      continue;
    if (std::find(round.possible.begin(), round.possible.end(), kMemory) == round.possible.end())
      round.possible.emplace_back(kMemory);
  }
}

/// A start for a wider model: coefficients that it shares with the narrower one as they were, the others
/// zero.
fit::joint::JointState widened(const std::vector<effects::EffectPtr>& narrow,
                               const fit::joint::JointState& state,
                               const std::vector<effects::EffectPtr>& wide) {
  const auto count = [](const effects::EffectPtr& e) {
    return static_cast<Eigen::Index>(e->coefficients().size());
  };
  Eigen::Index size = 0, at = 0;
  for (const effects::EffectPtr& effect : wide) size += count(effect);
  fit::joint::JointState out = state;
  out.coefficients = Eigen::VectorXd::Zero(size);
  for (const effects::EffectPtr& effect : wide) {
    Eigen::Index from = 0;
    for (const effects::EffectPtr& known : narrow) {
      if (known == effect)
        out.coefficients.segment(at, count(effect)) = state.coefficients.segment(from, count(effect));
      from += count(known);
    }
    at += count(effect);
  }
  return out;
}

/// A winner that became several effects is called after them.
void name_places(const ForwardStep& step, tests::Candidate& added) {
  if (step.added.size() == 1 && added.where.find("each") == std::string::npos) return;
  std::vector<std::string> specs, places;
  for (const effects::EffectPtr& effect : step.added) {
    specs.push_back(effect->spec());
    const auto spec = effects::EffectSpec::parse(specs.back());
    if (spec && spec->where) places.push_back(spec->where->text());
  }
  added.spec = fmt::format("{}", fmt::join(specs, " + "));
  if (!places.empty()) added.where = fmt::format("{}", fmt::join(places, ", "));
}

/// Whether a winner of all axes came down to axes that are closed to names, or is seen most on one of them.
bool on_closed_axes(const tests::Candidate& winner, const ForwardStep& step,
                    const std::set<std::string>& closed) {
  if (closed.empty() || winner.coefficients.empty()) return false;
  const bool each_axis = winner.where.find("each") != std::string::npos;
  if (each_axis && closed.contains(tests::place_of(*tests::seen_most(winner)))) return true;
  return std::all_of(step.added.begin(), step.added.end(), [&](const effects::EffectPtr& effect) {
    const auto spec = effects::EffectSpec::parse(effect->spec());
    return spec && spec->where && closed.contains(spec->where->text());
  });
}

std::size_t family_called(const tests::Criticism& criticism, const std::string& name) {
  const auto found =
      std::find_if(criticism.families.begin(), criticism.families.end(),
                   [&](const tests::ScoredFamily& f) { return f.candidate_effect->name == name; });
  return static_cast<std::size_t>(found - criticism.families.begin());
}

bool possible_in(const std::vector<tests::Alternative>& alternatives, const std::string& effect) {
  return std::any_of(alternatives.begin(), alternatives.end(), [&](const tests::Alternative& alternative) {
    return alternative.possible && alternative.effect == effect;
  });
}

/// Takes the alternatives that a second look does not find possible any more for what it says of them; those
/// that it tells apart are alternatives no more.
void exclude(const std::vector<tests::Alternative>& again, Round& round) {
  auto& alternatives = round.added.alternatives;
  std::erase_if(alternatives, [&](tests::Alternative& alternative) {
    if (!alternative.possible || possible_in(again, alternative.effect)) return false;
    std::erase(round.possible, alternative.effect);
    const auto seen = std::find_if(again.begin(), again.end(), [&](const tests::Alternative& other) {
      return other.effect == alternative.effect;
    });
    if (seen == again.end()) return true;
    alternative = *seen;
    return false;
  });
}

/// Whether the model holds all that the step would add.
bool adds_nothing(const ForwardStep& step, const std::vector<effects::EffectPtr>& model) {
  return std::all_of(step.added.begin(), step.added.end(), [&](const effects::EffectPtr& added) {
    return std::any_of(model.begin(), model.end(),
                       [&](const effects::EffectPtr& effect) { return effect->spec() == added->spec(); });
  });
}

/// Adds family `f` and fits again. False when the fit with it fails. A `first_choice` gives way where a
/// second look prefers one of its alternatives.
bool add(EffectSearch& search, std::size_t f, ExplainReport& report, bool first_choice = true) {
  const tests::ScoredFamily& best = search.criticism.families[f];
  Round round{.added = tests::candidate_of(best, search.criticism, search.fit.noise_inflation)};
  tests::weigh_poses(search.fit, search.criticism.evidence_by_pose(f), round.added);
  round.added.alternatives = tests::alternatives_of(search.criticism.families, f, search.seed, search.looks);
  for (const tests::Alternative& alternative : round.added.alternatives)
    if (alternative.possible) round.possible.push_back(alternative.effect);
  auto step = forward_step(search.joint.effects, best);
  if (!step || adds_nothing(*step, search.joint.effects) ||
      on_closed_axes(round.added, *step, search.unknown)) {
    search.failed.insert(round.added.effect);
    return false;
  }
  name_places(*step, round.added);
  round.effects = step->added;
  fit::joint::JointOptions wider = search.joint;
  wider.effects = std::move(step->model);
  wider.noise_inflation = search.fit.noise_inflation;
  const fit::joint::JointState warm_start = widened(search.joint.effects, search.fit.state, wider.effects);
  auto refit = fit::joint::fit_joint_at_size(search.table, wider, &warm_start);
  if (!refit) {
    report.notes.emplace_back(FitWithEffectFailed{round.added.spec, refit.error().message});
    search.failed.insert(round.added.effect);
    return false;
  }
  const std::size_t given = wider.effects.size() - effects::added_effects(wider.effects, search.given).size();
  refine_nonlinear_parameters(search.table, given, wider, *refit);
  const auto again = second_look(search.table, search.joint, search.criticism, f, round.added.alternatives,
                                 search.fit.noise_inflation, *refit, search.seed, search.looks);
  if (again && again->better && first_choice)
    return add(search, family_called(search.criticism, *again->better), report, false);
  if (again && !again->better) exclude(again->alternatives, round);
  keep_memory_possible(search, search.criticism, round);
  if (report.rounds.empty()) report.candidates[f].alternatives = round.added.alternatives;
  if (report.rounds.empty() || (report.open_round() == nullptr && !round.possible.empty()))
    report.next = design::next_measurements(search.table, search.fit, search.joint, round.added).steps;
  add_round(std::move(round), std::move(wider), *refit, search, report);
  return true;
}

/// Columns of the winning question of a family, its own combination of the axes.
Eigen::MatrixXd winning_columns(const tests::ScoredFamily& family) {
  return family.signatures[family.winner().variant].times(family.where().combine);
}

/// What the winning question of a family has of its score where the readings follow other columns, too.
double score_beside(const Eigen::MatrixXd& columns, const tests::ScoredFamily& family,
                    const tests::Residual& residual) {
  const Eigen::MatrixXd Z = winning_columns(family);
  const Eigen::VectorXd& r = residual.value();
  const Eigen::VectorXd beside = r - columns * linear::least_squares(columns, r);
  const Eigen::MatrixXd own = Z - columns * linear::least_squares(columns, Z);
  return (own * linear::least_squares(own, beside)).squaredNorm();
}

/// One column for each row of a pose: beside them it is as if it were left out.
Eigen::MatrixXd columns_of_pose(const tests::Criticism& c, Eigen::Index pose) {
  const Eigen::Index rows = c.residual.whitener().pose_rows();
  const tests::Signature own(c.residual, {.columns = rows, .of = [=](std::span<const Eigen::Index> poses) {
                                            const auto n = static_cast<Eigen::Index>(poses.size());
                                            Eigen::MatrixXd out = Eigen::MatrixXd::Zero(n * rows, rows);
                                            for (Eigen::Index i = 0; i < n; ++i)
                                              if (poses[static_cast<std::size_t>(i)] == pose)
                                                out.middleRows(i * rows, rows).setIdentity();
                                            return out;
                                          }});
  return own.times(Eigen::MatrixXd::Identity(rows, rows));
}

/// Whether the evidence of a family is that of one pose, or would not do without it; nothing where it is
/// spread. Beside a memory of the noise that of a step lies in the first pose after it; half of it stays when
/// that is left out.
std::optional<EvidenceOfOnePose> evidence_of_one_pose(const fit::joint::JointFit& fit,
                                                      const tests::Criticism& c, std::size_t f) {
  constexpr double kHeavy = 0.25, kStays = 0.25;
  tests::Candidate weighed;
  const std::vector<double> by_pose = c.evidence_by_pose(f);
  tests::weigh_poses(fit, by_pose, weighed);
  if (weighed.largest_pose <= kHeavy) return std::nullopt;
  const auto pose = std::max_element(by_pose.begin(), by_pose.end()) - by_pose.begin();
  const double without = score_beside(columns_of_pose(c, pose), c.families[f], c.residual);
  const bool little = weighed.largest_pose > kOnePose && without < kStays * c.families[f].winner().S;
  if (!little && c.would_name(f, without)) return std::nullopt;
  return EvidenceOfOnePose{weighed.poses.front(), c.families[f].candidate_effect->name};
}

/// A size beyond what occurs is a sign that something else is there; but a law that leaves only noise is
/// right whatever its size.
bool accounts_for_all(const tests::Candidate& candidate, const tests::Criticism& criticism) {
  constexpr double kNearlyAll = 0.9;
  constexpr double kMost = 0.6;  // of all chi-square, where the noise in it is not known
  if (!std::isnan(candidate.share)) return candidate.share >= kNearlyAll;
  return candidate.d * candidate.d >= kMost * criticism.residual.chi2();
}

/// Most of the evidence of `other` is that of `leader`, which has much more: a look-alike of something that
/// was not named because of its size, and no name of its own.
bool lives_on(const tests::ScoredFamily& leader, const tests::ScoredFamily& other,
              const tests::Residual& residual) {
  constexpr double kDecisive = 25;   // in chi-square
  constexpr double kMostOfIt = 0.5;  // of its score, that falls away beside the leader
  if (leader.winner().S < other.winner().S + kDecisive) return false;
  return score_beside(winning_columns(leader), other, residual) < (1 - kMostOfIt) * other.winner().S;
}

/// Rounds that found a law: those that went on with a dependence on temperature do not count.
int laws_found(const std::vector<Round>& rounds) {
  int out = 0;
  for (auto round = rounds.begin(); round != rounds.end(); ++round)
    out += added_term_of_dependence({rounds.begin(), round}, round->added.effect) ? 0 : 1;
  return out;
}

/// Adds the best family that can be fitted; those that cannot are noted, as is the first that rests on one
/// pose. What only looks like one of an absurd size is left out with it. After `most` laws only a
/// dependence on temperature that was found goes on.
bool add_winner(int most, EffectSearch& search, ExplainReport& report) {
  const bool closed = laws_found(report.rounds) >= most;
  std::vector<std::size_t> absurd;
  for (std::size_t f = 0; f < search.criticism.families.size() && search.criticism.rejects_named(f); ++f) {
    if (search.failed.contains(search.criticism.families[f].candidate_effect->name)) continue;
    if (search.unknown.contains(search.criticism.families[f].where().where)) continue;
    if (auto one = evidence_of_one_pose(search.fit, search.criticism, f)) {
      if (!search.one_pose) search.one_pose = std::move(one);
      continue;
    }
    const tests::Candidate c =
        tests::candidate_of(search.criticism.families[f], search.criticism, search.fit.noise_inflation);
    if (!c.plausible && !accounts_for_all(c, search.criticism)) {
      search.absurd[c.effect] = c;
      absurd.push_back(f);
      continue;  // for now: beside what is still missing a size may be absurd that later is none
    }
    if (std::any_of(absurd.begin(), absurd.end(), [&](std::size_t leader) {
          return lives_on(search.criticism.families[leader], search.criticism.families[f],
                          search.criticism.residual);
        }))
      continue;
    if (closed && !added_term_of_dependence(report.rounds, c.effect)) return false;
    if (!add(search, f, report)) continue;
    if (!c.plausible) report.notes.emplace_back(SizeUnusual{c});
    return true;
  }
  return false;
}

bool of_site(const effects::EffectPtr& effect) { return effect->level() == effects::Level::site; }

/// Whether two rounds may stand for a pair of sources at the site that is neither: they leave something, or
/// both are of the site and are no such pair (a step of the site soon after the start is nearly one that was
/// always there), or something else could stand in the place of one.
bool may_be_a_pair(const EffectSearch& search, const ExplainReport& report) {
  if (search.pairs_tried || report.rounds.size() != 2 || !search.unknown.empty() ||
      search.criticism.noise.wandering.any())
    return false;
  if (search.criticism.rejects()) return true;
  const std::vector<effects::EffectPtr> effects = effects_of(report.rounds);
  const bool open = std::any_of(report.rounds.begin(), report.rounds.end(),
                                [](const Round& round) { return !round.possible.empty(); });
  return std::all_of(effects.begin(), effects.end(), of_site) && (open || !is_site_pair(effects));
}

}  // namespace

void EffectSearch::judge_anew(const fit::joint::JointFit& refit) {
  const tests::Rates rates = std::move(criticism.rates);
  criticism = {};  // of a long run two are hundreds of megabytes
  tests::Judgement judged = tests::judge(refit, candidate_effects, seed, &rates);
  fit = std::move(judged.fit);
  criticism = std::move(judged.criticism);
}

double residual_of(const fit::joint::JointFit& fit) {
  return fit::joint::pose_residuals(fit.problem, fit.state).residual_nT();
}

void add_round(Round round, fit::joint::JointOptions wider, const fit::joint::JointFit& refit,
               EffectSearch& search, ExplainReport& report) {
  const double table_sd_rad = search.fit.table_sd_rad;
  round.chi2_before = tests::chi2_at_stated_noise(search.fit, search.criticism, table_sd_rad),
  round.rms_before_nT = residual_of(search.fit);
  search.joint = std::move(wider);
  round.model = search.joint.effects;
  search.judge_anew(refit);
  round.fit = std::make_shared<const fit::joint::JointFit>(search.fit);
  round.chi2_after = tests::chi2_at_stated_noise(search.fit, search.criticism, table_sd_rad),
  round.rms_after_nT = residual_of(search.fit);
  report.rounds.push_back(std::move(round));
}

bool add_rounds(int most, EffectSearch& search, ExplainReport& report) {
  constexpr int kRoundsEach = 3;
  const auto notes = static_cast<std::ptrdiff_t>(report.notes.size());
  const int laws = laws_found(report.rounds) + most;
  for (int round = 0; round < kRoundsEach * most && search.criticism.rejects_named(); ++round) {
    search.one_pose.reset();
    if (!add_winner(laws, search, report)) break;
    if (!may_be_a_pair(search, report)) continue;
    search.pairs_tried = true;
    if (site_pair_instead(search, report) || report.rounds.empty())
      report.notes.erase(report.notes.begin() + notes, report.notes.end());
  }
  if (!search.one_pose || !search.criticism.rejects_named()) return true;
  report.notes.emplace_back(*search.one_pose);
  return !report.rounds.empty();
}

}  // namespace mgtd::calib::criticism::search
