// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/next_pair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "calib/criticism/tests/detectable.h"
#include "calib/design/actions.h"
#include "calib/design/law_actions.h"
#include "calib/design/next_measurement.h"
#include "calib/effects/library/effect_family.h"
#include "calib/fit/joint/joint_report.h"
#include "proto/units.h"

namespace mgtd::calib::criticism::search {
namespace {

Result<const tests::Candidate*> candidate_of(const ExplainReport& report, const std::string& effect) {
  const std::string_view name = effects::family_name(effect);
  for (const tests::Candidate& c : report.candidates)
    if (c.effect == name) return &c;
  for (const tests::Untestable& u : report.untestable) {
    if (u.effect != name) continue;
    const effects::library::EffectFamily* const family = effects::library::find_family(name);
    return fail(ErrorCode::refused, fmt::format("{} cannot be tested on this run: {}", name, u.why),
                family != nullptr && !family->experiment.empty() ? std::string(family->experiment)
                                                                 : "mgt effects " + std::string(name));
  }
  return fail(ErrorCode::usage, fmt::format("no effect that could be missing is called '{}'", name),
              "mgt effects lists them; one that is in the model is not missing");
}

/// As large as it was found, or as large as it must be to be seen.
tests::Candidate sized(const tests::Candidate& found, bool& assumed) {
  tests::Candidate out = found;
  assumed = found.d < tests::kSeen;
  if (!assumed) return out;
  const double n = static_cast<double>(out.coefficients.size());
  for (calibration::EffectCoefficient& c : out.coefficients)
    c.value = found.d > 1 ? c.value * tests::kSeen / found.d : c.sd * tests::kSeen / std::sqrt(n);
  return out;
}

/// Nothing but attitude, approach, wait and dwell differs from more of the same.
bool by_the_rig(const std::vector<Pose>& poses, const std::vector<Pose>& same) {
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Pose &a = poses[k], &b = same[k];
    if (a.T_degC != b.T_degC || a.covariates != b.covariates || a.f_nT != b.f_nT || a.mount != b.mount ||
        (a.y_nT != b.y_nT && a.pitch_rad == b.pitch_rad))
      return false;
  }
  return true;
}

/// Conditions of all poses are the same.
bool alike(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  return by_the_rig(a, b) &&
         std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Pose& x, const Pose& y) {
           return x.y_nT == y.y_nT && x.sense == y.sense && x.dwell_s == y.dwell_s &&
                  x.since_stop_s == y.since_stop_s && x.azimuth_rad == y.azimuth_rad &&
                  x.pitch_rad == y.pitch_rad && x.roll_rad == y.roll_rad;
         });
}

std::vector<Pose> added(const PoseTable& table, const design::Action& action,
                        const fit::joint::JointFit& fit) {
  const PoseTable whole = design::extended(table, action, fit.state.sensors);
  return {whole.poses.begin() + static_cast<std::ptrdiff_t>(table.poses.size()), whole.poses.end()};
}

std::vector<NextStep> steps_of(const PoseTable& table, const std::vector<design::NextMeasurement>& found,
                               const fit::joint::JointFit& fit) {
  std::vector<NextStep> out;
  const std::vector<Pose> same = added(table, design::actions().front(), fit);
  for (const design::NextMeasurement& m : found) {
    const auto action = std::find_if(design::actions().begin(), design::actions().end(),
                                     [&](const design::Action& a) { return a.text == m.action; });
    if (action == design::actions().end()) continue;
    NextStep step{.measurement = m, .poses = added(table, *action, fit)};
    // What the run has no column for cannot be changed, and would be more of the same.
    if (action != design::actions().begin() && !action->moved && alike(step.poses, same)) continue;
    step.by_the_rig = !action->moved && design::has_table(table) && by_the_rig(step.poses, same);
    step.of_another_run = action->moved;
    out.push_back(std::move(step));
  }
  return out;
}

tests::Alternative against(const tests::Candidate& alternative) {
  return {
      .effect = alternative.effect, .where = alternative.where, .spec = alternative.spec, .possible = true};
}

/// A winner in whose place something else could stand, and the effects beside which that was asked.
struct OpenQuestion {
  tests::Candidate winner;
  std::vector<effects::EffectPtr> beside;
};

/// Of the first round that is open.
std::optional<OpenQuestion> open_question(const ExplainReport& report,
                                          const std::vector<effects::EffectPtr>& given) {
  const Round* const open = report.open_round();
  if (open == nullptr) return std::nullopt;
  OpenQuestion out{open->added, open == &report.rounds.front() ? given : std::prev(open)->model};
  std::vector<tests::Alternative>& others = out.winner.alternatives;
  std::erase_if(others, [&](const tests::Alternative& other) {
    return other.possible &&
           std::find(open->possible.begin(), open->possible.end(), other.effect) == open->possible.end();
  });
  for (const std::string& name : open->possible) {
    const bool there = std::any_of(others.begin(), others.end(), [&](const tests::Alternative& other) {
      return other.possible && other.effect == name;
    });
    const auto candidate = candidate_of(report, name);
    if (!there && candidate) others.push_back(against(**candidate));
  }
  const bool any = std::any_of(others.begin(), others.end(),
                               [](const tests::Alternative& other) { return other.possible; });
  return any ? std::optional(std::move(out)) : std::nullopt;
}

NothingToSettle nothing_to_settle(const ExplainReport& report) {
  if (report.rounds.empty()) return {};
  const tests::Candidate& winner = report.rounds.front().added;
  return {winner.effect, winner.alternatives.empty() ? std::string() : winner.alternatives.front().effect};
}

}  // namespace

Result<NextReport> next_of(const PoseTable& table, const ExplainOptions& options,
                           const std::optional<std::pair<std::string, std::string>>& pair) {
  const auto explained = explain(table, options);
  if (!explained) return tl::unexpected(explained.error());
  return next_after(*explained, table, options, pair);
}

Result<NextReport> next_after(const ExplainReport& explained, const PoseTable& table,
                              const ExplainOptions& options,
                              const std::optional<std::pair<std::string, std::string>>& pair) {
  NextReport out;
  out.finding = explained.finding;
  std::optional<OpenQuestion> open = open_question(explained, options.fit.effects);
  if (pair) {
    auto a = candidate_of(explained, pair->first);
    if (!a) return tl::unexpected(a.error());
    auto b = candidate_of(explained, pair->second);
    if (!b) return tl::unexpected(b.error());
    if ((*b)->d > (*a)->d) std::swap(*a, *b);  // the one that the run rather speaks for is taken as true
    open = {sized(**a, out.assumed), options.fit.effects};
    open->winner.alternatives = {against(**b)};
  }
  if (!open) {
    out.nothing_to_settle = nothing_to_settle(explained);
    return out;
  }
  const tests::Candidate& asked = open->winner;
  const auto hardest =
      std::min_element(asked.alternatives.begin(), asked.alternatives.end(),
                       [](const tests::Alternative& a, const tests::Alternative& b) {
                         return std::pair(!a.possible, a.p_right) < std::pair(!b.possible, b.p_right);
                       });
  out.effect = asked.spec, out.alternative = hardest->spec, out.d = asked.d;
  fit::joint::JointOptions joint = fit::joint::joint_options(options.fit);
  joint.effects = open->beside;
  const auto fit = fit::joint::fit_joint(table, joint);
  if (!fit) return tl::unexpected(fit.error());
  const design::NextMenu found = design::next_measurements(table, *fit, joint, asked);
  out.steps = steps_of(table, found.steps, *fit);
  out.none_helps = out.steps.empty();
  out.p_right_before = found.p_right_before;
  return out;
}

}  // namespace mgtd::calib::criticism::search
