// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/possible_exchanges.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace mgtd::calib::criticism::tests {

std::vector<PerSensor<std::size_t>> possible_exchanges(std::size_t sensors) {
  constexpr std::size_t kAllPermutations = 4;  // of five there are 119: some would fit by chance
  PerSensor<std::size_t> own(sensors);
  std::iota(own.begin(), own.end(), std::size_t{0});
  std::vector<PerSensor<std::size_t>> out;
  if (sensors <= kAllPermutations) {
    for (PerSensor<std::size_t> order = own; std::next_permutation(order.begin(), order.end());)
      out.push_back(order);
    return out;
  }
  for (std::size_t i = 0; i < sensors; ++i) {
    for (std::size_t j = i + 1; j < sensors; ++j) {
      out.push_back(own);
      std::swap(out.back()[i], out.back()[j]);
    }
  }
  return out;
}

}  // namespace mgtd::calib::criticism::tests
