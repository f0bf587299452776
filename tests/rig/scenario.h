// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "tests/rig/effect.h"
#include "tests/rig/truth.h"

/// What a simulated rig is and what happens on it. Written in TOML; `mgt-rig --help` and tests/scenarios show
/// how.
namespace mgtd::rig {

enum class NoiseKind { gaussian, uniform };

struct TemperatureScript {
  double start_degC{20};
  double ramp_degC_per_h{0};
  std::array<double, 4> head_degC{};  ///< each head's own difference
};

struct TimedFault {
  double at_s{0};
  std::string text;  ///< as on the control line: "unplug fluxgate2 for 3"
};

struct Scenario {
  std::string name{"clean"};
  std::string rig{"table6"};
  RigTruth truth;
  std::uint64_t seed{1};
  double baseline_m{0.4};
  double f_nT{53'907.7}, inclination_deg{60}, declination_deg{-5};
  double field_drift_nT_per_h{0};  ///< of the magnitude
  NoiseKind noise{NoiseKind::gaussian};
  double noise_nT{0.3};  ///< sd of one sample, or half width when uniform
  TemperatureScript temperature;
  double table_accuracy_deg{0.1};
  double table_velocity_deg_per_s{20}, table_acceleration_deg_per_s2{40};
  double tilt_limit_deg{180};  ///< travel of pitch and roll
  double scalar_noise_nT{0.02};
  bool scalar{true};
  double rate_hz{50};
  double range_V{10};
  double uT_full_scale{100};  ///< of the sensors, for range_V
  bool palmacq{true};
  bool common_trigger{false};
  double oscillator_ppm{20};  ///< free-running devices differ by up to this
  std::vector<std::shared_ptr<Effect>> effects;
  std::vector<TimedFault> faults;
};

/// Errors are all reported at once, "file:line: ...".
[[nodiscard]] tl::expected<Scenario, std::vector<std::string>> parse_scenario(std::string_view text,
                                                                              std::string_view file);

/// The truth as JSON: parameters under the paper's names, effects, site.
[[nodiscard]] nlohmann::json truth_json(const Scenario& scenario);

}  // namespace mgtd::rig
