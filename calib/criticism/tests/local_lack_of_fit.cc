// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/local_lack_of_fit.h"

#include <algorithm>
#include <vector>

#include "calib/effects/where.h"

namespace mgtd::calib::criticism::tests {
namespace {

std::vector<std::size_t> channels_of(const std::string& where) {
  const auto parsed = effects::Where::parse(where);
  if (!parsed || parsed->sensor < 0) return {};
  const auto first = static_cast<std::size_t>(3 * parsed->sensor);
  if (parsed->axis >= 0) return {first + static_cast<std::size_t>(parsed->axis)};
  return {first, first + 1, first + 2};
}

/// Values of the searched number that count as different.
double values_of(const ScoredFamily& family) {
  double scales = 0;
  for (const Hypothesis& h : family.candidate_effect->hypotheses) scales += 1.0 / h.alike;
  return std::max(1.0, family.asked / scales);
}

/// The smallest p of any effect on one channel, times the questions that were asked there.
double of_effects(const Criticism& c, const std::string& channel) {
  double smallest = 0, asked = 0;
  for (const ScoredFamily& family : c.families) {
    bool any = false;
    for (const Score& score : family.scores) {
      const Hypothesis& h = family.candidate_effect->hypotheses[score.hypothesis];
      if (h.axes != 1 || h.where != channel) continue;
      smallest = std::min(smallest, score.log10_p);
      any = true;
    }
    if (any) asked += values_of(family);
  }
  return asked > 0 ? best_of(smallest, asked) : 0;
}

double of_maps(const Criticism& c, std::size_t channel) {
  double smallest = 0, asked = 0;
  for (const MapScore& map : c.maps) {
    smallest = std::min(smallest, map.by_channel.at(channel));
    asked += map.by_channel.at(channel) < 0 ? 1 : 0;
  }
  return asked > 0 ? best_of(smallest, asked) : 0;
}

}  // namespace

double local_lack_of_fit_log10_p(const Criticism& c, const std::string& where) {
  const auto channels = channels_of(where);
  double smallest = 0;
  for (const std::size_t channel : channels)
    smallest = std::min(
        {smallest,
         of_effects(c, effects::axis_name(static_cast<int>(channel) / 3, static_cast<int>(channel) % 3)),
         of_maps(c, channel)});
  return channels.empty() ? 0 : best_of(smallest, 2.0 * static_cast<double>(channels.size()));
}

}  // namespace mgtd::calib::criticism::tests
