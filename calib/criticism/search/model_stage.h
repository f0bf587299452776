// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>

#include "calib/fit/joint/joint_errors.h"
#include "calib/fit/joint/joint_fit.h"
#include "calib/fit/method_choice/fit.h"

/// A ModelStage is one model of a run with its fit and its tests, so that two models can be compared.
namespace mgtd::calib::criticism::search {

struct ModelStage {
  fit::joint::JointOptions options;  ///< with every number of its effects that had to be searched
  fit::joint::JointFit fit;          ///< points into the pose table
  fit::joint::JointErrors errors;
  std::optional<fit::joint::JointErrors> held_out{};  ///< folds contiguous in time
};

[[nodiscard]] Result<ModelStage> model_stage(const PoseTable& table, const fit::FitOptions& options);

/// The same poses with other effects, under the weights of `stage`: chi-squares of the two compare.
/// Nothing is searched, no observation is left out anew; the Birge ratio is that of `stage`, so that the
/// covariances compare too.
[[nodiscard]] Result<fit::joint::JointFit> fit_under_same_weights(
    const PoseTable& table, const ModelStage& stage, const std::vector<effects::EffectPtr>& effects);

/// What a wider model costs: the parameter of a sensor whose standard deviation grows most.
struct VariancePrice {
  double sd_ratio{1};       ///< of its standard deviation
  std::string parameter{};  ///< "s3.cx"
};
/// Compares two fits of the same poses, both with the weights of the wide one: the noise that is left with
/// the effect. The ratio is 1 where one of them has no covariance.
[[nodiscard]] VariancePrice variance_price(const fit::joint::JointFit& narrow,
                                           const fit::joint::JointFit& wide);

/// Largest rise of the error on held-out poses that may be chance: beyond it an effect is not added.
inline constexpr double kHeldOutVeto = 1.01;

}  // namespace mgtd::calib::criticism::search
