// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/take_back.h"

#include <set>
#include <string>

#include "calib/effects/where.h"
#include "calib/fit/joint/pose_residuals.h"

namespace mgtd::calib::criticism::search {
namespace {

/// What an axis, or each axis of a sensor, misfits becomes part of its noise.
void loosen(const fit::joint::JointFit& fit, const std::string& place, fit::joint::JointOptions& options) {
  const auto where = effects::Where::parse(place);
  if (!where) return;
  if (options.more_nT2.size() == 0) options.more_nT2 = fit::joint::Channels::Zero(fit.problem.channels());
  const calibration::AxisNoise ratio = fit::joint::pose_residuals(fit.problem, fit.state).noise_ratio;
  for (int axis = 0; axis < 3; ++axis) {
    if (!where->covers(where->sensor, axis)) continue;
    const double residual_nT = fit.pose_noise_nT(where->sensor, axis) * ratio(where->sensor, axis);
    options.more_nT2[3 * where->sensor + axis] += residual_nT * residual_nT;
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

}  // namespace mgtd::calib::criticism::search
