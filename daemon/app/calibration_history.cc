// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/calibration_history.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <vector>

namespace mgtd::daemon::app {
namespace {

/// Of all moves of one answer together: half a megabyte of JSON, and a figure that can still be looked at.
constexpr std::size_t kMostParameters = 1'200;

std::string start_or(const std::string& t_utc, WallTime proposed) {
  return parse_utc(t_utc) ? t_utc : format_utc(proposed);
}

}  // namespace

std::size_t CalibrationHistory::sensors_of(const std::string& id) {
  const auto known = sensors_.find(id);
  if (known != sensors_.end()) return known->second;
  const auto calibration = store_.show(id);
  return sensors_[id] = calibration ? calibration->sensors.size() : 0;
}

const calib::report::ParameterMoves* CalibrationHistory::between(const std::string& from,
                                                                 const std::string& to) {
  const auto known = moves_.find({from, to});
  if (known != moves_.end()) return &known->second;
  const auto a = store_.show(from), b = store_.show(to);
  if (!a || !b) return nullptr;
  return &moves_.emplace(std::pair(from, to), calib::report::moves_between(*a, *b)).first->second;
}

nlohmann::ordered_json CalibrationHistory::report() {
  nlohmann::ordered_json decisions = nlohmann::ordered_json::array(), told = decisions,
                         unreadable = decisions;
  for (const store::CalibrationDecision& d : store_.decisions())
    decisions.push_back({{"t", format_utc(d.at)},
                         {"event", d.what},
                         {"id", d.id},
                         {"origin", d.origin},
                         {"forced", d.forced},
                         {"why", d.why},
                         {"by", d.by}});
  std::map<std::string, WallTime> proposed;
  for (const store::CalibrationDecision& d : store_.decisions())
    if (d.what == "proposed") proposed.emplace(d.id, d.at);
  // From the newest back, so that what no answer holds is never compared.
  const auto entries = store_.list();
  std::vector<std::string> chain;
  std::size_t sensors = 0;
  for (auto entry = entries.rbegin(); entry != entries.rend(); ++entry) {
    if (entry->state == store::CalibrationState::rejected) continue;
    const std::size_t own = sensors_of(entry->id);
    if (own == 0) unreadable.push_back(entry->id);
    if (sensors == 0) sensors = own;
    if (own == 0 || own != sensors) continue;
    chain.push_back(entry->id);
    if (chain.size() * sensors * calib::sensor::kSensorParameters > kMostParameters) break;
  }
  std::vector<calib::report::ParameterMoves> moves;
  for (std::size_t i = chain.size(); i-- > 1;) {
    const calib::report::ParameterMoves* const found = between(chain[i], chain[i - 1]);
    if (found == nullptr) continue;
    moves.push_back(*found);
    moves.back().t_utc = start_or(found->t_utc, proposed[found->to]);
    told.push_back(nlohmann::ordered_json(calib::report::to_json(moves.back())));
  }
  const auto figure = calib::report::history_of(moves);
  return {{"decisions", std::move(decisions)},
          {"moves", std::move(told)},
          {"figure", figure ? nlohmann::ordered_json(calib::report::to_json(*figure)) : nullptr},
          {"unreadable", std::move(unreadable)}};
}

}  // namespace mgtd::daemon::app
