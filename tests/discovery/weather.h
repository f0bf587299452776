// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <cstdint>
#include <memory>

/// A Weather holds the temperatures of the heads in a run, as they are: the run records them with a scatter
/// of 0.01 degrees.
namespace mgtd::calib::testing {

class Weather {
 public:
  virtual ~Weather() = default;
  /// Of a head at a time.
  [[nodiscard]] virtual double T_degC(std::size_t sensor, double t_s) const = 0;
  /// Its change, degC/h.
  [[nodiscard]] virtual double rate_degC_per_h(std::size_t sensor, double t_s) const = 0;
  /// What follows it with a time constant and began in equilibrium.
  [[nodiscard]] virtual double lagging_T_degC(std::size_t sensor, double t_s, double tau_s) const = 0;
};
using WeatherPtr = std::shared_ptr<const Weather>;

enum class Course {
  swing,  ///< up and down by three degrees on one smooth curve; each head runs ahead of the one before it
  rise,   ///< a room that warms up once by six degrees, with doors and sun; each head follows at its own pace
};
/// Of a run that takes so long; the seed draws what is left to chance.
[[nodiscard]] WeatherPtr weather(Course course, double length_s, std::uint64_t seed);

}  // namespace mgtd::calib::testing
