// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calib/criticism/tests/noise.h"
#include "calib/criticism/tests/residual_maps.h"
#include "calib/fit/joint/joint_fit.h"
#include "calib/fit/method_choice/fit.h"

/// A Comparison says how model and measurement agree: how large the noise is, whether the model fits within
/// it, and where it fails. It names no cause; explain.h does.
namespace mgtd::calib::criticism::tests {

/// Means of a residual over equally filled bins of a covariate, against what chance makes of them.
struct Dependence {
  std::string covariate{}, component{};  ///< the component of the channel that depends most
  double log10_p{0};                     ///< analysis of variance between the bins, components counted
  std::vector<double> means{};           ///< of that component, in the order of the covariate
  std::vector<double> ses{};      ///< their standard errors by the scatter within the bin; NaN of one pose
  std::vector<double> centers{};  ///< means of the covariate over the same bins
  double from{0}, to{0};          ///< of the covariate
};

/// One way of looking at the residual.
///     whitened      readings less prediction over their noise, channel by channel
///     scalar        |b_i| less the field of the pose, by sensor, nT: blind to every error of angles
///     attitude      what the table angles had to be corrected by, deg: blind to the sensors
///     inter-sensor  b_i less the mean of all, nT: blind to attitude and to changes of the field
///     closure       curl over the baseline and differences of the two centres, nT: zero for any gradient;
///                   of another array than the cross its closure combinations
struct ResidualChannel {
  std::string name{}, unit{};
  std::string meaning{};  ///< for a person
  double rms{0};
  std::vector<Dependence> against{};  ///< strongest first
};

struct Comparison {
  NoiseModel noise;
  double noise_nT{0};     ///< of a pose mean
  double residual_nT{0};  ///< as PoseResiduals tells it
  calibration::AxisNoise axis_noise_nT{
      calibration::AxisNoise::Zero(kSensors, 3)};  ///< of a pose mean as it was weighted
  calibration::AxisNoise axis_residual_nT{
      calibration::AxisNoise::Zero(kSensors, 3)};  ///< rms of what is left, freedom accounted for
  double chi2{0}, dof{0};  ///< of readings, scalar reference and table angles together
  /// Probability that the noise alone makes so large a residual; empty where the noise is not known.
  std::optional<double> log10_p{};
  double table_sd_deg{0};
  std::vector<ResidualChannel> channels{};
  /// Covariates that order the poses as another one does, by name, with that one; only that one is shown.
  std::vector<std::pair<std::string, std::string>> alike{};
  std::vector<MapScore> maps{};
  std::vector<fit::OutlierNode> outliers{};
  /// What was compared; points into the pose table.
  std::shared_ptr<const fit::joint::JointFit> fit{};
  bool fits{true};  ///< no map and no size stands out: one clean run in three hundred fails
};

[[nodiscard]] Result<Comparison> compare(const PoseTable& table, const fit::FitOptions& options);

}  // namespace mgtd::calib::criticism::tests
