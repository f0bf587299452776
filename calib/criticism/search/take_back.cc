// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/take_back.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <variant>

#include "calib/effects/where.h"
#include "calib/fit/joint/pose_residuals.h"
#include "calib/linear/cholesky.h"
#include "calib/stats/chi_square.h"

namespace mgtd::calib::criticism::search {
namespace {

/// Noise of an axis that is closed to names, over what it misfits: effects on what is left could otherwise
/// follow a part of its law, and lower chi-square by up to one for each pose.
constexpr double kSaysNothing = 10;

/// Of the misfit: what names leave at most, where one of them acts on an axis that a law of no library acts
/// on too. The square of a neighbour's reading is the square of the own reading but for a twentieth.
constexpr double kLittle = 0.01;

/// Chance that a size of none is found as large, above which the fit does not find the effect.
const double kNotFound_log10 = std::log10(0.05);

/// log10 p of the coefficients that a round added, in the fit with them: they are its last.
double log10_p_of_fit(const Round& round) {
  Eigen::Index count = 0;
  for (const effects::EffectPtr& effect : round.effects)
    count += static_cast<Eigen::Index>(effect->coefficients().size());
  const auto covariance = linear::Cholesky::of(round.fit->covariance.bottomRightCorner(count, count));
  if (!covariance) return 0;
  const double square = covariance->squared_length(round.fit->state.coefficients.tail(count));
  return stats::chi_square_log10_p(square, static_cast<double>(count));
}

/// Whether the effects of two rounds act on an axis in common.
bool share_an_axis(const Round& a, const Round& b) {
  const std::set<std::string> axes = axes_of(a), others = axes_of(b);
  if (axes.empty() || others.empty()) return true;  // of a whole sensor, or of all
  return std::any_of(axes.begin(), axes.end(),
                     [&](const std::string& axis) { return others.contains(axis); });
}

/// What an axis, or each axis of a sensor, misfits becomes part of its noise, many times over.
void loosen(const fit::joint::JointFit& fit, const std::string& place, fit::joint::JointOptions& options) {
  const auto where = effects::Where::parse(place);
  if (!where) return;
  if (options.more_nT2.size() == 0) options.more_nT2 = fit::joint::Channels::Zero(fit.problem.channels());
  const calibration::AxisNoise ratio = fit::joint::pose_residuals(fit.problem, fit.state).noise_ratio;
  for (int axis = 0; axis < 3; ++axis) {
    if (!where->covers(where->sensor, axis)) continue;
    const double residual_nT =
        fit.pose_noise_nT(where->sensor, axis) * fit.noise_inflation * ratio(where->sensor, axis);
    options.more_nT2[3 * where->sensor + axis] += std::pow(kSaysNothing * residual_nT, 2);
  }
}

/// The axes that a law on `place` closes to names: those, and of a sensor with two such axes the third, since
/// what acts on two acts on the sensor.
std::set<std::string> closed_by(const std::string& place, const std::set<std::string>& closed) {
  std::set<std::string> out{place};
  const std::size_t dot = place.find('.');
  if (dot == std::string::npos) return out;
  const std::string sensor = place.substr(0, dot);
  std::set<std::string> open;
  for (const char* axis : {".x", ".y", ".z"})
    if (!closed.contains(sensor + axis) && sensor + axis != place) open.insert(sensor + axis);
  if (open.size() == 1) out.merge(open);
  return out;
}

}  // namespace

void take_back(const Surrogates& found, EffectSearch& search, ExplainReport& report) {
  const std::set<std::string> places = closed_by(found.where, search.unknown);
  search.unknown.insert(places.begin(), places.end());
  std::set<std::string> names;
  for (std::size_t i = found.first; i < report.rounds.size(); ++i)
    names.insert(report.rounds[i].added.effect);
  report.notes.emplace_back(LawOfNoLibrary{found.where, std::move(names)});
  search.joint.effects = found.first == 0 ? search.given : report.rounds[found.first - 1].model;
  report.rounds.resize(found.first);
  auto before = fit::joint::fit_joint_at_size(search.table, search.joint);
  if (!before) return;
  for (const std::string& place : places) loosen(*before, place, search.joint);
  const fit::joint::JointState warm_start = before->state;
  before = fit::joint::fit_joint_at_size(search.table, search.joint, &warm_start);
  if (!before) return;
  search.judge_anew(*before);
}

void take_back_beside_unknown_laws(const std::set<std::string>& closed, const tests::Criticism& last,
                                   ExplainReport& report) {
  if (report.rounds.empty()) return;
  const auto note = std::find_if(report.notes.rbegin(), report.notes.rend(), [](const ExplainNote& n) {
    return std::holds_alternative<LawOfNoLibrary>(n);
  });
  if (note == report.notes.rend()) return;
  const double left = share_left(report);
  auto first = report.rounds.end();
  if (last.rejects() && left > kMuch) {
    first = report.rounds.begin();
  } else if (left > kLittle) {
    first = std::find_if(report.rounds.begin(), report.rounds.end(), [&](const Round& round) {
      const std::set<std::string> axes = axes_of(round);
      return std::any_of(axes.begin(), axes.end(), [&](const std::string& a) { return closed.contains(a); });
    });
  }
  for (auto round = first; round != report.rounds.end(); ++round)
    std::get<LawOfNoLibrary>(*note).effects.insert(round->added.effect);
  report.rounds.erase(first, report.rounds.end());
  if (report.rounds.empty()) report.next.clear();
}

bool take_back_lost_in_wandering(const tests::NoiseModel& noise, ExplainReport& report) {
  bool any = false;
  while (noise.wandering.any() && !report.rounds.empty()) {
    const Round& last = report.rounds.back();
    const double log10_p = log10_p_of_fit(last);
    if (log10_p < kNotFound_log10) break;
    report.notes.emplace_back(LostInWandering{last.added.effect, last.added.where, last.added.d, log10_p});
    report.rounds.pop_back();
    any = true;
  }
  if (report.rounds.empty()) report.next.clear();
  return any && !report.noise.wandering.any();
}

std::size_t rounds_that_count(const ExplainReport& report, const tests::NoiseModel& last) {
  constexpr double kNearlyAll = 0.9;  // of the square that is beyond the noise
  constexpr double kSigmas = 8;       // from here on the right law of the library stands first, and alone
  const auto beyond = [&](double rms_nT) { return rms_nT * rms_nT - report.noise_nT * report.noise_nT; };
  std::size_t count = report.rounds.size();
  while (count > 0 && report.noise.known && !last.wandering.any()) {
    const Round& round = report.rounds[count - 1];
    if (!(round.fit->noise_inflation > 1) || round.added.d >= kSigmas ||
        beyond(round.rms_after_nT) < kNearlyAll * beyond(round.rms_before_nT))
      break;
    --count;
  }
  return count;
}

void take_back_what_took_little(EffectSearch& search, ExplainReport& report) {
  const std::size_t count = rounds_that_count(report, search.criticism.noise);
  if (count == report.rounds.size()) return;
  const Round* const open = report.open_round();
  if (open != nullptr && open >= &report.rounds[count]) report.next.clear();
  for (std::size_t i = count; i < report.rounds.size(); ++i) {
    const Round& round = report.rounds[i];
    report.notes.emplace_back(TookLittle{round.added.effect, round.added.where, round.added.d,
                                         round.rms_before_nT, round.rms_after_nT});
  }
  search.joint.effects = count == 0 ? search.given : report.rounds[count - 1].model;
  report.rounds.resize(count);
  if (count == 0) report.next.clear();
  if (const auto before = fit::joint::fit_joint_at_size(search.table, search.joint))
    search.judge_anew(*before);
}

void keep_names_found_again(ExplainReport& report) {
  for (ExplainNote& note : report.notes) {
    auto* const unknown = std::get_if<LawOfNoLibrary>(&note);
    if (unknown == nullptr) continue;
    for (const Round& round : report.rounds) unknown->effects.erase(round.added.effect);
  }
}

void close_alternatives_that_were_added(ExplainReport& report) {
  for (Round& round : report.rounds) {
    std::erase_if(round.possible, [&](const std::string& effect) {
      return std::any_of(report.rounds.begin(), report.rounds.end(), [&](const Round& other) {
        return &other != &round && other.added.effect == effect && share_an_axis(round, other);
      });
    });
  }
}

}  // namespace mgtd::calib::criticism::search
