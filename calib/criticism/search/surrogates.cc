// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/surrogates.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include "calib/criticism/search/temperature_dependence.h"
#include "calib/criticism/tests/candidate.h"
#include "calib/criticism/tests/local_lack_of_fit.h"
#include "calib/effects/effect_spec.h"
#include "calib/fit/joint/pose_residuals.h"

namespace mgtd::calib::criticism::search {
namespace {

constexpr std::size_t kAlways = 3, kWithRemainder = 2;
/// Of the excess of chi-square before it: an effect that leaves more is not what is there.
constexpr double kMost = 0.5;
/// Of all that is beyond the noise: an axis with less is not where the unknown law acts.
constexpr double kHere = 0.5;

/// Of the largest fall of chi-square on an axis: what takes less away tidies up after the law that is there.
constexpr double kPart = 0.01;

/// Of its standard deviations: a coefficient that says where an effect of all axes acts.
constexpr double kSeen = 5;

/// Rounds that put an effect on one axis, or on one sensor.
using Rounds = std::vector<std::size_t>;

double fall(const Round& round) { return round.chi2_before - round.chi2_after; }

/// Rounds that took away a part that counts.
Rounds parts(const ExplainReport& report, const Rounds& rounds) {
  double largest = 0;
  for (const std::size_t i : rounds) largest = std::max(largest, fall(report.rounds[i]));
  Rounds out;
  std::copy_if(rounds.begin(), rounds.end(), std::back_inserter(out),
               [&](std::size_t i) { return fall(report.rounds[i]) > kPart * largest; });
  return out;
}

std::size_t effects_in(const ExplainReport& report, const Rounds& rounds) {
  return parts(report, rounds).size();
}

/// The same, where linear and square term of one dependence on temperature count once. Beside any other
/// effect each counts: a slow law of no library follows the temperature and that effect together.
std::size_t dependences_in(const ExplainReport& report, const Rounds& rounds) {
  const Rounds there = parts(report, rounds);
  std::set<std::string> out;
  for (const std::size_t i : there) {
    const auto dependence = temperature_dependence(report.rounds[i].added.effect);
    if (!dependence) return there.size();
    out.insert(*dependence);
  }
  return out.size();
}

/// Axes on which what a round added is seen, put there or as one of many.
std::set<std::string> axes_seen_in(const Round& round) {
  std::set<std::string> out = axes_of(round);
  for (const calibration::EffectCoefficient& c : round.added.coefficients) {
    const auto where = effects::Where::parse(tests::place_of(c));
    if (where && where->scale == effects::Where::Scale::axis && std::abs(c.value) > kSeen * c.sd)
      out.insert(where->text());
  }
  return out;
}

/// Sensors on which what a round added is seen.
std::set<std::string> sensors_of(const Round& round) {
  std::set<std::string> out;
  for (const effects::EffectPtr& effect : round.effects) {
    const auto spec = effects::EffectSpec::parse(effect->spec());
    if (spec && spec->where && spec->where->sensor >= 0)
      out.insert(effects::sensor_name(spec->where->sensor));
  }
  for (const calibration::EffectCoefficient& c : round.added.coefficients) {
    const auto where = effects::Where::parse(c.name.substr(0, c.name.find('.')));
    if (where && where->scale == effects::Where::Scale::sensor && std::abs(c.value) > kSeen * c.sd)
      out.insert(where->text());
  }
  return out;
}

template <class Places>
std::map<std::string, Rounds> rounds_by_place(const ExplainReport& report, Places places) {
  std::map<std::string, Rounds> out;
  for (std::size_t i = 0; i < report.rounds.size(); ++i)
    for (const std::string& place : places(report.rounds[i])) out[place].push_back(i);
  return out;
}

/// Square of a residual that is beyond the noise, nT^2.
double beyond_noise(const ExplainReport& report, double rms_nT) {
  return std::max(0.0, rms_nT * rms_nT - report.noise_nT * report.noise_nT);
}

/// Whether a round left most of what was beyond the noise before it.
bool took_little(const ExplainReport& report, const Round& round) {
  return beyond_noise(report, round.rms_after_nT) > kMost * beyond_noise(report, round.rms_before_nT);
}

/// The surrogates on an axis: `there`, and before them the first effect, wherever it acts, that took little
/// away: what bends one axis bends the others through the field of the pose.
Surrogates on_axis(const ExplainReport& report, const std::string& axis, const Rounds& there) {
  for (std::size_t i = 0; i < there.front(); ++i)
    if (took_little(report, report.rounds[i])) return {axis, i};
  return {axis, there.front()};
}

/// The first round after which most of what is beyond the noise is still there.
std::optional<std::size_t> lesser_part(const ExplainReport& report) {
  if (!report.noise.known) return std::nullopt;
  const auto beyond = [&](double rms_nT) { return beyond_noise(report, rms_nT); };
  const double last = beyond(report.rounds.back().rms_after_nT);
  for (std::size_t i = 0; i < report.rounds.size(); ++i)
    if (last > kMost * beyond(report.rounds[i].rms_before_nT)) return i;
  return std::nullopt;
}

/// Of all that is beyond the noise, the share on one axis or sensor.
double share_on(const tests::Criticism& last, const std::string& place) {
  const auto where = effects::Where::parse(place);
  if (!where) return 0;
  const calibration::AxisNoise ratio =
      fit::joint::pose_residuals(last.tested->problem, last.tested->state).noise_ratio;
  const auto excess = (ratio.array().square() - 1).max(0).eval();
  const double here = where->axis >= 0 ? excess(where->sensor, where->axis) : excess.row(where->sensor).sum();
  return here / std::max(excess.sum(), 1e-300);
}

/// Whether what is left is left on this axis or sensor, where it is enough to tell.
bool left_here(const tests::Criticism& last, const std::string& place) {
  if (tests::local_lack_of_fit_log10_p(last, place) >= std::log10(tests::kLackOfFitAlarm)) return false;
  return !last.rejects_omnibus() || share_on(last, place) > kHere;
}

bool on_one_axis(const tests::Criticism& last, const std::string& sensor) {
  return share_on(last, sensor + ".x") > kHere || share_on(last, sensor + ".y") > kHere ||
         share_on(last, sensor + ".z") > kHere;
}

/// The one axis on which what is left shows; empty where it is not one.
std::string axis_left(const tests::Criticism& last) {
  if (!last.rejects_map()) return {};
  const auto where = effects::Where::parse(last.maps.front().where);
  return where && where->scale == effects::Where::Scale::axis ? where->text() : std::string{};
}

/// Surrogates on a whole sensor, the one with most of what is left; with `spread` only where no one axis of
/// it holds most of that.
Surrogates on_sensor(const ExplainReport& report, const tests::Criticism& last, bool spread) {
  if (!(share_left(report) > kMuch)) return {};
  Surrogates found;
  double most = 0;
  for (const auto& [sensor, there] : rounds_by_place(report, sensors_of)) {
    if (effects_in(report, there) < kWithRemainder || !left_here(last, sensor) ||
        (spread && on_one_axis(last, sensor)))
      continue;
    const double share = share_on(last, sensor);
    if (share > most) {
      most = share;
      found = {sensor, 0};
    }
  }
  return found;
}

}  // namespace

std::set<std::string> axes_of(const Round& round) {
  std::set<std::string> out;
  for (const effects::EffectPtr& effect : round.effects) {
    const auto spec = effects::EffectSpec::parse(effect->spec());
    if (spec && spec->where && spec->where->scale == effects::Where::Scale::axis)
      out.insert(spec->where->text());
  }
  return out;
}

double share_left(const ExplainReport& report) {
  if (!report.noise.known) return 0;
  return beyond_noise(report, report.rounds.back().rms_after_nT) /
         std::max(beyond_noise(report, report.rounds.front().rms_before_nT), 1e-300);
}

Surrogates find_surrogates(const ExplainReport& report, const tests::Criticism& last,
                           const std::set<std::string>& closed) {
  if (report.rounds.empty()) return {};
  if (auto found = on_sensor(report, last, true); found.any()) return found;
  for (const auto& [axis, there] : rounds_by_place(report, axes_of)) {
    const std::size_t effects = effects_in(report, there);
    const bool many = effects >= kAlways && (last.rejects() || dependences_in(report, there) >= kAlways);
    if (many || (effects >= kWithRemainder && left_here(last, axis))) return on_axis(report, axis, there);
  }
  for (const auto& [axis, there] : rounds_by_place(report, axes_seen_in)) {
    const bool little = std::all_of(there.begin(), there.end(),
                                    [&](std::size_t i) { return took_little(report, report.rounds[i]); });
    if (little && !closed.contains(axis) && effects_in(report, there) >= kWithRemainder &&
        left_here(last, axis))
      return on_axis(report, axis, there);
  }
  if (auto found = on_sensor(report, last, false); found.any()) return found;
  const std::string axis = axis_left(last);
  const auto first = axis.empty() || closed.contains(axis) ? std::nullopt : lesser_part(report);
  return first ? Surrogates{axis, *first} : Surrogates{};
}

}  // namespace mgtd::calib::criticism::search
