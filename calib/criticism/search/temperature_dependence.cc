// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/temperature_dependence.h"

#include <algorithm>

namespace mgtd::calib::criticism::search {

std::optional<std::string> temperature_dependence(std::string effect) {
  if (effect.ends_with(".temperature2")) effect.pop_back();
  if (!effect.ends_with(".temperature")) return std::nullopt;
  return effect;
}

bool added_term_of_dependence(const std::vector<Round>& rounds, const std::string& effect, double sigmas) {
  const auto dependence = temperature_dependence(effect);
  return dependence && std::any_of(rounds.begin(), rounds.end(), [&](const Round& round) {
           return round.added.d >= sigmas && temperature_dependence(round.added.effect) == dependence;
         });
}

}  // namespace mgtd::calib::criticism::search
