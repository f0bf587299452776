// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/judge_run.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "calib/criticism/search/explain.h"
#include "calib/design/actions.h"
#include "calib/discovery/discover.h"
#include "calib/poses/pose_list.h"
#include "calib/report/next_report.h"
#include "daemon/plan/plan_from_list.h"
#include "daemon/run/solver.h"

namespace mgtd::daemon::run {
namespace {

using calib::criticism::search::ExplainReport;
using calib::criticism::search::Finding;
using calib::criticism::search::NextReport;
using calib::criticism::search::NextStep;
using calib::discovery::DiscoveryReport;
using calib::discovery::FoundFormula;

/// Of the probability of the right name, below which a measurement is not worth its time.
constexpr double kGain = 0.02;

std::string found_text(const RunEvidence& e) {
  const ExplainReport& r = e.explained;
  std::string out(to_string(r.finding));
  if (!r.named.empty())
    out += fmt::format(": {}", fmt::join(r.named, r.finding == Finding::ambiguous ? " or " : ", "));
  if (e.discovered) {
    const DiscoveryReport& d = *e.discovered;
    out += fmt::format("; for the rest {}", to_string(d.verdict));
    if (d.verdict == calib::discovery::Verdict::law || d.verdict == calib::discovery::Verdict::law_set)
      out += fmt::format(": {} at {}", d.laws.front().formulas.front().formula,
                         d.laws.front().formulas.front().where);
  }
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

void settle_effects(const NextReport& next, double minutes_left, NextPoses& out) {
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

/// How many times the poses would tell all formulas of the set apart; empty: no number would, or nothing is
/// left to tell.
std::optional<double> times_as_many(const std::vector<FoundFormula>& formulas) {
  double most = 1;
  for (const FoundFormula& f : formulas) {
    if (f.same_as == formulas.front().same_as) continue;
    if (!std::isfinite(f.needed_nT)) return std::nullopt;
    most = std::max(most, std::pow(f.needed_nT / formulas.front().size_nT, 2));
  }
  return most > 1 ? std::optional(most) : std::nullopt;
}

void settle_formulas(const RunEvidence& e, double minutes_left, NextPoses& out) {
  const std::vector<FoundFormula>& formulas = e.discovered->laws.front().formulas;
  const auto times = times_as_many(formulas);
  const auto n = static_cast<double>(e.table.poses.size());
  const double more = times ? std::ceil((*times - 1) * n) : 0,
               minutes = more * calib::design::minutes_per_pose(e.table);
  if (!times || minutes > minutes_left) {
    out.judgement.next = fmt::format(
        "more poses of this kind would not tell the {} formulas apart{}", formulas.size(),
        times ? fmt::format(" within {:.0f} minutes: {:.0f} poses would, in {:.0f}", minutes_left, more,
                            minutes)
              : std::string(": they read the same on them; other temperatures, or another order, may"));
    return;
  }
  out.judgement.next = fmt::format("to tell {} formulas apart: {:.0f} more poses as before, {:.0f} minutes",
                                   formulas.size(), more, minutes);
  out.judgement.minutes = minutes;
  const NextStep same{.measurement = {},
                      .by_the_rig = true,
                      .of_another_run = false,
                      .poses = calib::design::same_again(e.table, static_cast<std::size_t>(more))};
  out.poses = requested(same);
}

}  // namespace

NextPoses next_poses(const RunEvidence& e, double minutes_left, int looks_left) {
  NextPoses out;
  out.judgement.poses = static_cast<int>(e.table.poses.size());
  out.judgement.found = found_text(e);
  const Finding finding = e.explained.finding;
  const bool set = e.discovered && e.discovered->verdict == calib::discovery::Verdict::law_set;
  if (finding == Finding::pass || finding == Finding::explained) {
    out.judgement.next = finding == Finding::pass ? "nothing is left to explain"
                                                  : "the verdict is clear: mgt improve adds what it names";
  } else if (finding == Finding::bad_data) {
    out.judgement.next = "more poses do not mend these: mgt explain says which contradict the others";
  } else if (looks_left <= 0) {
    out.judgement.next = fmt::format("no more looks: {} at one run are the most", kMostJudgements);
  } else if (finding == Finding::ambiguous && e.next && !e.next->effect.empty()) {
    settle_effects(*e.next, minutes_left, out);
  } else if (set) {
    settle_formulas(e, minutes_left, out);
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
  const auto explained = calib::criticism::search::explain(table, search);
  if (!explained) return tl::unexpected(explained.error());
  RunEvidence evidence{.table = table, .explained = *explained};
  if (explained->finding == Finding::ambiguous) {
    auto next = calib::criticism::search::next_of(table, search, std::nullopt);
    if (!next) return tl::unexpected(next.error());
    evidence.next = *std::move(next);
  }
  if (explained->finding == Finding::partial || explained->finding == Finding::unknown) {
    options.effects = explained->model;
    // What no search can say is no reason to end the run without its verdict.
    if (auto found = calib::discovery::discover(table, {.fit = options, .checks = false}))
      evidence.discovered = *std::move(found);
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
