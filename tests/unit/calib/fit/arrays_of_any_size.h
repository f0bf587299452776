// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>
#include <string>
#include <vector>

#include "calib/sensor/geometry.h"
#include "calib/sensor/sensor_model.h"
#include "proto/units.h"
#include "tests/rig/recording.h"
#include "tests/rig/scenario.h"
#include "tests/rig/simulated_table.h"

/// Arrays of one to eight sensors, simulated by the rig.
namespace mgtd::calib::testing {

using Places = std::vector<Eigen::Vector3d>;

inline Places one_sensor() { return {{0, 0, 0}}; }
inline Places two_along_x() { return {{0.25, 0, 0}, {-0.25, 0, 0}}; }
inline Places cross_of_four() { return {{0.2, 0, 0}, {0, 0.2, 0}, {-0.2, 0, 0}, {0, -0.2, 0}}; }
inline Places tetrahedron() {
  constexpr double h = 0.15;
  return {{h, h, h}, {h, -h, -h}, {-h, h, -h}, {-h, -h, h}};
}
inline Places cube_of_eight() {
  Places out;
  for (const double x : {-0.2, 0.2})
    for (const double y : {-0.2, 0.2})
      for (const double z : {-0.2, 0.2}) out.emplace_back(x, y, z);
  return out;
}

inline sensor::Geometry geometry_of(const Places& places) {
  PerSensor<Eigen::Vector3d> places_P_m(0);
  places_P_m.assign(places.begin(), places.end());
  return sensor::Geometry(places_P_m);
}

/// "random" sensors at these places; `more` is scenario text.
inline rig::Scenario scenario_of(const Places& places, std::uint64_t seed, const std::string& more = "") {
  std::vector<std::string> rows;
  for (const Eigen::Vector3d& r : places) rows.push_back(fmt::format("[{}, {}, {}]", r[0], r[1], r[2]));
  const std::string text =
      fmt::format("[rig]\nparameters = \"random\"\nseed = {}\n[array]\npositions_m = [{}]\n{}", seed,
                  fmt::join(rows, ", "), more);
  auto scenario = rig::parse_scenario(text, "array.toml");
  if (!scenario) throw std::runtime_error(fmt::format("{}", fmt::join(scenario.error(), "; ")));
  return *std::move(scenario);
}

inline PoseTable turned_run(const Places& places, std::uint64_t seed, const std::string& more = "") {
  return rig::simulated_table(scenario_of(places, seed, more), rig::run_of_157({}, seed), seed);
}

/// Single samples of one sensor; motion is "hand" or "flight", ar the correlation of neighbouring samples.
inline PoseTable recorded(const std::string& motion, double ar, std::uint64_t seed,
                          const std::string& more = "") {
  return rig::pose_table_of(rig::simulated_recording(
      scenario_of(one_sensor(), seed,
                  fmt::format("[recording]\nmotion = \"{}\"\nrate_hz = 20\nduration_s = 150\nar = {}\n{}",
                              motion, ar, more))));
}

}  // namespace mgtd::calib::testing
