// SPDX-License-Identifier: Apache-2.0
#include "calib/report/verdict_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <set>
#include <variant>

#include "calib/criticism/tests/candidate.h"
#include "calib/effects/effect_spec.h"
#include "calib/effects/library/effect_family.h"
#include "calib/fit/joint/single_samples.h"
#include "calib/fit/joint/table_ceiling.h"
#include "calib/report/explain_note_text.h"
#include "calib/report/noise_text.h"
#include "calib/report/residual_words.h"
#include "calib/report/size_text.h"
#include "calib/stats/probability.h"
#include "proto/pose_numbers_text.h"
#include "proto/shell_word.h"
#include "proto/units.h"

namespace mgtd::calib::report {
namespace {

std::string place(const criticism::tests::Candidate& c) {
  if (c.where == "site" || c.where == "table" || c.where == "platform") return "";
  if (c.where == "all") return " with one coefficient for all axes";
  if (c.where == "each-axis" || c.where == "each-sensor") return " in several axes";
  return fmt::format(" in {}", c.where);
}

std::string noise_text(const criticism::search::ExplainReport& r) {
  std::string out = fmt::format("The residual is {:.3g} nT", r.residual_nT);
  if (r.noise.known)
    out += fmt::format(" where the noise of a pose mean is {:.3g} nT, {}", r.noise_nT,
                       noise_source(r.noise.known));
  if (const std::string tests = noise_of_tests(r.noise); !tests.empty()) out += "; " + tests;
  if (r.noise.quantisation_nT > 0)
    out += fmt::format("; readings stand in steps of {:.3g} nT, which is part of the noise",
                       r.noise.quantisation_nT);
  return out + ".";
}

/// The candidate with its coefficients of the fit that holds it. Before it everything that is missing counts
/// as noise, so that no size is better known than to one part in the root of the number of poses.
criticism::tests::Candidate as_fitted(const criticism::search::Round& round) {
  criticism::tests::Candidate out = round.added;
  if (round.fit == nullptr) return out;
  std::vector<calibration::EffectCoefficient> found;
  Eigen::Index slot = 0;
  for (const effects::EffectPtr& effect : round.fit->problem.effects) {
    for (const effects::Coefficient& c : effect->coefficients()) {
      const double variance = round.fit->covariance(round.fit->problem.slots().effects() + slot,
                                                    round.fit->problem.slots().effects() + slot);
      if (effect->name() == out.effect)
        found.push_back({c.name, round.fit->state.coefficients[slot], std::sqrt(variance), c.unit});
      ++slot;
    }
  }
  if (!found.empty()) out.coefficients = std::move(found);
  return out;
}

/// What adding it did; `before`: the fit without it. Wrong angles hardly show in the readings, which tell
/// each pose its own attitude.
std::string fall_text(const criticism::search::Round& round, const fit::joint::JointFit* before) {
  if (before != nullptr && round.fit && round.added.where == "table")
    return fmt::format("the angles of the table scatter by {:.3g} instead of {:.3g} deg{}",
                       to_deg(round.fit->table_sd_rad), to_deg(before->table_sd_rad),
                       fit::joint::or_more(before->table_sd_rad));
  const std::string from = fmt::format("{:.3g}", round.rms_before_nT),
                    to = fmt::format("{:.3g}", round.rms_after_nT);
  if (from == to) return fmt::format("the residual stays at {} nT", to);
  return fmt::format("the residual {} from {} to {} nT",
                     round.rms_after_nT < round.rms_before_nT ? "falls" : "goes", from, to);
}

/// ", from pose 54 on": the first pose behind a moment; empty where it is not known.
std::string first_pose_text(const criticism::search::Round& round, double ts_h) {
  if (round.fit == nullptr) return {};
  for (const fit::joint::JointPose& pose : round.fit->problem.poses)
    if (pose.t_h > ts_h) return fmt::format(", from pose {} on", pose.pose->number);
  return {};
}

/// Numbers that were searched for, as fitted: " (ts = 0.383 h, from pose 54 on)".
std::string searched_text(const criticism::search::Round& round) {
  const effects::library::EffectFamily* const family = effects::library::find_family(round.added.effect);
  if (family == nullptr || !family->scan) return {};
  std::set<std::string> numbers;
  for (const effects::EffectPtr& effect : round.model) {
    if (effect->name() != family->name) continue;
    const auto spec = effects::EffectSpec::parse(effect->spec());
    if (!spec) continue;
    for (const auto& [name, value] : spec->parameters)
      if (name == family->scan->parameter)
        numbers.insert(fmt::format("{} = {} {}{}", name, value, family->scan->unit,
                                   name == "ts"
                                       ? first_pose_text(round, spec->number("ts", 0, 0, 1e9).value_or(0))
                                       : std::string()));
  }
  return numbers.empty() ? "" : fmt::format(" ({})", fmt::join(numbers, ", "));
}

std::string round_text(const criticism::search::Round& round, const fit::joint::JointFit* before) {
  const criticism::tests::Candidate& a = round.added;
  return fmt::format("It behaves like {}{}: {:.1f} sigma, {}. With it in the model{} {}, and its size is {}.",
                     a.effect, place(a), a.d, stats::p_phrase(a.log10_p), searched_text(round),
                     fall_text(round, before), size_text(as_fitted(round)));
}

/// Where what was found is the lesser part of what is there.
std::string lesser_part_text(const criticism::search::ExplainReport& r) {
  constexpr double kHalf = 0.5;
  if (r.finding != criticism::search::Finding::partial || !r.stand_ins.empty() || !r.noise.known ||
      r.rounds.empty())
    return {};
  const auto beyond = [&](double rms_nT) { return rms_nT * rms_nT - r.noise_nT * r.noise_nT; };
  const double before = beyond(r.rounds.front().rms_before_nT), after = beyond(r.rounds.back().rms_after_nT);
  if (!(before > 0) || after < kHalf * before) return {};
  return fmt::format(
      "What is named below takes away only {:.0f} % of what is beyond the noise: most of it is something "
      "else.",
      100 * std::max(0.0, 1 - after / before));
}

bool is_named(const criticism::search::Round& round, const criticism::search::ExplainReport& r) {
  return r.stand_ins.empty() ||
         std::find(r.named.begin(), r.named.end(), round.added.effect) != r.named.end();
}

/// The commands for effects whose name alone does not say all that was found: a moment, a place, a width.
std::string commands_text(const criticism::search::ExplainReport& r) {
  std::vector<std::string> commands;
  const auto given = r.fit ? effects::specs_of(r.fit->problem.effects) : std::vector<std::string>{};
  const auto among = [](const std::vector<std::string>& specs, const std::string& spec) {
    return std::find(specs.begin(), specs.end(), spec) != specs.end();
  };
  for (const effects::EffectPtr& effect : r.model) {
    const std::string text = effect->spec();
    const auto spec = effects::EffectSpec::parse(text);
    if (among(given, text) || among(r.stand_ins, text) || !spec || spec->parameters.empty()) continue;
    if (effects::library::find_family(effect->name()) == nullptr) continue;
    commands.push_back(fmt::format("mgt add {} RUN", shell_word(text)));
  }
  if (commands.empty()) return {};
  return fmt::format("As it was found it is added by {}.", fmt::join(commands, " and "));
}

std::string alternatives_text(const criticism::search::Round& round) {
  if (!round.possible.empty()) {
    return fmt::format("These poses do not tell it from {}.", fmt::join(round.possible, ", "));
  }
  const auto& alternatives = round.added.alternatives;
  if (alternatives.empty()) return "Nothing else in the library looks like it.";
  const auto nearest =
      std::min_element(alternatives.begin(), alternatives.end(),
                       [](const criticism::tests::Alternative& a, const criticism::tests::Alternative& b) {
                         return a.p_right < b.p_right;
                       });
  return fmt::format("Nearest alternative: {}, told apart with probability {:.4g} at this size.",
                     nearest->effect, nearest->p_right);
}

std::string left_text(const std::vector<criticism::tests::MapScore>& maps) {
  if (maps.empty()) return "";
  const criticism::tests::MapScore& m = maps.front();
  return fmt::format("What is left shows most against {} ({}, {}).", m.map, m.where,
                     stats::p_phrase(m.log10_p));
}

bool follows_nothing(const std::vector<criticism::tests::MapScore>& maps) {
  return maps.empty() || maps.front().log10_p > -2;
}

/// What an operator can do about a residual that no effect of the library stands for.
std::string next_step_text(const std::vector<criticism::tests::MapScore>& maps, bool recording) {
  if (follows_nothing(maps))
    return "What to do next: measure a second run with the poses in another order and record what may switch "
           "or change between poses (supplies, motors, temperatures); nothing that was recorded orders this "
           "residual.";
  const criticism::tests::MapScore& m = maps.front();
  struct Example {
    std::string formula, options;
  };
  const std::string there = "--scale " + m.where;
  const std::map<std::string, Example> examples{
      {"time", {"sin(2*_pi*t_h/0.5)", there}},
      {"azimuth", {"cosd(3*azimuth_deg)", there}},
      {"temperature", {"max(0, T_degC-24)", there}},
      {"own reading", {"(u/50000)^4", there}},
      {"own reading x time", {"u*sin(2*_pi*t_h/0.5)", there}},
      {"own reading x temperature", {"u*max(0, T_degC-24)", there}},
      {"direction", {"ux*uy/50000^2", there}},
      {"previous pose", {"exp(-since_stop_s/20)", there}},
      {"site field", {"sin(2*_pi*t_h/0.5)", "--level site"}},
      {"site gradient", {"sin(2*_pi*t_h/0.5)", "--level gradient"}},
      {"site map", {"px*pz", "--level site"}},
  };
  // The table never stops in a recording, so no column tells how long ago.
  if (recording && m.map == "previous pose")
    return "What to do next: turn more slowly, or log faster: the residual follows the sample before, as it "
           "does where a filter or a delay stands between the sensor and the file.";
  const auto known = examples.find(m.map);
  const Example example = known == examples.end() ? Example{m.map, there} : known->second;
  return fmt::format(
      "What to do next: mgt discover RUN looks for the formula of a law that is in no library; mgt report "
      "draws this residual; a law of your own: mgt define RUN my.law '{}' {}, then mgt explain "
      "again.",
      example.formula, example.options);
}

/// What is left and what to do about it. Maps beside effects that only describe a law of no library show
/// nothing of that law.
std::string rest_text(const criticism::search::ExplainReport& r,
                      const std::vector<criticism::tests::MapScore>& maps, bool recording) {
  if (r.formulas_account)
    return r.named.empty() ? "A formula accounts for it." : "A formula accounts for the rest.";
  const bool described = std::any_of(r.notes.begin(), r.notes.end(), [](const auto& note) {
    return std::holds_alternative<criticism::search::LawOfNoLibrary>(note);
  });
  if (described && follows_nothing(maps))
    return "What to do next: mgt discover RUN looks for the formula of a law that is in no library; mgt "
           "report "
           "draws this residual.";
  std::string out = left_text(maps);
  if (!out.empty()) out += " ";
  return out + next_step_text(maps, recording);
}

std::string outliers_text(const std::vector<fit::OutlierNode>& outliers) {
  if (outliers.empty()) return {};
  std::set<int> numbers;
  for (const fit::OutlierNode& o : outliers) numbers.insert(o.pose);
  return fmt::format(
      "{} that the others contradict {} left out, in pose {} (listed at the end).",
      outliers.size() == 1 ? "One observation" : fmt::format("{} observations", outliers.size()),
      outliers.size() == 1 ? "is" : "are", pose_numbers_text(numbers));
}

/// Names that a law of no library takes the place of.
std::string stand_ins_text(const criticism::search::ExplainReport& r) {
  const bool one = r.stand_ins.size() == 1;
  return fmt::format("{} {} not named: formulas account for everything without {}.",
                     fmt::join(r.stand_ins, ", "), one ? "is" : "are", one ? "it" : "them");
}

}  // namespace

std::string detectable_text(const criticism::tests::Detectable& d) {
  if (!(d.value < criticism::tests::kAtNoSize)) return "at no size: what is in the model takes it up";
  return fmt::format("{:.3g} {} ({})", d.value, d.unit, d.where);
}

std::string as_sentence(std::string clause) {
  if (clause.empty()) return clause;
  const std::string_view first = std::string_view(clause).substr(0, clause.find(' '));
  if (first.find_first_of(".0123456789") == std::string_view::npos)
    clause.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(clause.front())));
  return clause + ".";
}

std::string_view share_of(const criticism::search::ExplainReport& r) {
  if (r.noise.reference.from_dwells()) return "chi-square beyond the noise";
  return r.rounds.empty() ? "nothing, because the noise is not known and nothing was added"
                          : "chi-square beyond what is left after the last round";
}

std::string sentence(const criticism::search::ExplainReport& r) {
  const std::string lesser_part = lesser_part_text(r);
  std::vector<std::string> parts{noise_text(r), outliers_text(r.outliers), lesser_part};
  const fit::joint::JointFit* before = r.fit.get();
  const bool recording = before != nullptr && fit::joint::is_recording(before->problem);
  for (const criticism::search::Round& round : r.rounds) {
    parts.push_back(round_text(round, before));
    if (is_named(round, r) && (lesser_part.empty() || !round.possible.empty()))
      parts.push_back(alternatives_text(round));
    before = round.fit.get();
  }
  if (!r.stand_ins.empty()) parts.push_back(stand_ins_text(r));
  switch (r.finding) {
    case criticism::search::Finding::pass:
      parts.emplace_back(
          "Nothing stands out beyond chance. That excludes only effects above the sizes listed, and nothing "
          "of "
          "what cannot be tested.");
      break;
    case criticism::search::Finding::unknown:
      if (!r.stand_ins.empty()) break;
      parts.emplace_back("Something is there, and no effect of the library looks like it.");
      parts.push_back(rest_text(r, r.maps, recording));
      break;
    case criticism::search::Finding::partial:
      if (!r.stand_ins.empty() || r.left == criticism::search::Finding::pass) break;
      parts.push_back(rest_text(r, r.maps_left, recording));
      break;
    case criticism::search::Finding::ambiguous:
      if (!r.next.empty()) {
        const design::NextMeasurement& n = r.next.front();
        parts.push_back(
            fmt::format("To settle it: {}, {:.0f} minutes; the right name then wins with probability {:.3f} "
                        "instead of {:.2f}.",
                        n.action, n.minutes, n.p_right_after, n.p_right_before));
      }
      break;
    case criticism::search::Finding::explained:
      parts.emplace_back("Nothing else stands out after that. The name is a hypothesis about the cause.");
      parts.push_back(commands_text(r));
      break;
    default:
      break;
  }
  std::vector<criticism::search::ExplainNote> notes = r.notes;
  if (r.formulas_account || !r.stand_ins.empty())  // nothing is left that could be a memory
    std::erase_if(notes, [](const auto& note) {
      return std::holds_alternative<criticism::search::TablePathUnknown>(note);
    });
  for (const std::string& note : note_texts(notes)) {
    // A user's formula has any name.
    const bool named =
        std::any_of(r.candidates.begin(), r.candidates.end(),
                    [&](const criticism::tests::Candidate& c) { return note.starts_with(c.effect + " "); });
    parts.push_back(named ? note + "." : as_sentence(note));
  }
  std::erase(parts, "");
  return fmt::format("{}", fmt::join(parts, " "));
}

std::string names_text(const criticism::search::ExplainReport& r) {
  if (r.finding != criticism::search::Finding::ambiguous) return fmt::format("{}", fmt::join(r.named, ", "));
  std::vector<std::string> places, sure;
  for (const criticism::search::Round& round : r.rounds) {
    std::string place = round.added.effect;
    for (const std::string& other : round.possible) place += " or " + other;
    std::vector<std::string>& among = round.possible.empty() ? sure : places;
    if (std::find(among.begin(), among.end(), place) == among.end()) among.push_back(std::move(place));
  }
  std::erase_if(sure, [&](const std::string& name) {
    return std::any_of(places.begin(), places.end(),
                       [&](const std::string& place) { return place.starts_with(name + " or "); });
  });
  if (!sure.empty()) places.insert(places.begin(), fmt::format("{}", fmt::join(sure, ", ")));
  return fmt::format("{}", fmt::join(places, "; "));
}

}  // namespace mgtd::calib::report
