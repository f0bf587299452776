// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <tl/expected.hpp>
#include <vector>

#include "tests/rig/cage.h"
#include "tests/rig/covariate.h"
#include "tests/rig/dropped_magnet.h"
#include "tests/rig/effect.h"
#include "tests/rig/gross_reading.h"
#include "tests/rig/motion.h"
#include "tests/rig/noise.h"
#include "tests/rig/truth.h"
#include "tests/rig/vector_reference.h"
#include "tests/rig/vehicle.h"

/// A Scenario says what a simulated rig is and what happens on it. It is written in TOML; `mgt-rig --help`
/// and tests/scenarios show how.
namespace mgtd::rig {

struct TemperatureScript {
  double start_degC{20};
  double ramp_degC_per_h{0};
  std::vector<double> head_degC{};  ///< each head's own difference; none: no difference
  double pulse_degC{0};             ///< peak of one warm spell (hands, sun), p s/tau exp(1 - s/tau) ...
  double pulse_at_s{0};             ///< ... begun here
  double pulse_tau_s{300};
  std::uint64_t pulse_head{0};  ///< from 1 on; 0: all of them
};

struct TimedFault {
  double at_s{0};
  std::string text;  ///< as on the control line: "unplug fluxgate2 for 3"
};

struct Scenario {
  std::string name{"clean"};
  std::string rig{"table6"};
  RigTruth truth = RigTruth(kCross);  ///< one for each sensor of the array
  std::uint64_t seed{1};
  double baseline_m{0.4};  ///< of the cross
  /// Where each sensor is, platform frame; empty: the cross, s1 at +X, s2 at +Y, s3 at -X, s4 at -Y.
  std::vector<Eigen::Vector3d> positions_m;

  double f_nT{53'907.7}, inclination_deg{60}, declination_deg{-5};
  double field_drift_nT_per_h{0};  ///< of the magnitude
  double diurnal_nT{0};            ///< amplitude of a sine of the magnitude, ...
  double diurnal_period_h{24};

  SampleNoise noise;
  VisitNoise visit;
  /// Whose readings come out of which connector: {2, 1, 3, 4} are two swapped sensors. Empty: each its own.
  std::vector<int> wiring;
  /// Whose plug is in which port: {1, 4, 3, 2} are two exchanged plugs, with all that is behind them.
  std::vector<int> plugs;
  bool tells_serial{true};  ///< an old firmware of the digitisers does not
  /// Every connector carries the readings of this sensor, counted from 1; 0: each its own.
  std::uint64_t copied{0};
  /// Each sensor was turned by itself: row by row they did not share their attitudes. Of a table.
  bool apart{false};
  TemperatureScript temperature;
  double rate_hz{50};         ///< when nobody commands one
  double range_V{10};         ///< the digitiser's range, for the printed configuration
  double uT_full_scale{100};  ///< of the sensors, for their 10 V
  bool palmacq{true};
  bool common_trigger{false};
  bool autostart{false};                   ///< already streaming when the host opens the port
  double oscillator_ppm{20};               ///< free-running devices differ by up to this
  std::vector<double> rate_error_percent;  ///< of each digitiser's rate: -1 is slow; none: 0
  /// Each port delivers when a timer of this period ticks; 0, or none given: at once.
  std::vector<double> delivery_s;
  std::vector<double> delivery_ppm;  ///< by which the timer is slow: the beat with the samples

  double table_accuracy_deg{0.1};
  double table_velocity_deg_per_s{20}, table_acceleration_deg_per_s2{40};
  /// "mount": it has one axis, and the array is mounted by hand; "table": no motors.
  std::string hands{"none"};
  double tilt_limit_deg{180};  ///< travel of pitch and roll

  bool scalar{true};
  double scalar_noise_nT{0.02};
  double scalar_period_s{1};
  std::uint64_t scalar_bad_every{0};  ///< every so many readings one has a poor quality; 0: none

  bool angles{true};  ///< the pose table tells those of the table
  std::optional<VectorReference> reference;
  std::optional<Cage> cage;
  std::optional<Recording> recording;  ///< in the place of a table

  std::vector<Covariate> covariates;
  std::vector<std::shared_ptr<const Effect>> effects;
  std::vector<TimedFault> faults;  ///< in the order of their times
  std::vector<Vehicle> vehicles;
  std::vector<DroppedMagnet> magnets;
  std::vector<GrossReading> gross;

  [[nodiscard]] std::size_t sensors() const { return truth.size(); }
  [[nodiscard]] bool is_cross() const { return positions_m.empty(); }
  /// Where the sensors are, platform frame.
  [[nodiscard]] std::vector<Eigen::Vector3d> places_m() const;
  /// Something outside of this sphere is outside of the array.
  [[nodiscard]] double reach_m() const;
  /// Of the field when the run begins, site frame.
  [[nodiscard]] Eigen::Vector3d field_direction() const;
};

/// The i-th of a list with one value for each sensor; 0 where the list ends before it.
[[nodiscard]] inline double of_sensor(const std::vector<double>& list, std::size_t i) {
  return i < list.size() ? list[i] : 0;
}
/// The i-th of a list of sensors, counted from 1; its own number where the list ends before it.
[[nodiscard]] inline int of_sensor(const std::vector<int>& list, std::size_t i) {
  return i < list.size() ? list[i] : static_cast<int>(i) + 1;
}

/// Errors are all reported at once, "file:line: ...".
[[nodiscard]] tl::expected<Scenario, std::vector<std::string>> parse_scenario(std::string_view text,
                                                                              std::string_view file);

/// The truth as JSON: parameters under the paper's names, mountings, effects, site.
[[nodiscard]] nlohmann::json truth_json(const Scenario& scenario);

}  // namespace mgtd::rig
