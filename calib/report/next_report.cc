// SPDX-License-Identifier: Apache-2.0
#include "calib/report/next_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "proto/units.h"

namespace mgtd::calib::report {
namespace {

using nlohmann::json;

/// What to do where no two names are open and yet the verdict is no explanation; else empty.
std::string not_explained_text(const criticism::search::NextReport& r) {
  using criticism::search::Finding;
  if (r.finding == Finding::bad_data)
    return "the readings contradict each other (BAD-DATA): mgt explain says where, and what to do before "
           "anything can be told from them";
  if (r.finding != Finding::unknown && r.finding != Finding::partial) return {};
  return fmt::format(
      "no two effects are left open, but {} ({}): mgt explain says where it shows, mgt report draws it, mgt "
      "discover looks for its formula, and mgt define takes one of your own",
      r.finding == Finding::unknown ? "what stands out on this run has no name"
                                    : "what was named leaves a part unexplained",
      criticism::search::to_string(*r.finding));
}

/// Why there is nothing to settle, or nothing that helps; else empty.
std::string reason_text(const criticism::search::NextReport& r) {
  if (r.nothing_to_settle) {
    if (std::string text = not_explained_text(r); !text.empty()) return text;
    const auto& [winner, nearest] = *r.nothing_to_settle;
    if (winner.empty())
      return "nothing stands out on this run: there is nothing to settle; to ask about two effects, name "
             "both";
    if (nearest.empty())
      return fmt::format("no other effect comes near {}: there is nothing to settle", winner);
    return fmt::format(
        "nothing else could stand in the place of {}; the nearest, {}, is told from it: there is nothing to "
        "settle; to ask about two effects, name both",
        winner, nearest);
  }
  if (r.told_apart) return "the poses of this run tell them apart: there is nothing to settle";
  return r.none_helps
             ? "none of the measurements that are known here would tell them apart better than this run does"
             : "";
}

/// The description of that spec as a person reads it.
std::string shown(const criticism::search::NextReport& r, const std::string& spec) {
  for (const design::Hypothesis& hypothesis : r.hypotheses)
    if (hypothesis.name == spec || (hypothesis.specs.size() == 1 && hypothesis.specs.front() == spec))
      return hypothesis.name;
  return spec;
}

std::string hypotheses_text(const std::vector<design::Hypothesis>& hypotheses) {
  std::string out = "what it could be:\n";
  for (const design::Hypothesis& hypothesis : hypotheses)
    out += hypothesis.P ? fmt::format("  P {:.2f}  {}\n", *hypothesis.P, hypothesis.name)
                        : fmt::format("  {}\n", hypothesis.name);
  return out;
}

std::string never_text(const criticism::search::NextReport& r) {
  constexpr std::size_t kShown = 3;
  std::string out;
  for (std::size_t i = 0; i < std::min(kShown, r.never.size()); ++i)
    out += fmt::format("nothing known here would tell {} from {}\n", shown(r, r.never[i].first),
                       shown(r, r.never[i].second));
  if (r.never.size() > kShown) out += fmt::format("nor {} other pairs\n", r.never.size() - kShown);
  return out;
}

}  // namespace

json to_json(const criticism::search::NextReport& r) {
  const auto lambda = [](const std::optional<double>& x) { return x ? json(*x) : json(); };
  json hypotheses = json::array(), left_out = json::array();
  for (const design::Hypothesis& hypothesis : r.hypotheses)
    hypotheses.push_back({{"formula", hypothesis.name},
                          {"specs", hypothesis.specs},
                          {"P", hypothesis.P ? json(*hypothesis.P) : json()}});
  for (const design::LeftOut& one : r.left_out)
    left_out.push_back({{"action", one.action}, {"why", one.why}});
  json steps = json::array();
  for (const criticism::search::NextStep& s : r.steps) {
    steps.push_back({{"action", s.measurement.action},
                     {"minutes", s.measurement.minutes},
                     {"p_right_before", s.measurement.p_right_before},
                     {"p_right_after", s.measurement.p_right_after},
                     {"separation_before", lambda(s.measurement.lambda_before)},
                     {"separation_after", lambda(s.measurement.lambda_after)},
                     {"by_the_rig", s.by_the_rig},
                     {"poses", s.poses.size()}});
  }
  json never = json::array();
  for (const auto& [a, b] : r.never) never.push_back({a, b});
  const auto name = [](const std::string& spec) { return spec.empty() ? json() : json(spec); };
  return {{"schema", "mgt.next/1"},
          {"effect", name(r.effect)},
          {"rival", name(r.alternative)},
          {"d", r.d},
          {"size_assumed", r.assumed},
          {"p_right_before", r.effect.empty() ? json() : json(r.p_right_before)},
          {"separation_before", lambda(r.lambda_before)},
          {"rivals", std::move(hypotheses)},
          {"next", std::move(steps)},
          {"left_out", std::move(left_out)},
          {"never_told_apart", std::move(never)},
          {"text", reason_text(r)}};
}

std::string to_text(const criticism::search::NextReport& r) {
  std::string out;
  const auto to = std::back_inserter(out);
  if (r.hypotheses.size() > 2) out += hypotheses_text(r.hypotheses);
  if (!r.effect.empty()) {
    fmt::format_to(to, "{}{} or {}?\n", r.hypotheses.size() > 2 ? "hardest to tell apart: " : "",
                   shown(r, r.effect), shown(r, r.alternative));
    if (r.assumed)
      out += "neither is large enough to be seen on this run; at the smallest size that would be, ";
    fmt::format_to(to, "{}these poses give the right name with probability {:.3f}\n",
                   r.hypotheses.size() > 2 ? "between any two of them, weighted by P, " : "",
                   r.p_right_before);
  }
  if (!r.steps.empty())
    fmt::format_to(to, "{:>8} {:>8}  {:<8} {}\n", "minutes", "p right", "by", "what to measure");
  for (const criticism::search::NextStep& s : r.steps) {
    fmt::format_to(to, "{:>8.0f} {:>8.3f}  {:<8} {}\n", s.measurement.minutes, s.measurement.p_right_after,
                   s.by_the_rig ? "the rig" : "hand", s.measurement.action);
  }
  if (!r.none_helps) out += never_text(r);
  for (const design::LeftOut& one : r.told_apart ? std::vector<design::LeftOut>{} : r.left_out)
    fmt::format_to(to, "left out: {}: {}\n", one.action, one.why);
  if (const std::string why = reason_text(r); !why.empty()) out += why + "\n";
  return out;
}

std::string pose_list(const criticism::search::NextStep& step) {
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

}  // namespace mgtd::calib::report
