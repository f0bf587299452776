// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/judge_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "calib/criticism/search/explain.h"
#include "calib/criticism/search/next_among.h"
#include "calib/criticism/search/stand_ins.h"
#include "calib/discovery/discover.h"
#include "calib/discovery/remaining_law.h"
#include "calib/effects/effect_context.h"
#include "calib/effects/library/library.h"
#include "calib/poses/pose_list.h"
#include "calib/report/discovery_reason.h"
#include "calib/report/next_report.h"
#include "calib/report/verdict_text.h"
#include "daemon/plan/plan_from_list.h"
#include "daemon/run/law_hypotheses.h"
#include "daemon/run/solver.h"
#include "proto/shell_word.h"

namespace mgtd::daemon::run {
namespace {

using calib::criticism::search::ExplainReport;
using calib::criticism::search::Finding;
using calib::criticism::search::NextReport;
using calib::criticism::search::NextStep;
using calib::discovery::DiscoveryReport;

/// Of the probability of the right name, below which a measurement is not worth its time.
constexpr double kGain = 0.02;

using calib::discovery::LawFinding;

/// "LAW: z^4 at s3.z"
std::string discovered_text(const DiscoveryReport& d) {
  std::string out(to_string(d.finding));
  if (d.accounts_for_everything()) {
    std::vector<std::string> laws;
    for (const calib::discovery::FoundLaw& law : d.laws)
      laws.push_back(fmt::format("{} at {}", law.formulas.front().formula, law.formulas.front().where));
    out += fmt::format(": {}", fmt::join(laws, " and "));
  }
  if (d.finding == LawFinding::shape_only || d.finding == LawFinding::noise_like)
    out += fmt::format(" ({})", calib::report::reason_text(d));
  return out;
}

std::string found_text(const RunEvidence& e) {
  const ExplainReport& r = e.explained;
  const std::string stand_ins = r.stand_ins.empty()
                                    ? ""
                                    : fmt::format("; {} {} a part of it", fmt::join(r.stand_ins, ", "),
                                                  r.stand_ins.size() == 1 ? "describes" : "describe");
  if (e.formulas_account_for_all()) return discovered_text(*e.discovered) + stand_ins;
  std::string out(to_string(r.finding));
  if (!r.named.empty()) out += ": " + calib::report::names_text(r);
  if (e.discovered) {
    for (const std::string& effect : e.beside) out += fmt::format("; for the rest LIBRARY: {}", effect);
    out += fmt::format("; for the rest {}{}", discovered_text(*e.discovered), stand_ins);
  }
  return out;
}

/// The search again, beside the same effects.
std::string discover_command(const RunEvidence& e) {
  std::string out = "mgt discover";
  for (const std::string& effect : e.model) out += " --with " + shell_word(effect);
  return out;
}

std::vector<RequestedPose> requested(const NextStep& step) {
  const auto list = calib::poses::read_pose_list(calib::report::pose_list(step), "mgt next");
  return list ? plan::requested_poses(*list) : std::vector<RequestedPose>{};
}

/// The best action that fits in, one without hands first.
const NextStep* worthwhile(const NextReport& next, double minutes_left) {
  const NextStep* by_hand = nullptr;
  for (const NextStep& step : next.steps) {
    const calib::design::NextMeasurement& m = step.measurement;
    if (step.of_another_run || m.minutes > minutes_left || m.p_right_after - m.p_right_before < kGain)
      continue;
    if (step.by_the_rig) return &step;
    if (by_hand == nullptr) by_hand = &step;
  }
  return by_hand;
}

void settle(const NextReport& next, double minutes_left, NextPoses& out) {
  const NextStep* const step = worthwhile(next, minutes_left);
  if (step == nullptr) {
    out.judgement.next = fmt::format(
        "nothing that can be done within {:.0f} minutes would tell {} from {}: mgt next shows what would",
        minutes_left, next.effect, next.alternative);
    return;
  }
  const calib::design::NextMeasurement& m = step->measurement;
  out.poses = requested(*step);
  if (out.poses.empty()) {
    out.judgement.next = fmt::format("{}: its poses cannot be listed", m.action);
    return;
  }
  out.judgement.next = fmt::format(
      "{}, {:.0f} minutes, to tell {} from {}: the right name then with probability {:.3f}, now {:.3f}",
      m.action, m.minutes, next.effect, next.alternative, m.p_right_after, m.p_right_before);
  out.judgement.minutes = m.minutes;
  if (!step->by_the_rig)
    out.poses.front().note = out.judgement.next + "; mgt run finish ends the run as it is";
}

int sensors_of(const PoseTable& table) {
  return calib::effects::EffectContext{.table = &table, .offset_nT = {}}.sensors();
}

/// The effects of `searched` that the model of the run does not hold.
std::vector<std::string> beyond(const std::vector<calib::effects::EffectPtr>& kept,
                                const std::vector<calib::effects::EffectPtr>& searched) {
  const std::vector<std::string> in_model = calib::effects::specs_of(kept);
  std::vector<std::string> out = calib::effects::specs_of(searched);
  std::erase_if(out, [&](const std::string& spec) {
    return std::find(in_model.begin(), in_model.end(), spec) != in_model.end();
  });
  return out;
}

/// Formulas for what is left, beside the effects of the library that account for a part of it. Each of those
/// joins the model, and the rest is searched again. What no search can say is no reason to end the run
/// without its verdict.
void discover_in(calib::fit::FitOptions& options, RunEvidence& evidence) {
  constexpr std::size_t kMostEffects = 3;
  const int sensors = sensors_of(evidence.table);
  while (true) {
    auto found = calib::discovery::discover(evidence.table,
                                            {.fit = options, .looks = kMostJudgements, .checks = false});
    if (!found) return;
    evidence.discovered = *std::move(found);
    if (evidence.discovered->finding != calib::discovery::LawFinding::library ||
        evidence.leaves_formulas_open() || evidence.beside.size() == kMostEffects)
      return;
    const calib::discovery::FoundFormula& leading = evidence.discovered->laws.front().formulas.front();
    auto effect = calib::effects::library::make_effect(leading.library + "@" + leading.where, sensors);
    if (!effect) return;
    evidence.beside.push_back((*effect)->spec());
    options.effects.push_back(*std::move(effect));
  }
}

/// Formulas that take the place of effects that explain() names: those are taken back from `explained`, and
/// the others stay in the model.
bool discover_instead(calib::fit::FitOptions& options, ExplainReport& explained, RunEvidence& evidence) {
  auto law = calib::discovery::law_instead(
      evidence.table, {.fit = options, .looks = kMostJudgements, .checks = false}, explained.model);
  if (!law) return false;
  calib::criticism::search::take_back_stand_ins(law->instead_of, explained);
  evidence.discovered = *std::move(law->found);
  options.effects = std::move(law->model);
  return true;
}

/// next_after() asks about the open round.
bool named_and_open(const ExplainReport& r) {
  const calib::criticism::search::Round* const open = r.open_round();
  return open != nullptr && std::find(r.named.begin(), r.named.end(), open->added.effect) != r.named.end();
}

}  // namespace

bool RunEvidence::formulas_account_for_all() const {
  return !explained.stand_ins.empty() && explained.named.empty();
}

bool RunEvidence::leaves_formulas_open() const {
  if (!discovered) return false;
  const calib::discovery::LawFindingReason& reason = discovered->reason;
  return discovered->finding == LawFinding::law_set ||
         (discovered->finding == LawFinding::library && !(reason.measured > reason.limit));
}

NextPoses next_poses(const RunEvidence& e, double minutes_left, int looks_left) {
  NextPoses out;
  out.judgement.poses = static_cast<int>(e.table.poses.size());
  out.judgement.found = found_text(e);
  const Finding finding = e.explained.finding;
  const bool open = e.next && !e.next->effect.empty();
  if (finding == Finding::pass || finding == Finding::explained) {
    out.judgement.next = finding == Finding::pass ? "nothing is left to explain"
                                                  : "the verdict is clear: mgt improve adds what it names";
  } else if (finding == Finding::bad_data) {
    out.judgement.next = "more poses would not help: mgt explain lists the poses that contradict the others";
  } else if (!open && e.discovered && e.discovered->finding == LawFinding::law) {
    out.judgement.next =
        e.formulas_account_for_all()
            ? "a formula accounts for everything: mgt discover says how to keep it"
            : fmt::format("a formula accounts for the rest: {} says how to keep it", discover_command(e));
  } else if (!open && e.discovered && e.discovered->finding == LawFinding::pass && !e.beside.empty()) {
    out.judgement.next = fmt::format("{} account{} for everything: mgt add shows by how much the error falls",
                                     fmt::join(e.model, " and "), e.model.size() == 1 ? "s" : "");
  } else if (looks_left <= 0) {
    out.judgement.next = fmt::format("the run has been judged {} times, which is the limit", kMostJudgements);
  } else if (open) {
    settle(*e.next, minutes_left, out);
  } else {
    out.judgement.next =
        "no measurement is known that would make it clearer: mgt explain and mgt discover say "
        "where to look";
  }
  return out;
}

Result<NextPoses> judge(const PoseTable& table, calib::fit::FitOptions options, double minutes_left,
                        int looks_left) {
  const calib::criticism::search::ExplainOptions search{.fit = options, .looks = kMostJudgements};
  auto explained = calib::criticism::search::explain(table, search);
  if (!explained) return tl::unexpected(explained.error());
  RunEvidence evidence{.table = table, .explained = *explained};
  if (explained->finding == Finding::ambiguous) {
    auto next = calib::criticism::search::next_after(*explained, table, search, std::nullopt);
    if (!next) return tl::unexpected(next.error());
    evidence.next = *std::move(next);
  }
  if (explained->finding == Finding::partial || explained->finding == Finding::unknown) {
    if (!discover_instead(options, *explained, evidence)) {
      options.effects = explained->model;
      discover_in(options, evidence);
    }
    evidence.model = beyond(search.fit.effects, options.effects);
    if (evidence.leaves_formulas_open()) {
      const std::size_t asked = evidence.discovered->reason.law;
      const auto hypotheses = hypotheses_of(evidence.discovered->laws[asked], sensors_of(table));
      add_laws_beside(*evidence.discovered, asked, sensors_of(table), options);
      if (!hypotheses.empty())
        if (auto next = calib::criticism::search::next_among(table, options, hypotheses))
          evidence.next = *std::move(next);
    }
    if (named_and_open(*explained) && (!evidence.next || evidence.next->effect.empty()))
      if (auto next = calib::criticism::search::next_after(*explained, table, search, std::nullopt))
        evidence.next = *std::move(next);
  }
  return next_poses(evidence, minutes_left, looks_left);
}

Result<NextPoses> judge_run(const std::filesystem::path& run_file, double minutes_left, int looks_left,
                            std::stop_token stop) {
  const auto source = store::read_run(run_file);
  if (!source) return tl::unexpected(source.error());
  auto options = fit_options(*source);
  if (!options) return tl::unexpected(options.error());
  options->stop = std::move(stop);
  return judge(source->table, *std::move(options), minutes_left, looks_left);
}

}  // namespace mgtd::daemon::run
