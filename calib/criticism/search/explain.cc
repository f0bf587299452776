// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/explain.h"

#include <algorithm>

#include "calib/criticism/search/conclusion.h"
#include "calib/criticism/search/effect_search.h"
#include "calib/criticism/search/surrogates.h"
#include "calib/criticism/search/take_back.h"
#include "calib/criticism/tests/candidate.h"
#include "calib/criticism/tests/exchange_in_run.h"
#include "calib/criticism/tests/judgement.h"
#include "calib/fit/joint/joint_report.h"
#include "calib/fit/joint/profile_search.h"

namespace mgtd::calib::criticism::search {
namespace {

/// Residual with a law and all readings, over the residual without those that the fit left out. Where the law
/// is their cause, the two are one noise; where it is not, single readings far off make it many times larger.
constexpr double kAsLittle = 1.5;

std::vector<tests::Detectable> detectable(const tests::Criticism& c) {
  std::vector<tests::Detectable> out;
  for (const tests::ScoredFamily& f : c.families)
    out.push_back(tests::detectable_of(*f.candidate_effect, f.signatures.front()));
  return out;
}

/// Fills what describes the model that was asked about.
void describe(const fit::joint::JointFit& fit, const tests::Criticism& c, const ExplainOptions& options,
              ExplainReport& out) {
  out.noise = c.noise;
  out.noise_nT = fit.noise_nT();
  out.residual_nT = residual_of(fit);
  out.chi2 = tests::chi2_at_stated_noise(fit, c, fit.table_sd_rad), out.dof = c.dof;
  out.omnibus_log10_p = c.omnibus_log10_p;
  out.families = c.rates.best;
  out.maps = c.maps;
  out.outliers = fit.outliers;
  out.untestable.insert(out.untestable.end(), c.untestable.begin(), c.untestable.end());
  for (std::size_t i = 0; i < c.families.size(); ++i) {
    tests::Candidate candidate = tests::candidate_of(c.families[i], c, fit.noise_inflation);
    if (i == 0) tests::weigh_poses(fit, c.evidence_by_pose(0), candidate);
    if (options.impact) candidate.impact = tests::impact_of(fit, c.families[i]);
    out.candidates.push_back(std::move(candidate));
  }
  if (options.confusion) out.confusion = tests::confusion_of(c.families);
  out.detectable = detectable(c);
}

/// Of what still stands out at the end.
void note_absurd_sizes(const EffectSearch& search, const tests::Criticism& c, ExplainReport& report) {
  for (std::size_t f = 0; f < c.families.size() && c.rejects_named(f); ++f) {
    const auto found = search.absurd.find(c.families[f].candidate_effect->name);
    if (found == search.absurd.end()) continue;
    report.notes.emplace_back(SizeBeyondAll{found->second});
  }
}

void name(ExplainReport& report) {
  for (const Round& round : report.rounds) {
    if (std::find(report.named.begin(), report.named.end(), round.added.effect) == report.named.end())
      report.named.push_back(round.added.effect);
  }
  if (report.finding != Finding::ambiguous) return;
  for (const Round& round : report.rounds) {
    for (const std::string& other : round.possible) {
      if (std::find(report.named.begin(), report.named.end(), other) == report.named.end())
        report.named.push_back(other);
    }
  }
}

/// No residual shows it.
tests::Untestable swapped_sensors() {
  return {
      "data.swapped-sensors",
      "two sensors whose cables are exchanged read the same uniform field through matrices that are free: "
      "pass a small magnet by each sensor in turn and see which one answers, or compare with an earlier "
      "calibration (mgt diff)"};
}

/// Whether a memory of the cores may be what was found, of which these data do not have the way.
bool memory_may_be_it(const EffectSearch& search, const ExplainReport& report) {
  const auto memory = [](const std::string& name) { return name == "axis.hysteresis"; };
  return search.table.path.empty() &&
         std::any_of(report.rounds.begin(), report.rounds.end(), [&](const Round& r) {
           return memory(r.added.effect) ||
                  (!search.slow && std::any_of(r.possible.begin(), r.possible.end(), memory));
         });
}

/// Whether what the fit left out may be what a law does to some of the poses: a step, a current that is
/// switched. One that does more than a hundredth of the field is no law of a working rig. Where so many poses
/// contradict the others that none was left out, the fit has all readings already.
bool may_be_a_law(const fit::joint::JointFit& fit) {
  constexpr double kPoses = 4, kOfField = 0.01;
  if (fit.outliers.empty()) return false;
  if (fit.contradicting * static_cast<double>(fit.problem.poses.size()) < kPoses) return false;
  return std::all_of(fit.outliers.begin(), fit.outliers.end(), [&](const fit::OutlierNode& node) {
    const fit::joint::JointPose& pose = fit.problem.poses.at(node.place);
    const double f_nT = fit.problem.common_field ? fit.state.f_nT : pose.f_nT;
    return node.unit != "nT" || std::abs(node.shift) < kOfField * f_nT;
  });
}

/// The residual after the last round.
double left_nT(const ExplainReport& report) {
  return report.rounds.empty() ? report.residual_nT : report.rounds.back().rms_after_nT;
}

/// Bad data have no law: what was asked about stays as it was.
void condemn(const EffectSearch& search, ExplainReport& report) {
  report.rounds.clear(), report.next.clear();
  report.model = search.given;
  report.finding = report.left = Finding::bad_data;
}

Result<ExplainReport> explained(const PoseTable& table, const ExplainOptions& options, double most_left_out) {
  auto joint = fit::joint::profiled_options(table, options.fit);
  if (!joint) return tl::unexpected(joint.error());
  joint->most_left_out = most_left_out;
  tests::CandidateEffects candidate_effects = options.candidate_effects
                                                  ? tests::CandidateEffects{*options.candidate_effects, {}}
                                                  : tests::library_candidates(table);
  candidate_effects.testable.insert(candidate_effects.testable.end(), options.also.begin(),
                                    options.also.end());
  const auto fit = fit::joint::fit_joint_at_size(table, *joint);
  if (!fit) return tl::unexpected(fit.error());
  tests::Judgement judged = tests::judge(*fit, candidate_effects, options.fit.seed);
  EffectSearch search{.table = table,
                      .joint = *joint,
                      .candidate_effects = std::move(candidate_effects),
                      .seed = options.fit.seed,
                      .looks = options.looks,
                      .fit = std::move(judged.fit),
                      .criticism = std::move(judged.criticism),
                      .given = joint->effects};
  tests::Criticism& criticism = search.criticism;
  ExplainReport out;
  out.untestable = search.candidate_effects.untestable;
  out.untestable.push_back(swapped_sensors());
  if (criticism.maps.empty()) tests::look_at_maps(criticism);
  out.fit = std::make_shared<const fit::joint::JointFit>(search.fit);
  describe(search.fit, criticism, options, out);
  search.slow =
      !out.maps.empty() && (out.maps.front().map == "time" || out.maps.front().map == "temperature");
  const Asked first{.dof = criticism.dof, .reference = criticism.noise.reference};
  if (const auto exchange = tests::exchange_in_run(table, options.fit.field_nT)) {
    out.notes.emplace_back(SensorsExchanged{*exchange});
    condemn(search, out);
    return out;
  }
  if (bad_data(search.fit, criticism, search.joint.table_sd_rad, out.notes) ||
      !add_rounds(options.rounds, search, out)) {
    condemn(search, out);
    return out;
  }
  bool memory = memory_may_be_it(search, out);
  for (int axis = 0; axis < search.fit.problem.channels(); ++axis) {
    if (criticism.maps.empty()) tests::look_at_maps(criticism);
    const Surrogates found = find_surrogates(out, criticism, search.unknown);
    if (!found.any()) break;
    memory = memory || memory_may_be_it(search, out);
    take_back(found, search, out);
    if (found.whole_sensor() || !add_rounds(options.rounds, search, out)) break;
  }
  take_back_what_took_little(search, out);
  if (criticism.maps.empty()) tests::look_at_maps(criticism);
  take_back_beside_unknown_laws(search.unknown, criticism, out);
  const bool wandering_describes = take_back_lost_in_wandering(criticism.noise, out);
  keep_names_found_again(out);
  close_alternatives_that_were_added(out);
  note_absurd_sizes(search, criticism, out);
  const bool described = take_back_what_describes_a_recording(out, criticism);
  if (memory || memory_may_be_it(search, out)) out.notes.emplace_back(TablePathUnknown{});
  if (!out.rounds.empty()) {
    out.detectable = detectable(criticism);
    out.outliers = out.rounds.back().fit->outliers;
  }
  share_what_fell(out);
  out.maps_left = described ? out.maps : criticism.maps;
  out.model = out.rounds.empty() ? search.given : out.rounds.back().model;
  const bool nothing_left = !criticism.rejects() && !stays_far_above_noise(out, criticism);
  out.left = nothing_left && search.unknown.empty() && !wandering_describes ? Finding::pass
             : criticism.rejects_named()                                    ? Finding::partial
                                                                            : Finding::unknown;
  out.finding = conclude(out, first, criticism, out.notes);
  if (out.finding == Finding::bad_data) {
    condemn(search, out);
  } else if (!search.unknown.empty() || wandering_describes) {
    out.finding = out.rounds.empty() ? Finding::unknown : Finding::partial;
  }
  if (described) out.finding = out.left = Finding::unknown;
  name(out);
  return out;
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

const Round* ExplainReport::open_round() const {
  const auto open =
      std::find_if(rounds.begin(), rounds.end(), [](const Round& round) { return !round.possible.empty(); });
  return open == rounds.end() ? nullptr : &*open;
}

/// A law that accounts for what the fit left out outranks leaving it out: with all readings in, the law
/// leaves no more than the fit without them does. Where it does not, a few may be wrong beside it, as is a
/// pose during whose dwell the step came.
Result<ExplainReport> explain(const PoseTable& table, const ExplainOptions& options) {
  constexpr double kFew = 0.05;
  auto out = explained(table, options, options.fit.most_left_out);
  if (!out || !may_be_a_law(*out->fit)) return out;
  for (const double most_left_out : {0.0, kFew}) {
    if (most_left_out >= out->fit->contradicting) break;
    auto with_others = explained(table, options, most_left_out);
    if (with_others &&
        (with_others->finding == Finding::explained || with_others->finding == Finding::ambiguous) &&
        left_nT(*with_others) < kAsLittle * left_nT(*out))
      return with_others;
  }
  return out;
}

}  // namespace mgtd::calib::criticism::search
