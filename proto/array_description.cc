// SPDX-License-Identifier: Apache-2.0
#include "proto/array_description.h"

#include <nlohmann/json.hpp>

namespace mgtd {

nlohmann::ordered_json to_json(const ArrayDescription& array) {
  auto positions = nlohmann::ordered_json::array();
  for (const Eigen::Vector3d& r_m : array.positions_P_m) positions.push_back({r_m.x(), r_m.y(), r_m.z()});
  return {{"sensors", array.positions_P_m.size()},
          {"positions_m", std::move(positions)},
          {"gradient", array.gradient},
          {"line", array.line ? nlohmann::ordered_json{array.line->x(), array.line->y(), array.line->z()}
                              : nlohmann::ordered_json()},
          {"closure", array.closure},
          {"closure_limit",
           array.closure_limit ? nlohmann::ordered_json(*array.closure_limit) : nlohmann::ordered_json()},
          {"tells", array.tells}};
}

}  // namespace mgtd
