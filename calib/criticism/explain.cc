// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/explain.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>

#include "calib/criticism/conclusion.h"
#include "calib/criticism/growth.h"
#include "calib/criticism/next_measurement.h"
#include "calib/criticism/numbers.h"
#include "calib/criticism/sentence.h"
#include "calib/fit/joint_report.h"
#include "calib/fit/pose_residuals.h"

namespace mgtd::calib {
namespace {

constexpr double kHalf = 0.5;     ///< of the winner's d: a sketch of a memory fits so well at least
constexpr double kOnePose = 0.5;  ///< of the evidence
constexpr double kNotTold = std::numeric_limits<double>::quiet_NaN();

std::vector<EffectCoefficient> coefficients_of(const ScoredFamily& family) {
  const Signature& s = family.signatures[family.winner().variant];
  const OneStep step = one_step(s, family.where());
  const EffectPtr& effect = family.suspect->variants[family.winner().variant];
  std::vector<EffectCoefficient> out;
  for (Eigen::Index j = 0; j < step.value.size(); ++j) {
    Eigen::Index of = 0;
    family.where().combine.col(j).maxCoeff(&of);
    out.push_back({.name = family.where().names[static_cast<std::size_t>(j)],
                   .value = step.value[j],
                   .sd = std::sqrt(step.covariance(j, j)),
                   .unit = effect->coefficients()[static_cast<std::size_t>(of)].unit});
  }
  return out;
}

Candidate candidate_of(const ScoredFamily& family, const Criticism& c, double worse) {
  const Score& score = family.winner();
  Candidate out{.effect = family.suspect->name,
                .where = family.where().where,
                .spec = spec_of(*family.suspect, family.where(), score.variant),
                .k = score.k,
                .log10_p = family.calibrated,
                .d = score.d(),
                .fall = score.S * c.noise.reference.scale2 * worse * worse,
                .coefficients = coefficients_of(family)};
  const double excess = c.noise.reference.chi2 - c.dof;
  out.share = !c.noise.reference.from_dwells() ? kNotTold
              : excess > 0                     ? std::clamp((score.S - score.k) / excess, 0.0, 1.0)
                                               : 0;
  if (family.suspect->bound > 0) {
    out.plausible = std::all_of(out.coefficients.begin(), out.coefficients.end(), [&](const auto& x) {
      return std::abs(x.value) < family.suspect->bound + 3 * x.sd;
    });
  }
  return out;
}

/// Poses that carry half of the evidence, the heaviest first.
void weigh_poses(const JointFit& fit, const std::vector<double>& by_pose, Candidate& out) {
  std::vector<std::size_t> order(by_pose.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](auto a, auto b) { return by_pose[a] > by_pose[b]; });
  const double total = std::accumulate(by_pose.begin(), by_pose.end(), 0.0);
  out.largest_pose = by_pose.empty() ? 0 : by_pose[order.front()] / total;
  double sum = 0;
  for (const std::size_t k : order) {
    if (sum >= 0.5 * total) break;
    sum += by_pose[k];
    out.poses.push_back(fit.problem.poses[k].pose->number);
  }
}

std::vector<Detectable> detectable(const Criticism& c) {
  std::vector<Detectable> out;
  for (const ScoredFamily& f : c.families) out.push_back(detectable_of(*f.suspect, f.signatures.front()));
  return out;
}

double residual_of(const JointFit& fit) { return pose_residuals(fit.problem, fit.state).residual_nT(); }

/// Fills what describes the model that was asked about.
void describe(const JointFit& fit, const Criticism& c, ExplainReport& out) {
  out.noise = c.noise;
  out.noise_nT = fit.noise_nT();
  out.residual_nT = residual_of(fit);
  out.chi2 = chi2_told(fit, c, fit.table_sd_rad), out.dof = c.dof;
  out.omnibus_log10_p = c.omnibus_log10_p;
  out.families = c.rates.best;
  out.maps = c.maps;
  out.outliers = fit.outliers;
  out.untestable.insert(out.untestable.end(), c.untestable.begin(), c.untestable.end());
  for (std::size_t i = 0; i < c.families.size(); ++i) {
    Candidate candidate = candidate_of(c.families[i], c, fit.worse);
    if (i == 0) weigh_poses(fit, c.evidence_by_pose(0), candidate);
    out.candidates.push_back(std::move(candidate));
  }
  out.detectable = detectable(c);
}

struct Search {
  const PoseTable& table;
  JointOptions joint;
  Suspects suspects;
  std::uint64_t seed;
  std::vector<EffectPtr> given{};  ///< the model that was asked about
  std::set<std::string> failed{};  ///< effects that no fit settled with
  /// Effects that would have needed a size beyond what occurs, and that size as last seen.
  std::map<std::string, std::string> absurd{};
  std::string one_pose{};  ///< said of what rests on one pose
  bool slow{false};        ///< the residual follows time or temperature: no memory of a turn does
};

/// Without the path of the table between its poses the equation of a memory is a sketch of it: a sketch that
/// stands out by itself stays possible.
void keep_memory_possible(const Search& search, const Criticism& c, Round& round) {
  constexpr std::string_view kMemory = "axis.hysteresis";
  if (!search.table.path.empty() || round.added.effect == kMemory || search.slow) return;
  for (std::size_t f = 0; f < c.families.size() && c.rejects_named(f); ++f) {
    if (c.families[f].suspect->name != kMemory || c.families[f].winner().d() < kHalf * round.added.d)
      continue;
    if (std::find(round.possible.begin(), round.possible.end(), kMemory) == round.possible.end())
      round.possible.emplace_back(kMemory);
  }
}

/// How many of the effects that were given are still there; they stand first.
std::size_t kept(const std::vector<EffectPtr>& given, const std::vector<EffectPtr>& model) {
  std::size_t out = 0;
  for (const EffectPtr& effect : model)
    out += std::find(given.begin(), given.end(), effect) != given.end() ? 1U : 0U;
  return out;
}

/// A start for a wider model: coefficients that it shares with the narrower one as they were, the others
/// zero.
JointState widened(const std::vector<EffectPtr>& narrow, const JointState& state,
                   const std::vector<EffectPtr>& wide) {
  const auto count = [](const EffectPtr& e) { return static_cast<Eigen::Index>(e->coefficients().size()); };
  Eigen::Index size = 0, at = 0;
  for (const EffectPtr& effect : wide) size += count(effect);
  JointState out = state;
  out.coefficients = Eigen::VectorXd::Zero(size);
  for (const EffectPtr& effect : wide) {
    Eigen::Index from = 0;
    for (const EffectPtr& known : narrow) {
      if (known == effect)
        out.coefficients.segment(at, count(effect)) = state.coefficients.segment(from, count(effect));
      from += count(known);
    }
    at += count(effect);
  }
  return out;
}

/// A winner that became several effects is called after them.
void say_where(const Growth& growth, Candidate& added) {
  if (growth.added.size() == 1 && added.where.find("each") == std::string::npos) return;
  std::vector<std::string> specs, places;
  for (const EffectPtr& effect : growth.added) {
    specs.push_back(effect->spec());
    const auto spec = EffectSpec::parse(specs.back());
    if (spec && spec->where) places.push_back(spec->where->text());
  }
  added.spec = fmt::format("{}", fmt::join(specs, " + "));
  if (!places.empty()) added.where = fmt::format("{}", fmt::join(places, ", "));
}

/// Adds family `f` and fits again. False when the fit with it fails.
bool add(Search& search, std::size_t f, JointFit& fit, Criticism& criticism, ExplainReport& report) {
  const ScoredFamily& best = criticism.families[f];
  Round round{.added = candidate_of(best, criticism, fit.worse)};
  weigh_poses(fit, criticism.evidence_by_pose(f), round.added);
  round.added.rivals = rivals_of(criticism.families, f, search.seed);
  for (const Rival& rival : round.added.rivals)
    if (rival.possible) round.possible.push_back(rival.effect);
  keep_memory_possible(search, criticism, round);
  auto growth = grown(search.joint.effects, best, criticism.residual);
  if (!growth) {
    search.failed.insert(round.added.effect);
    return false;
  }
  say_where(*growth, round.added);
  round.effects = growth->added;
  JointOptions wider = search.joint;
  wider.effects = std::move(growth->model);
  wider.worse = fit.worse;
  const JointState near = widened(search.joint.effects, fit.state, wider.effects);
  auto refit = fit_joint_at_size(search.table, wider, &near);
  if (!refit) {
    report.notes.push_back(
        fmt::format("the fit with {} failed: {}", round.added.spec, refit.error().message));
    search.failed.insert(round.added.effect);
    return false;
  }
  refine_numbers(search.table, kept(search.given, wider.effects), wider, *refit);
  if (report.rounds.empty()) {
    report.next = next_measurements(search.table, fit, search.joint, round.added).steps;
    report.candidates[f].rivals = round.added.rivals;
  }
  const double table_sd_rad = fit.table_sd_rad;
  round.chi2_before = chi2_told(fit, criticism, table_sd_rad), round.rms_before_nT = residual_of(fit);
  search.joint = std::move(wider);
  round.model = search.joint.effects;
  fit = std::move(*refit);
  const Rates rates = std::move(criticism.rates);
  criticism = criticise(fit, search.suspects, search.seed, &rates);
  round.fit = std::make_shared<const JointFit>(fit);
  round.chi2_after = chi2_told(fit, criticism, table_sd_rad), round.rms_after_nT = residual_of(fit);
  report.rounds.push_back(std::move(round));
  return true;
}

/// The note on a family whose evidence is that of one pose; empty where it is spread.
std::string one_pose_text(const JointFit& fit, const Criticism& c, std::size_t f) {
  Candidate weighed;
  weigh_poses(fit, c.evidence_by_pose(f), weighed);
  if (weighed.largest_pose <= kOnePose) return {};
  return fmt::format("one pose ({}) carries the evidence for {}: measure it again", weighed.poses.front(),
                     c.families[f].suspect->name);
}

/// Adds the best family that can be fitted; those that cannot are noted, as is the first that rests on one
/// pose.
bool add_winner(Search& search, JointFit& fit, Criticism& criticism, ExplainReport& report) {
  for (std::size_t f = 0; f < criticism.families.size() && criticism.rejects_named(f); ++f) {
    if (search.failed.contains(criticism.families[f].suspect->name)) continue;
    if (std::string one = one_pose_text(fit, criticism, f); !one.empty()) {
      if (search.one_pose.empty()) search.one_pose = std::move(one);
      continue;
    }
    if (const Candidate c = candidate_of(criticism.families[f], criticism, fit.worse); !c.plausible) {
      search.absurd[c.effect] = size_text(c);
      continue;  // for now: beside what is still missing a size may be absurd that later is none
    }
    if (add(search, f, fit, criticism, report)) return true;
  }
  return false;
}

/// Of what still stands out at the end.
void say_absurd(const Search& search, const Criticism& c, ExplainReport& report) {
  for (std::size_t f = 0; f < c.families.size() && c.rejects_named(f); ++f) {
    const auto found = search.absurd.find(c.families[f].suspect->name);
    if (found == search.absurd.end()) continue;
    report.notes.push_back(
        fmt::format("the size that {} would need, {}, is beyond what occurs: it is not named", found->first,
                    found->second));
  }
}

void name(ExplainReport& report) {
  for (const Round& round : report.rounds) {
    if (std::find(report.named.begin(), report.named.end(), round.added.effect) == report.named.end())
      report.named.push_back(round.added.effect);
  }
  if (report.finding == Finding::ambiguous) {
    const auto& possible = report.rounds.front().possible;
    report.named.insert(report.named.end(), possible.begin(), possible.end());
  }
}

/// No residual shows it.
Untestable swapped_sensors() {
  return {
      "data.swapped-sensors",
      "two sensors whose cables are exchanged read the same uniform field through matrices that are free: "
      "pass a small magnet by each sensor in turn and see which one answers, or compare with an earlier "
      "calibration (mgt diff)"};
}

/// Adds what stands out, round by round. False: nothing does but what rests on one pose.
bool add_rounds(int most, Search& search, JointFit& fit, Criticism& criticism, ExplainReport& report) {
  for (int round = 0; round < most && criticism.rejects_named(); ++round) {
    search.one_pose.clear();
    if (!add_winner(search, fit, criticism, report)) break;
  }
  if (search.one_pose.empty() || !criticism.rejects_named()) return true;
  report.notes.push_back(search.one_pose);
  return !report.rounds.empty();
}

/// A memory follows the way of the table, which may not be in the data.
void say_way_unknown(const Search& search, ExplainReport& report) {
  const auto memory = [](const std::string& name) { return name == "axis.hysteresis"; };
  const bool remembers = std::any_of(report.rounds.begin(), report.rounds.end(), [&](const Round& r) {
    return memory(r.added.effect) ||
           (!search.slow && std::any_of(r.possible.begin(), r.possible.end(), memory));
  });
  if (!remembers || !search.table.path.empty()) return;
  report.notes.emplace_back(
      "the way of the table between its poses is not in these data: a memory of the cores is followed from "
      "dwell to dwell only, its size and its width are rough, and another name may stand in its place. To "
      "settle it: measure with the daemon, whose run file keeps the angles of the table on the way, or go "
      "to a dozen of the poses from both sides");
}

}  // namespace

std::string_view to_string(Finding finding) {
  switch (finding) {
    case Finding::pass:
      return "PASS";
    case Finding::explained:
      return "EXPLAINED";
    case Finding::ambiguous:
      return "AMBIGUOUS";
    case Finding::partial:
      return "PARTIAL";
    case Finding::unknown:
      return "UNKNOWN";
    case Finding::bad_data:
      return "BAD-DATA";
  }
  return "";
}

Result<ExplainReport> explain(const PoseTable& table, const ExplainOptions& options) {
  auto joint = tuned_options(table, options.fit);
  if (!joint) return tl::unexpected(joint.error());
  Search search{.table = table, .joint = *std::move(joint), .suspects = {}, .seed = options.fit.seed};
  search.suspects = options.suspects ? Suspects{*options.suspects, {}} : library_suspects(table);
  search.suspects.testable.insert(search.suspects.testable.end(), options.also.begin(), options.also.end());
  auto fit = fit_joint_at_size(table, search.joint);
  if (!fit) return tl::unexpected(fit.error());
  ExplainReport out;
  out.untestable = search.suspects.untestable;
  out.untestable.push_back(swapped_sensors());
  out.fit = std::make_shared<const JointFit>(*fit);
  search.given = search.joint.effects;
  Criticism criticism = criticise(*fit, search.suspects, search.seed);
  look_at_maps(*fit, criticism);
  describe(*fit, criticism, out);
  search.slow =
      !out.maps.empty() && (out.maps.front().map == "time" || out.maps.front().map == "temperature");
  const Asked first{.dof = criticism.dof, .reference = criticism.noise.reference};
  if (bad_data(*fit, criticism, search.joint.table_sd_rad, out.notes) ||
      !add_rounds(options.rounds, search, *fit, criticism, out)) {
    out.finding = Finding::bad_data;
    return out;
  }
  say_absurd(search, criticism, out);
  say_way_unknown(search, out);
  if (!out.rounds.empty()) {
    look_at_maps(*fit, criticism);
    out.detectable = detectable(criticism);
  }
  share_what_fell(out);
  out.maps_left = criticism.maps;
  out.model = search.joint.effects;
  out.left = !criticism.rejects()        ? Finding::pass
             : criticism.rejects_named() ? Finding::partial
                                         : Finding::unknown;
  out.finding = conclude(out, first, criticism, out.notes);
  name(out);
  return out;
}

}  // namespace mgtd::calib
