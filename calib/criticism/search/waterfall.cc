// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/waterfall.h"

#include <algorithm>
#include <cmath>

#include "calib/calibration/tensor.h"

namespace mgtd::calib::criticism::search {
namespace {

struct ErrorLevel {
  double nT{0}, nT_per_m{0};
};

ErrorLevel level_of(const fit::joint::JointErrors& e) {
  return {e.residual_nT, calibration::root_mean_square(e.summary.tensor_rmse_nT_per_m)};
}

/// NaN where either is.
double beyond(double without, double with) {
  const double squares = without * without - with * with;
  return squares < 0 ? 0 : std::sqrt(squares);
}

Result<ErrorLevel> level_with(const PoseTable& table, const ModelStage& whole,
                              const std::vector<effects::EffectPtr>& effects) {
  const auto fit = fit_under_same_weights(table, whole, effects);
  if (!fit) return tl::unexpected(fit.error());
  return level_of(fit::joint::joint_errors(fit->problem, fit->state, fit::joint::FixedBlock::fitted));
}

/// Of the tensor when every corrected component has the noise of its pose means.
double tensor_floor(const fit::joint::JointFit& fit) {
  sensor::ChannelColumns<6> rows = calibration::gradient_rows(fit.problem.geometry);
  const auto determined = (rows.col(0).array() == rows.col(0).array()).count();
  if (determined == 0) return std::numeric_limits<double>::quiet_NaN();
  rows = rows.array().isNaN().select(0.0, rows);
  double sum = 0;
  for (int c = 0; c < rows.cols(); ++c)
    sum += rows.col(c).squaredNorm() * std::pow(fit.pose_noise_nT(c / 3, c % 3), 2);
  return std::sqrt(sum / static_cast<double>(determined));
}

}  // namespace

Result<Waterfall> waterfall(const PoseTable& table, const fit::FitOptions& options) {
  const auto whole = model_stage(table, options);
  if (!whole) return tl::unexpected(whole.error());
  const auto& effects = whole->options.effects;
  const ErrorLevel with = level_of(whole->errors);
  const auto without = level_with(table, *whole, {});
  if (!without) return tl::unexpected(without.error());
  Waterfall out{.without_nT = without->nT,
                .without_nT_per_m = without->nT_per_m,
                .with_nT = with.nT,
                .with_nT_per_m = with.nT_per_m,
                .floor_nT = whole->fit.noise_nT(),
                .floor_nT_per_m = tensor_floor(whole->fit)};
  for (std::size_t i = 0; i < effects.size(); ++i) {
    std::vector<effects::EffectPtr> others = effects;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const auto alone = level_with(table, *whole, {effects[i]});
    if (!alone) return tl::unexpected(alone.error());
    const auto missing = level_with(table, *whole, others);
    if (!missing) return tl::unexpected(missing.error());
    out.steps.push_back({.effect = std::string(effects[i]->name()),
                         .spec = effects[i]->spec(),
                         .first_nT = beyond(without->nT, alone->nT),
                         .first_nT_per_m = beyond(without->nT_per_m, alone->nT_per_m),
                         .last_nT = beyond(missing->nT, with.nT),
                         .last_nT_per_m = beyond(missing->nT_per_m, with.nT_per_m)});
  }
  std::stable_sort(out.steps.begin(), out.steps.end(),
                   [](const WaterfallStep& a, const WaterfallStep& b) { return a.last_nT > b.last_nT; });
  return out;
}

}  // namespace mgtd::calib::criticism::search
