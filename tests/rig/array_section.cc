// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/array_section.h"

#include <fmt/format.h>

namespace mgtd::rig {
namespace {

constexpr double kFarthest_m = 100, kNearest_m = 0.001;

}  // namespace

std::vector<Eigen::Vector3d> read_positions(Section& array) {
  std::vector<Eigen::Vector3d> out;
  if (!array.read_places("positions_m", out)) return {};
  if (out.empty() || out.size() > kMostPlaces) {
    array.complain("positions_m", fmt::format("positions_m has {} places; an array has 1 to {} sensors",
                                              out.size(), kMostPlaces));
    return {};
  }
  for (std::size_t i = 0; i < out.size(); ++i) {
    if (out[i].norm() > kFarthest_m)
      array.complain("positions_m", fmt::format("s{} is {} m from the centre; {} m is the most", i + 1,
                                                out[i].norm(), kFarthest_m));
    for (std::size_t j = 0; j < i; ++j) {
      if ((out[i] - out[j]).norm() < kNearest_m)
        array.complain("positions_m", fmt::format("s{} and s{} are less than {} m apart; no two sensors fit "
                                                  "in one place",
                                                  j + 1, i + 1, kNearest_m));
    }
  }
  return out;
}

}  // namespace mgtd::rig
