// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proto/per_sensor.h"

/// An ArrayDescription says where the sensors of a rig stand and what their readings can tell; HELLO and
/// STATUS carry it.
///
///   {"sensors":4,"positions_m":[[0.2,0,0],...],"gradient":["xx","yy","zz","xy","xz","yz"],
///    "line":null,"closure":4,"closure_limit":18.467,"tells":"field and all five ..."}
namespace mgtd {

struct ArrayDescription {
  PerSensor<Eigen::Vector3d> positions_P_m;
  std::vector<std::string_view> gradient;  ///< components that are determined; the others are null in TENSOR
  std::optional<Eigen::Vector3d> line;     ///< direction u of sensors on one line; TENSOR has dB/du
  int closure{0};                          ///< how many closure numbers check every sample
  /// chi2 of the closure of a good sample exceeds it once in a thousand; empty without closure numbers.
  std::optional<double> closure_limit{};
  std::string tells;  ///< in words
};

[[nodiscard]] nlohmann::ordered_json to_json(const ArrayDescription& array);

}  // namespace mgtd
