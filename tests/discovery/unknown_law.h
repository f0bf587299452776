// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "tests/blind/hidden_run.h"
#include "tests/discovery/weather.h"

/// Laws that stand in no library, written without the code that looks for them.
namespace mgtd::calib::testing {

/// The axis that laws act on: z of sensor s3.
inline constexpr std::size_t kLawSensor = 2;
inline constexpr int kLawAxis = 2;

/// What one axis of one sensor reads more, for a size of one. `v_nT` is the field in the sensor's axes.
using AxisLaw = std::function<double(const Pose& pose, const Eigen::Vector3d& v_nT)>;

struct UnknownLaw {
  std::string name;
  std::string truth;      ///< regular expression that the right formula matches, on s3.z
  std::string covariate;  ///< "s3_T_degC", ...
  /// A law with numbers drawn anew.
  std::function<AxisLaw(std::mt19937_64& rng, const WeatherPtr& weather)> draw;
};

/// Fourteen laws that a grammar may hold, no two alike; and some more of the same kinds.
[[nodiscard]] const std::vector<UnknownLaw>& unknown_laws();
[[nodiscard]] const std::vector<UnknownLaw>& further_laws();
/// Those that nothing recorded goes with, or that are more than a formula: no law may be named.
[[nodiscard]] const std::vector<UnknownLaw>& lawless();

/// A run of hidden_run.h with temperatures, a motor current and a battery beside it. Unseen poses have no
/// noise.
struct RecordedRun {
  PoseTable table;
  WeatherPtr weather;
};
[[nodiscard]] RecordedRun recorded_run(const HiddenRun& run, Course course, std::uint64_t seed);

/// The law at every pose of a run.
[[nodiscard]] Eigen::VectorXd values_of(const AxisLaw& law, const PoseTable& table);
void add(const Eigen::VectorXd& values_nT, PoseTable& table);

}  // namespace mgtd::calib::testing
