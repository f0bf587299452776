// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "tests/blind/hidden_run.h"

/// Laws that stand in no library, written without the code that looks for them.
namespace mgtd::calib::testing {

/// The axis that laws act on: z of sensor s3.
inline constexpr std::size_t kLawSensor = 2;
inline constexpr int kLawAxis = 2;

/// What one axis of one sensor reads more, for a size of one. `v_nT` is the field in the sensor's axes.
using AxisLaw = std::function<double(const Pose& pose, const Eigen::Vector3d& v_nT)>;

/// Temperatures of the heads in a run of that length: they warm up and cool down once.
struct Weather {
  double length_s{0};
  /// Of a head at a time, as it is; the run records it with a scatter of 0.01 degrees.
  [[nodiscard]] double T_degC(std::size_t sensor, double t_s) const;
  /// Its change, degC/h.
  [[nodiscard]] double rate_degC_per_h(std::size_t sensor, double t_s) const;
  /// What follows it with a time constant and began in equilibrium.
  [[nodiscard]] double lagging_T_degC(std::size_t sensor, double t_s, double tau_s) const;
};

struct UnknownLaw {
  std::string name;
  std::string truth;      ///< regular expression that the right formula matches, on s3.z
  std::string covariate;  ///< "s3_T_degC", ...
  /// A law with numbers drawn anew.
  std::function<AxisLaw(std::mt19937_64& rng, const Weather& weather)> draw;
};

/// Fourteen laws that a grammar may hold, no two alike; and some more of the same kinds.
[[nodiscard]] const std::vector<UnknownLaw>& unknown_laws();
[[nodiscard]] const std::vector<UnknownLaw>& further_laws();
/// Those that nothing recorded goes with, or that are more than a formula: no law may be named.
[[nodiscard]] const std::vector<UnknownLaw>& lawless();

/// A run of hidden_run.h with a motor current and a battery beside it. Unseen poses have no noise.
[[nodiscard]] PoseTable recorded_run(const HiddenRun& run, std::uint64_t seed);
[[nodiscard]] Weather weather_of(const PoseTable& table);

/// The law at every pose of a run.
[[nodiscard]] Eigen::VectorXd values_of(const AxisLaw& law, const PoseTable& table);
void add(const Eigen::VectorXd& values_nT, PoseTable& table);

}  // namespace mgtd::calib::testing
