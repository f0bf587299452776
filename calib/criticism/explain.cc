// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/explain.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "calib/criticism/criticism.h"
#include "calib/criticism/growth.h"
#include "calib/criticism/next_measurement.h"
#include "calib/criticism/rest.h"
#include "calib/criticism/sentence.h"
#include "calib/fit/joint_report.h"

namespace mgtd::calib {
namespace {

/// Of an excess of four of its own standard deviations or more: by chance a right law falls below this in one
/// run of a hundred, and below 0.8 in one of seven.
constexpr double kEnoughShare = 0.5;
constexpr double kHalf = 0.5;         ///< of the winner's d: a sketch of a memory fits so well at least
constexpr double kOnePose = 0.5;      ///< of the evidence
constexpr double kMaxNodes = 0.02;    ///< of the readings
const double kTable_rad = to_rad(2);  ///< of error of the table a pose
constexpr double kTooQuiet = 0.6;     ///< of the noise that is told; heavy tails alone may leave 0.65
constexpr double kTooSmall = 0.0005;  ///< chance of a residual so small
constexpr double kRefit = 0.2;        ///< predicted and realised fall may differ by this

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
  out.share = excess > 0 ? std::clamp((score.S - score.k) / excess, 0.0, 1.0) : 0;
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

double rms_nT(const JointFit& fit) { return fit.noise_nT() * std::sqrt(fit.chi2 / std::max(fit.dof, 1.0)); }

/// In units of the noise that the table tells.
double chi2_of(const JointFit& fit, const Criticism& c) { return c.chi2 * fit.worse * fit.worse; }

double share_of_nodes(const JointFit& fit) {
  return static_cast<double>(fit.outliers.size()) /
         static_cast<double>(fit.problem.poses.size() * static_cast<std::size_t>(kChannels));
}

/// Fills what describes the model that was asked about.
void describe(const JointFit& fit, const Criticism& c, ExplainReport& out) {
  out.noise = c.noise;
  out.noise_nT = fit.noise_nT();
  out.noise_told = fit.sample_noise_nT.has_value();
  out.residual_nT = rms_nT(fit);
  out.chi2 = chi2_of(fit, c), out.dof = c.dof;
  out.omnibus_log10_p = c.omnibus_log10_p;
  out.families = c.independent;
  out.maps = c.maps;
  out.outliers = fit.outliers;
  out.untestable.insert(out.untestable.end(), c.untestable.begin(), c.untestable.end());
  for (std::size_t i = 0; i < c.families.size(); ++i) {
    Candidate candidate = candidate_of(c.families[i], c, fit.worse);
    if (i == 0) weigh_poses(fit, c.evidence_by_pose(0), candidate);
    out.candidates.push_back(std::move(candidate));
    out.detectable.push_back(detectable_of(*c.families[i].suspect, c.families[i].signatures.front()));
  }
}

/// Why a single name that accounts for the data is not yet an explanation; empty when it is.
std::string doubt(const Round& round, const Criticism& before) {
  const Candidate& a = round.added;
  if (!a.plausible) return fmt::format("the size that {} would need is beyond what occurs", a.effect);
  const double spread = 4 * std::sqrt(2 * before.dof);
  if (before.noise.reference.known && before.noise.reference.chi2 - before.dof > spread &&
      a.share < kEnoughShare)
    return fmt::format("{} accounts for {:.0f} % of the excess only", a.effect, 100 * a.share);
  const double realised = round.chi2_before - round.chi2_after;
  if (before.noise.reference.known &&
      std::abs(realised - a.fall) > kRefit * a.fall + 3 * std::sqrt(2 * a.fall))
    return fmt::format("chi-square fell by {:.0f} where {:.0f} was predicted", realised, a.fall);
  return {};
}

/// The first of the named laws that leaves something on its own axes; empty when none does.
std::string leaves_something(const ExplainReport& report, const Criticism& last) {
  for (const Round& round : report.rounds) {
    const double log10_p = rest_log10_p(last, round.added.where);
    if (log10_p < std::log10(kRestAlarm))
      return fmt::format("{} is not all of it: with it {} still differs from noise, p {}", round.added.effect,
                         round.added.where, p_text(log10_p));
  }
  return {};
}

bool overlap(const Where& a, const Where& b) {
  for (int s = 0; s < kSensors; ++s) {
    for (int x = 0; x < 3; ++x)
      if (a.covers(s, x) && b.covers(s, x)) return true;
  }
  return false;
}

/// One name in all rounds, found axis by axis. Two searched numbers on one axis are no one law: a staircase
/// follows any curve.
bool one_law(const std::vector<Round>& rounds) {
  std::vector<EffectSpec> seen;
  for (const Round& round : rounds) {
    if (round.added.effect != rounds.front().added.effect) return false;
    const auto spec = EffectSpec::parse(round.added.spec);
    if (!spec) return false;
    for (const EffectSpec& other : seen) {
      const bool together = !spec->where || !other.where || overlap(*spec->where, *other.where);
      if (together && spec->parameters != other.parameters) return false;
    }
    seen.push_back(*spec);
  }
  return true;
}

Finding conclude(const ExplainReport& report, const Criticism& first, const Criticism& last,
                 std::vector<std::string>& notes) {
  if (report.rounds.empty()) return last.rejects() ? Finding::unknown : Finding::pass;
  const Round& round = report.rounds.front();
  if (last.rejects()) return Finding::partial;
  if (std::string rest = leaves_something(report, last); !rest.empty()) {
    notes.push_back(std::move(rest));
    return Finding::partial;
  }
  if (!one_law(report.rounds)) return Finding::partial;
  if (!round.possible.empty()) return Finding::ambiguous;
  std::string why = doubt(round, first);
  if (why.empty()) return Finding::explained;
  notes.push_back(std::move(why));
  return Finding::partial;
}

/// Wiring and bookkeeping that no effect stands for; empty when there is none to be seen.
std::string wrong_wiring(const JointFit& fit) {
  for (std::size_t i = 0; i < fit.state.sensors.size(); ++i) {
    if (fit.state.sensors[i].mounting.determinant() > 0) continue;
    return fmt::format(
        "sensor {} is mirrored: its axes form a left-handed triad, two leads are swapped or one is inverted",
        i + 1);
  }
  if (fit.table_sd_rad > kTable_rad)
    return fmt::format(
        "the table angles contradict the readings by {:.1f} degrees a pose where {:.0f} is the limit: sense "
        "or order of the angles, or a mounting written down wrongly",
        to_deg(fit.table_sd_rad), to_deg(kTable_rad));
  return {};
}

bool bad_data(const JointFit& fit, const Criticism& c, std::vector<std::string>& notes) {
  if (std::string why = wrong_wiring(fit); !why.empty()) {
    notes.push_back(std::move(why));
    return true;
  }
  const double nodes = share_of_nodes(fit);
  if (nodes > kMaxNodes) {
    notes.push_back(fmt::format("{:.1f} % of the readings contradict the rest; the limit is {:.0f} %",
                                100 * nodes, 100 * kMaxNodes));
    return true;
  }
  if (c.quiet_ratio < kTooQuiet && c.quiet_log10_p < std::log10(kTooSmall)) {
    notes.push_back(
        fmt::format("{} scatters only {:.2f} of what its noise says: spreads or counts in the table are "
                    "wrong, or poses are copies",
                    c.quiet, c.quiet_ratio));
    return true;
  }
  return false;
}

struct Search {
  const PoseTable& table;
  JointOptions joint;
  Suspects suspects;
  std::uint64_t seed;
  std::set<std::string> failed{};  ///< effects that no fit settled with
};

/// Without the path of the table between its poses the equation of a memory is a sketch of it: a sketch that
/// stands out by itself stays possible.
void keep_memory_possible(const Search& search, const Criticism& c, Round& round) {
  constexpr std::string_view kMemory = "axis.hysteresis";
  if (!search.table.path.empty() || round.added.effect == kMemory) return;
  for (std::size_t f = 0; f < c.families.size() && c.rejects_named(f); ++f) {
    if (c.families[f].suspect->name != kMemory || c.families[f].winner().d() < kHalf * round.added.d)
      continue;
    if (std::find(round.possible.begin(), round.possible.end(), kMemory) == round.possible.end())
      round.possible.emplace_back(kMemory);
  }
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
  auto model = grown(search.joint.effects, best);
  if (!model) return false;
  JointOptions wider = search.joint;
  wider.effects = *std::move(model);
  wider.worse = fit.worse;
  auto refit = fit_joint_at_size(search.table, wider, &fit.state);
  if (!refit) {
    report.notes.push_back(
        fmt::format("the fit with {} failed: {}", round.added.spec, refit.error().message));
    search.failed.insert(round.added.effect);
    return false;
  }
  if (report.rounds.empty()) {
    report.next = next_measurements(search.table, fit, search.joint, round.added);
    report.candidates[f].rivals = round.added.rivals;
  }
  round.chi2_before = chi2_of(fit, criticism), round.rms_before_nT = rms_nT(fit);
  search.joint = std::move(wider);
  round.model = search.joint.effects;
  fit = std::move(*refit);
  criticism = criticise(fit, search.suspects, search.seed);
  round.chi2_after = chi2_of(fit, criticism), round.rms_after_nT = rms_nT(fit);
  report.rounds.push_back(std::move(round));
  return true;
}

/// Adds the best family that can be fitted; those that cannot are noted.
bool add_winner(Search& search, JointFit& fit, Criticism& criticism, ExplainReport& report) {
  for (std::size_t f = 0; f < criticism.families.size() && criticism.rejects_named(f); ++f) {
    if (search.failed.contains(criticism.families[f].suspect->name)) continue;
    if (add(search, f, fit, criticism, report)) return true;
  }
  return false;
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
  Search search{
      .table = table, .joint = joint_options(options.fit), .suspects = {}, .seed = options.fit.seed};
  search.suspects = options.suspects ? Suspects{*options.suspects, {}} : library_suspects(table);
  search.suspects.testable.insert(search.suspects.testable.end(), options.also.begin(), options.also.end());
  auto fit = fit_joint_at_size(table, search.joint);
  if (!fit) return tl::unexpected(fit.error());
  ExplainReport out;
  out.untestable = search.suspects.untestable;
  Criticism criticism = criticise(*fit, search.suspects, search.seed);
  describe(*fit, criticism, out);
  if (bad_data(*fit, criticism, out.notes)) {
    out.finding = Finding::bad_data;
    return out;
  }
  const Criticism first = criticism;
  for (int round = 0; round < options.rounds && criticism.rejects_named(); ++round) {
    Candidate weighed;
    weigh_poses(*fit, criticism.evidence_by_pose(0), weighed);
    if (weighed.largest_pose > kOnePose) {
      out.notes.push_back(fmt::format("one pose ({}) carries the evidence for {}: measure it again",
                                      weighed.poses.front(), criticism.families.front().suspect->name));
      if (out.rounds.empty()) {
        out.finding = Finding::bad_data;
        return out;
      }
      break;
    }
    if (!add_winner(search, *fit, criticism, out)) break;
  }
  const auto memory = [](const std::string& name) { return name == "axis.hysteresis"; };
  const bool remembers = std::any_of(out.rounds.begin(), out.rounds.end(), [&](const Round& r) {
    return memory(r.added.effect) || std::any_of(r.possible.begin(), r.possible.end(), memory);
  });
  if (remembers && table.path.empty())
    out.notes.emplace_back(
        "the way of the table between its poses is not in these data: a memory of the cores is followed from "
        "dwell to dwell only, its size and its width are rough; a run file has the way");
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
