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
#include "calib/criticism/judgement.h"
#include "calib/criticism/next_measurement.h"
#include "calib/criticism/numbers.h"
#include "calib/criticism/second_look.h"
#include "calib/criticism/sentence.h"
#include "calib/criticism/stand_ins.h"
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
  std::string one_pose{};           ///< said of what rests on one pose
  std::set<std::string> unknown{};  ///< axes with a law of no library: no effect is put there any more
  bool slow{false};                 ///< the residual follows time or temperature: no memory of a turn does
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

std::size_t family_called(const Criticism& criticism, const std::string& name) {
  const auto found = std::find_if(criticism.families.begin(), criticism.families.end(),
                                  [&](const ScoredFamily& f) { return f.suspect->name == name; });
  return static_cast<std::size_t>(found - criticism.families.begin());
}

bool possible_in(const std::vector<Rival>& rivals, const std::string& effect) {
  return std::any_of(rivals.begin(), rivals.end(),
                     [&](const Rival& rival) { return rival.possible && rival.effect == effect; });
}

/// Rivals that a second look does not find possible any more.
void strike(const std::vector<Rival>& again, Round& round) {
  for (Rival& rival : round.added.rivals) {
    if (!rival.possible || possible_in(again, rival.effect)) continue;
    rival.possible = false;
    std::erase(round.possible, rival.effect);
  }
}

/// Adds family `f` and fits again. False when the fit with it fails. A `first_choice` gives way where a
/// second look prefers one of its rivals.
bool add(Search& search, std::size_t f, JointFit& fit, Criticism& criticism, ExplainReport& report,
         bool first_choice = true) {
  const ScoredFamily& best = criticism.families[f];
  Round round{.added = candidate_of(best, criticism, fit.worse)};
  weigh_poses(fit, criticism.evidence_by_pose(f), round.added);
  round.added.rivals = rivals_of(criticism.families, f, search.seed);
  for (const Rival& rival : round.added.rivals)
    if (rival.possible) round.possible.push_back(rival.effect);
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
  const auto again = second_look(search.table, search.joint, criticism, f, round.added.rivals, fit.worse,
                                 *refit, search.seed);
  if (again && again->better && first_choice)
    return add(search, family_called(criticism, *again->better), fit, criticism, report, false);
  if (again && !again->better) strike(again->rivals, round);
  keep_memory_possible(search, criticism, round);
  if (report.rounds.empty()) {
    report.next = next_measurements(search.table, fit, search.joint, round.added).steps;
    report.candidates[f].rivals = round.added.rivals;
  }
  const double table_sd_rad = fit.table_sd_rad;
  round.chi2_before = chi2_told(fit, criticism, table_sd_rad), round.rms_before_nT = residual_of(fit);
  search.joint = std::move(wider);
  round.model = search.joint.effects;
  const Rates rates = std::move(criticism.rates);
  Judgement judged = judge(*refit, search.suspects, search.seed, &rates);
  fit = std::move(judged.fit);
  criticism = std::move(judged.criticism);
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

/// A size beyond what occurs is a sign that something else is there; but a law that leaves only noise is
/// right whatever its size.
bool accounts_for_all(const Candidate& candidate, const Criticism& criticism) {
  constexpr double kNearlyAll = 0.9;
  constexpr double kMost = 0.6;  // of all chi-square, where the noise in it is not known
  if (!std::isnan(candidate.share)) return candidate.share >= kNearlyAll;
  return candidate.d * candidate.d >= kMost * criticism.residual.chi2();
}

/// Adds the best family that can be fitted; those that cannot are noted, as is the first that rests on one
/// pose.
bool add_winner(Search& search, JointFit& fit, Criticism& criticism, ExplainReport& report) {
  for (std::size_t f = 0; f < criticism.families.size() && criticism.rejects_named(f); ++f) {
    if (search.failed.contains(criticism.families[f].suspect->name)) continue;
    if (search.unknown.contains(criticism.families[f].where().where)) continue;
    if (std::string one = one_pose_text(fit, criticism, f); !one.empty()) {
      if (search.one_pose.empty()) search.one_pose = std::move(one);
      continue;
    }
    const Candidate c = candidate_of(criticism.families[f], criticism, fit.worse);
    if (!c.plausible && !accounts_for_all(c, criticism)) {
      search.absurd[c.effect] = size_text(c);
      continue;  // for now: beside what is still missing a size may be absurd that later is none
    }
    if (!add(search, f, fit, criticism, report)) continue;
    if (!c.plausible)
      report.notes.push_back(
          fmt::format("the size of {}, {}, is larger than is usual", c.effect, size_text(c)));
    return true;
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

/// What an axis misfits becomes part of its noise, so that it does not bend what others know.
void loosen(const JointFit& fit, const std::string& axis, JointOptions& options) {
  const auto where = Where::parse(axis);
  if (!where) return;
  const AxisNoise ratio = pose_residuals(fit.problem, fit.state).noise_ratio;
  const double residual_nT =
      fit.pose_noise_nT(where->sensor, where->axis) * ratio(where->sensor, where->axis);
  options.more_nT2[3 * where->sensor + where->axis] += residual_nT * residual_nT;
}

/// Takes the rounds from `first` on back, and closes the axis to names.
void take_back(const StandIns& found, Search& search, JointFit& fit, Criticism& criticism,
               ExplainReport& report) {
  search.unknown.insert(found.axis);
  std::set<std::string> names;
  for (std::size_t i = found.first; i < report.rounds.size(); ++i)
    names.insert(report.rounds[i].added.effect);
  report.notes.push_back(
      fmt::format("{} follows something that is in no library: {} {} it together and {} not its cause, so "
                  "none of them is named or added",
                  found.axis, fmt::join(names, ", "), names.size() == 1 ? "describes" : "describe",
                  names.size() == 1 ? "is" : "are"));
  search.joint.effects = found.first == 0 ? search.given : report.rounds[found.first - 1].model;
  report.rounds.resize(found.first);
  auto before = fit_joint_at_size(search.table, search.joint);
  if (!before) return;
  loosen(*before, found.axis, search.joint);
  const JointState near = before->state;
  before = fit_joint_at_size(search.table, search.joint, &near);
  if (!before) return;
  const Rates rates = std::move(criticism.rates);
  Judgement judged = judge(*before, search.suspects, search.seed, &rates);
  fit = std::move(judged.fit);
  criticism = std::move(judged.criticism);
}

/// Whether a memory of the cores may be what was found, of which these data do not have the way.
bool memory_may_be_it(const Search& search, const ExplainReport& report) {
  const auto memory = [](const std::string& name) { return name == "axis.hysteresis"; };
  return search.table.path.empty() &&
         std::any_of(report.rounds.begin(), report.rounds.end(), [&](const Round& r) {
           return memory(r.added.effect) ||
                  (!search.slow && std::any_of(r.possible.begin(), r.possible.end(), memory));
         });
}

/// A memory follows the way of the table, which may not be in the data.
void say_way_unknown(const Search& search, ExplainReport& report) {
  if (!memory_may_be_it(search, report)) return;
  report.notes.emplace_back(
      "the way of the table between its poses is not in these data: a memory of the cores is followed from "
      "dwell to dwell only, its size and its width are rough, and another name may stand in its place. To "
      "settle it: measure with the daemon, whose run file keeps the angles of the table on the way, or go "
      "to a dozen of the poses from both sides");
}

/// Whether what the fit left out may be what a law does to some of the poses: a step, a current that is
/// switched. One that does more than a hundredth of the field is no law of a working rig.
bool may_be_a_law(const JointFit& fit) {
  constexpr double kPoses = 4, kOfField = 0.01;
  if (fit.contradicting * static_cast<double>(fit.problem.poses.size()) < kPoses) return false;
  return std::all_of(fit.outliers.begin(), fit.outliers.end(), [&](const OutlierNode& node) {
    const JointPose& pose = fit.problem.poses.at(node.place);
    const double f_nT = fit.problem.common_field ? fit.state.f_nT : pose.f_nT;
    return node.unit != "nT" || std::abs(node.shift) < kOfField * f_nT;
  });
}

Result<ExplainReport> explained(const PoseTable& table, const ExplainOptions& options, double most_left_out);

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

/// A law that accounts for everything outranks leaving out what it does.
Result<ExplainReport> explain(const PoseTable& table, const ExplainOptions& options) {
  auto out = explained(table, options, JointOptions().most_left_out);
  if (!out || !may_be_a_law(*out->fit)) return out;
  auto with_all = explained(table, options, 0);
  const bool accounts =
      with_all && (with_all->finding == Finding::explained || with_all->finding == Finding::ambiguous);
  return accounts ? with_all : out;
}

namespace {

Result<ExplainReport> explained(const PoseTable& table, const ExplainOptions& options, double most_left_out) {
  auto joint = tuned_options(table, options.fit);
  if (!joint) return tl::unexpected(joint.error());
  joint->most_left_out = most_left_out;
  Search search{.table = table, .joint = *std::move(joint), .suspects = {}, .seed = options.fit.seed};
  search.suspects = options.suspects ? Suspects{*options.suspects, {}} : library_suspects(table);
  search.suspects.testable.insert(search.suspects.testable.end(), options.also.begin(), options.also.end());
  auto fit = fit_joint_at_size(table, search.joint);
  if (!fit) return tl::unexpected(fit.error());
  ExplainReport out;
  out.untestable = search.suspects.untestable;
  out.untestable.push_back(swapped_sensors());
  search.given = search.joint.effects;
  Judgement judged = judge(*fit, search.suspects, search.seed);
  *fit = std::move(judged.fit);
  Criticism criticism = std::move(judged.criticism);
  if (criticism.maps.empty()) look_at_maps(criticism);
  out.fit = std::make_shared<const JointFit>(*fit);
  describe(*fit, criticism, out);
  search.slow =
      !out.maps.empty() && (out.maps.front().map == "time" || out.maps.front().map == "temperature");
  const Asked first{.dof = criticism.dof, .reference = criticism.noise.reference};
  if (bad_data(*fit, criticism, search.joint.table_sd_rad, out.notes) ||
      !add_rounds(options.rounds, search, *fit, criticism, out)) {
    out.finding = Finding::bad_data;
    return out;
  }
  for (int axis = 0; axis < kChannels; ++axis) {
    if (criticism.maps.empty()) look_at_maps(criticism);
    const StandIns found = stand_ins(out, criticism);
    if (!found.any() || memory_may_be_it(search, out)) break;
    take_back(found, search, *fit, criticism, out);
    add_rounds(options.rounds, search, *fit, criticism, out);
  }
  say_absurd(search, criticism, out);
  say_way_unknown(search, out);
  if (!out.rounds.empty()) out.detectable = detectable(criticism);
  share_what_fell(out);
  out.maps_left = criticism.maps;
  out.model = search.joint.effects;
  out.left = !criticism.rejects() && search.unknown.empty() ? Finding::pass
             : criticism.rejects_named()                    ? Finding::partial
                                                            : Finding::unknown;
  out.finding = conclude(out, first, criticism, out.notes);
  if (!search.unknown.empty()) out.finding = out.rounds.empty() ? Finding::unknown : Finding::partial;
  name(out);
  return out;
}

}  // namespace

}  // namespace mgtd::calib
