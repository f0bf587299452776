// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/model_change.h"

#include <algorithm>
#include <cmath>

#include "calib/criticism/search/step_of_a_source.h"
#include "calib/criticism/tests/noise.h"
#include "calib/criticism/tests/residual.h"
#include "calib/criticism/tests/score.h"
#include "calib/effects/common_axis.h"
#include "calib/linear/ldlt.h"
#include "calib/stats/chi_square.h"

namespace mgtd::calib::criticism::search {
namespace {

struct Fall {
  double chi2{0};
  int k{0};
};

/// Of the score test: what chi-square would fall by if `effect` were in the model.
Fall score_fall(const ModelStage& stage, const effects::EffectPtr& effect) {
  const tests::Residual residual(stage.fit.problem, stage.fit.state,
                                 tests::pose_correlation(stage.fit.problem, stage.fit.state));
  const tests::Signature s(residual, tests::effect_source(stage.fit.problem, stage.fit.state, effect));
  const auto m = static_cast<Eigen::Index>(effect->coefficients().size());
  const tests::OneStep step =
      tests::one_step(s, tests::Hypothesis{.combine = Eigen::MatrixXd::Identity(m, m), .names = {}});
  return {(step.basis.transpose() * s.by_residual()).squaredNorm(), static_cast<int>(step.basis.cols())};
}

/// Of the Wald test: what chi-square would rise by if these coefficients were zero.
double wald_rise(const fit::joint::JointFit& fit, Eigen::Index first, Eigen::Index count) {
  const Eigen::VectorXd c = fit.state.coefficients.segment(first, count);
  const Eigen::MatrixXd C = fit.covariance.block(fit.problem.slots().effects() + first,
                                                 fit.problem.slots().effects() + first, count, count) /
                            std::pow(fit.birge_ratio, 2);
  return c.dot(linear::solve_by_ldlt(C, c));
}

std::vector<calibration::EffectCoefficient> coefficients_of(const fit::joint::JointFit& fit,
                                                            std::size_t which, Eigen::Index& first) {
  first = 0;
  for (std::size_t i = 0; i < which; ++i)
    first += static_cast<Eigen::Index>(fit.problem.effects[i]->coefficients().size());
  std::vector<calibration::EffectCoefficient> out;
  Eigen::Index slot = first;
  for (const effects::Coefficient& c : fit.problem.effects[which]->coefficients()) {
    const double variance =
        fit.covariance(fit.problem.slots().effects() + slot, fit.problem.slots().effects() + slot);
    out.push_back({c.name, fit.state.coefficients[slot], std::sqrt(variance), c.unit});
    ++slot;
  }
  return out;
}

/// Chi-square of both with the correlation from pose to pose of the first.
double chi2_of(const ModelStage& stage, const fit::joint::JointFit& fit) {
  return tests::Residual(fit.problem, fit.state, tests::pose_correlation(stage.fit.problem, stage.fit.state))
      .chi2();
}

std::optional<double> held_out_residual(const std::optional<fit::joint::JointErrors>& errors) {
  return errors ? std::optional(errors->residual_nT) : std::nullopt;
}

void fill(const ModelStage& before, const ModelStage& after, ModelChange& out) {
  out.model = effects::specs_of(after.options.effects);
  out.chi2_before = before.fit.chi2, out.dof_before = before.fit.dof;
  out.chi2_after = after.fit.chi2, out.dof_after = after.fit.dof;
  out.rms_before_nT = before.errors.residual_nT, out.rms_after_nT = after.errors.residual_nT;
  out.noise_nT = (out.adding ? after : before).fit.noise_nT();
  out.tensor_before_nT_per_m = calibration::root_mean_square(before.errors.summary.tensor_rmse_nT_per_m);
  out.tensor_after_nT_per_m = calibration::root_mean_square(after.errors.summary.tensor_rmse_nT_per_m);
  out.held_out_before_nT = held_out_residual(before.held_out);
  out.held_out_after_nT = held_out_residual(after.held_out);
  // A model that is far off in another way has its chi-square fall by thousands for nothing.
  out.birge_ratio = (out.adding ? after : before).fit.birge_ratio;
  const double fall = out.realised / (out.birge_ratio * out.birge_ratio);
  out.log10_p = fall > 0 ? stats::chi_square_log10_p(fall, std::max(1, out.k)) : 0;
}

}  // namespace

std::vector<Veto> ModelChange::vetoes() const {
  std::vector<Veto> out;
  if (held_out_before_nT && held_out_after_nT && *held_out_after_nT > kHeldOutVeto * *held_out_before_nT)
    out.push_back(Veto::held_out);
  if (adding && log10_p > std::log10(kVetoChance)) out.push_back(Veto::not_shown);
  if (adding && price.sd_ratio > kVetoPrice) out.push_back(Veto::price);
  return out;
}

Result<ModelChange> add_effect(const PoseTable& table, const fit::FitOptions& options,
                               const effects::EffectPtr& effect) {
  for (const effects::EffectPtr& known : options.effects) {
    if (!effects::same_law_on_a_common_axis(*known, *effect)) continue;
    return fail(ErrorCode::refused, "the model holds " + known->spec() + " already",
                "drop it first, if it should act elsewhere");
  }
  const auto before = model_stage(table, options);
  if (!before) return tl::unexpected(before.error());
  fit::FitOptions wider = options;
  wider.effects = before->options.effects;
  wider.effects.push_back(effect);
  auto after = model_stage(table, wider);
  if (!after) return tl::unexpected(after.error());
  if (auto source = step_of_a_source(table, wider, *before, *after)) after = *std::move(source);
  const effects::EffectPtr& profiled = after->fit.problem.effects.back();
  ModelChange out{.adding = true, .effect = std::string(effect->name()), .spec = profiled->spec()};
  const Fall fall = score_fall(*before, profiled);
  out.predicted = fall.chi2, out.k = fall.k;
  const auto same = fit_under_same_weights(table, *before, after->fit.problem.effects);
  out.realised = chi2_of(*before, before->fit) - chi2_of(*before, same ? *same : after->fit);
  Eigen::Index first = 0;
  out.coefficients = coefficients_of(after->fit, options.effects.size(), first);
  out.price = variance_price(before->fit, after->fit);
  fill(*before, *after, out);
  return out;
}

Result<ModelChange> drop_effect(const PoseTable& table, const fit::FitOptions& options, std::size_t which) {
  const auto before = model_stage(table, options);
  if (!before) return tl::unexpected(before.error());
  fit::FitOptions narrower = options;
  narrower.effects = before->options.effects;
  narrower.effects.erase(narrower.effects.begin() + static_cast<std::ptrdiff_t>(which));
  const auto after = model_stage(table, narrower);
  if (!after) return tl::unexpected(after.error());
  const effects::EffectPtr& effect = before->fit.problem.effects[which];
  ModelChange out{.adding = false, .effect = std::string(effect->name()), .spec = effect->spec()};
  Eigen::Index first = 0;
  out.coefficients = coefficients_of(before->fit, which, first);
  out.k = static_cast<int>(out.coefficients.size());
  out.predicted = wald_rise(before->fit, first, out.k);
  const auto same = fit_under_same_weights(table, *before, narrower.effects);
  out.realised = chi2_of(*before, same ? *same : after->fit) - chi2_of(*before, before->fit);
  out.price = variance_price(after->fit, before->fit);
  fill(*before, *after, out);
  return out;
}

}  // namespace mgtd::calib::criticism::search
