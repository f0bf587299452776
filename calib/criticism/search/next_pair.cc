// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/next_pair.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "calib/criticism/tests/detectable.h"
#include "calib/design/actions.h"
#include "calib/design/next_measurement.h"
#include "calib/effects/library/effect_family.h"
#include "calib/fit/joint/joint_report.h"
#include "proto/units.h"

namespace mgtd::calib {
namespace {

using nlohmann::json;

Result<const Candidate*> candidate_of(const ExplainReport& report, const std::string& effect) {
  const std::string_view name = family_name(effect);
  for (const Candidate& c : report.candidates)
    if (c.effect == name) return &c;
  for (const Untestable& u : report.untestable) {
    if (u.effect != name) continue;
    const EffectFamily* const family = find_family(name);
    return fail(ErrorCode::refused, fmt::format("{} cannot be tested on this run: {}", name, u.why),
                family != nullptr && !family->experiment.empty() ? std::string(family->experiment)
                                                                 : "mgt effects " + std::string(name));
  }
  return fail(ErrorCode::usage, fmt::format("no effect that could be missing is called '{}'", name),
              "mgt effects lists them; one that is in the model is not missing");
}

/// As large as it was found, or as large as it must be to be seen.
Candidate sized(const Candidate& found, bool& assumed) {
  Candidate out = found;
  assumed = found.d < kSeen;
  if (!assumed) return out;
  const double n = static_cast<double>(out.coefficients.size());
  for (EffectCoefficient& c : out.coefficients)
    c.value = found.d > 1 ? c.value * kSeen / found.d : c.sd * kSeen / std::sqrt(n);
  return out;
}

/// Nothing but attitude, approach and dwell differs from more of the same.
bool by_the_rig(const std::vector<Pose>& poses, const std::vector<Pose>& same) {
  for (std::size_t k = 0; k < poses.size(); ++k) {
    const Pose &a = poses[k], &b = same[k];
    if (a.T_degC != b.T_degC || a.covariates != b.covariates || a.f_nT != b.f_nT ||
        a.since_stop_s != b.since_stop_s || a.mount != b.mount ||
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
                  x.azimuth_rad == y.azimuth_rad && x.pitch_rad == y.pitch_rad && x.roll_rad == y.roll_rad;
         });
}

std::vector<Pose> added(const PoseTable& table, const Action& action, const JointFit& fit) {
  const PoseTable whole = extended(table, action, fit.state.sensors);
  return {whole.poses.begin() + static_cast<std::ptrdiff_t>(table.poses.size()), whole.poses.end()};
}

std::vector<NextStep> steps_of(const PoseTable& table, const std::vector<NextMeasurement>& found,
                               const JointFit& fit) {
  std::vector<NextStep> out;
  const std::vector<Pose> same = added(table, actions().front(), fit);
  for (const NextMeasurement& m : found) {
    const auto action =
        std::find_if(actions().begin(), actions().end(), [&](const Action& a) { return a.text == m.action; });
    if (action == actions().end()) continue;
    NextStep step{.measurement = m, .poses = added(table, *action, fit)};
    // What the run has no column for cannot be changed, and would be more of the same.
    if (action != actions().begin() && !action->moved && alike(step.poses, same)) continue;
    step.by_the_rig = !action->moved && by_the_rig(step.poses, same);
    out.push_back(std::move(step));
  }
  return out;
}

/// The first round's winner, where something else could stand in its place.
std::optional<Candidate> open_question(const ExplainReport& report) {
  if (report.rounds.empty()) return std::nullopt;
  const Candidate& winner = report.rounds.front().added;
  const bool open = std::any_of(winner.rivals.begin(), winner.rivals.end(),
                                [](const Rival& rival) { return rival.possible; });
  return open ? std::optional(winner) : std::nullopt;
}

/// Why nothing is to be settled, with the rival that comes nearest.
std::string settled_text(const ExplainReport& report) {
  if (report.rounds.empty())
    return "nothing stands out on this run: there is nothing to settle (two names ask about a pair)";
  const Candidate& winner = report.rounds.front().added;
  if (winner.rivals.empty())
    return fmt::format("no other effect comes near {}: there is nothing to settle", winner.effect);
  return fmt::format(
      "nothing else could stand in the place of {}; the nearest, {}, is told from it: there is nothing to "
      "settle (two names ask about a pair)",
      winner.effect, winner.rivals.front().effect);
}

Rival against(const Candidate& rival) {
  return {.effect = rival.effect, .where = rival.where, .spec = rival.spec, .possible = true};
}

}  // namespace

Result<NextReport> next_of(const PoseTable& table, const ExplainOptions& options,
                           const std::optional<std::pair<std::string, std::string>>& pair) {
  const auto explained = explain(table, options);
  if (!explained) return tl::unexpected(explained.error());
  NextReport out;
  std::optional<Candidate> asked = open_question(*explained);
  if (pair) {
    auto a = candidate_of(*explained, pair->first);
    if (!a) return tl::unexpected(a.error());
    auto b = candidate_of(*explained, pair->second);
    if (!b) return tl::unexpected(b.error());
    if ((*b)->d > (*a)->d) std::swap(*a, *b);  // the one that the run rather speaks for is taken as true
    asked = sized(**a, out.assumed);
    asked->rivals = {against(**b)};
  }
  if (!asked) {
    out.text = settled_text(*explained);
    return out;
  }
  const auto hardest =
      std::min_element(asked->rivals.begin(), asked->rivals.end(), [](const Rival& a, const Rival& b) {
        return std::pair(!a.possible, a.p_right) < std::pair(!b.possible, b.p_right);
      });
  out.effect = asked->spec, out.rival = hardest->spec, out.d = asked->d;
  const JointOptions joint = joint_options(options.fit);
  const auto fit = fit_joint(table, joint);
  if (!fit) return tl::unexpected(fit.error());
  const NextMenu found = next_measurements(table, *fit, joint, *asked);
  out.steps = steps_of(table, found.steps, *fit);
  out.p_right_before = found.p_right_before;
  if (found.steps.empty())
    out.text = "none of the measurements that are known here would tell them apart better than this run does";
  return out;
}

json to_json(const NextReport& r) {
  json steps = json::array();
  for (const NextStep& s : r.steps) {
    steps.push_back({{"action", s.measurement.action},
                     {"minutes", s.measurement.minutes},
                     {"p_right_before", s.measurement.p_right_before},
                     {"p_right_after", s.measurement.p_right_after},
                     {"by_the_rig", s.by_the_rig},
                     {"poses", s.poses.size()}});
  }
  const auto name = [](const std::string& spec) { return spec.empty() ? json() : json(spec); };
  return {{"schema", "mgt.next/1"},    {"effect", name(r.effect)},
          {"rival", name(r.rival)},    {"d", r.d},
          {"size_assumed", r.assumed}, {"p_right_before", r.effect.empty() ? json() : json(r.p_right_before)},
          {"next", std::move(steps)},  {"text", r.text}};
}

std::string to_text(const NextReport& r) {
  std::string out;
  const auto to = std::back_inserter(out);
  if (!r.effect.empty()) {
    fmt::format_to(to, "{} or {}?\n", r.effect, r.rival);
    if (r.assumed)
      out += "neither is large enough to be seen on this run; at the smallest size that would be,\n";
    fmt::format_to(to, "these poses give the right name with probability {:.3f}\n", r.p_right_before);
  }
  if (!r.steps.empty())
    fmt::format_to(to, "{:>8} {:>8}  {:<8} {}\n", "minutes", "p right", "by", "what to measure");
  for (const NextStep& s : r.steps) {
    fmt::format_to(to, "{:>8.0f} {:>8.3f}  {:<8} {}\n", s.measurement.minutes, s.measurement.p_right_after,
                   s.by_the_rig ? "the rig" : "hand", s.measurement.action);
  }
  if (!r.text.empty()) out += r.text + "\n";
  return out;
}

std::string pose_list(const NextStep& step) {
  std::string note = step.by_the_rig ? "" : step.measurement.action;
  std::replace(note.begin(), note.end(), ',', ';');  // a comma ends a cell
  std::string out = "pose,set,azimuth_deg,pitch_deg,roll_deg,sense,dwell_s,since_stop_s";
  out += note.empty() ? "\n" : ",note\n";
  const auto to = std::back_inserter(out);
  const auto degrees = [](const std::optional<double>& a) {
    return a ? fmt::format("{:.2f}", to_deg(*a)) : std::string();
  };
  const auto number = [](const auto& x) { return x ? fmt::format("{}", *x) : std::string(); };
  int k = 0;
  for (const Pose& p : step.poses) {
    fmt::format_to(to, "{},{},{},{},{},{},{},{}", ++k, p.set, degrees(p.azimuth_rad), degrees(p.pitch_rad),
                   degrees(p.roll_rad), number(p.sense), number(p.dwell_s), number(p.since_stop_s));
    if (!note.empty()) out += "," + (k == 1 ? note : std::string());
    out += "\n";
  }
  return out;
}

}  // namespace mgtd::calib
