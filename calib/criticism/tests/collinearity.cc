// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/collinearity.h"

#include <algorithm>
#include <cmath>

#include "calib/criticism/tests/detectable.h"
#include "calib/criticism/tests/noise.h"
#include "calib/criticism/tests/score.h"
#include "calib/effects/derivative_check.h"
#include "calib/effects/formula/formula.h"
#include "calib/fit/joint/joint_report.h"
#include "calib/linear/qr.h"
#include "calib/stats/probability.h"

namespace mgtd::calib::criticism::tests {
namespace {

constexpr double kWorthTelling = 0.3;  ///< correlation
constexpr std::size_t kNamedAtMost = 5;

/// Share of the length of `Z` that lies in the space of `B`, as a correlation; columns of Z counted alike.
double correlation(const Eigen::MatrixXd& Z, const Eigen::MatrixXd& B) {
  const Eigen::MatrixXd Q = linear::column_space(B, B.colwise().norm(), kAbsorbed);
  if (Q.cols() == 0) return 0;
  return std::sqrt((Q.transpose() * Z).squaredNorm() / Z.squaredNorm());
}

std::vector<Collinearity> alike(const fit::joint::JointFit& fit, const Residual& residual,
                                const PoseTable& table, const Eigen::MatrixXd& Z) {
  std::vector<Collinearity> out;
  const CandidateEffects library = library_candidates(table, fit.problem.effects);
  for (const CandidateEffect& candidate_effect : library.testable) {
    Collinearity r{.effect = candidate_effect.name};
    for (const effects::EffectPtr& variant : candidate_effect.variants) {
      const auto B = residual.project(effect_rows(fit.problem, fit.state, variant)).projected;
      r.correlation = std::max(r.correlation, correlation(Z, B));
    }
    if (r.correlation > kWorthTelling) out.push_back(std::move(r));
  }
  std::stable_sort(out.begin(), out.end(), [](const Collinearity& a, const Collinearity& b) {
    return a.correlation > b.correlation;
  });
  if (out.size() > kNamedAtMost) out.resize(kNamedAtMost);
  return out;
}

void tell_coefficients(const CandidateEffect& candidate_effect, const ScoredFamily& scored,
                       FormulaExamination& out) {
  const Score& score = scored.winner();
  const OneStep step = one_step(scored.signatures[score.variant], scored.where());
  out.S = score.S, out.rank = score.k, out.log10_p = score.log10_p;
  const auto& coefficients = candidate_effect.variants[score.variant]->coefficients();
  out.unit = coefficients.front().unit;
  for (std::size_t i = 0; i < coefficients.size(); ++i) {
    const auto j = static_cast<Eigen::Index>(i);
    const double sd = std::sqrt(step.covariance(j, j));
    out.coefficients.push_back({coefficients[i].name, step.value[j], sd, coefficients[i].unit});
    out.detectable = std::max(out.detectable, kSeen * sd);
  }
}

}  // namespace

double FormulaExamination::d() const { return std::sqrt(std::max(0.0, S - rank)); }

Result<CandidateEffect> formula_candidate(const effects::EffectSpec& given, int sensors) {
  effects::EffectSpec formula = given;
  formula.sensors = sensors;
  const auto scan = effects::formula::open_scan(formula);
  CandidateEffect out{.name = formula.name};
  const std::vector<double> values = scan ? effects::formula::scan_values(*scan) : std::vector<double>{0};
  for (const double value : values) {
    effects::EffectSpec spec = formula;
    if (scan) spec.set(scan->parameter, value);
    auto effect = effects::formula::make_formula(spec);
    if (!effect) return tl::unexpected(effect.error());
    out.variants.push_back(std::move(*effect));
    out.values.push_back(scan ? std::optional(value) : std::nullopt);
  }
  const effects::Effect& first = *out.variants.front();
  out.level = first.level();
  if (scan) out.parameter = scan->parameter;
  out.typical = first.coefficients().front().typical;
  const auto n = static_cast<Eigen::Index>(first.coefficients().size());
  const auto own = effects::EffectSpec::parse(first.spec());
  const bool whole = !own || !own->where || own->where->scale == effects::Where::Scale::own;
  Hypothesis everything{.where = whole ? std::string(effects::to_string(out.level)) : own->where->text(),
                        .axes = !whole && own->where->axis >= 0     ? 1
                                : !whole && own->where->sensor >= 0 ? 3
                                                                    : 3 * sensors,
                        .combine = Eigen::MatrixXd::Identity(n, n),
                        .names = {}};
  for (const effects::Coefficient& c : first.coefficients()) everything.names.push_back(c.name);
  out.hypotheses = {std::move(everything)};
  out.make = [formula, scan](const Hypothesis*, const std::optional<double>& value) {
    effects::EffectSpec spec = formula;
    if (scan && value) spec.set(scan->parameter, *value);
    return effects::formula::make_formula(spec);
  };
  return out;
}

Result<FormulaExamination> examine_formula(const PoseTable& table, const fit::FitOptions& options,
                                           const effects::EffectSpec& formula) {
  const int sensors = table.poses.empty() ? kSensors : static_cast<int>(table.poses.front().y_nT.size());
  auto candidate_effect = formula_candidate(formula, sensors);
  if (!candidate_effect) return tl::unexpected(candidate_effect.error());
  for (effects::EffectPtr& variant : candidate_effect->variants) {
    auto looking_back = variant->bound({.table = &table, .offset_nT = {}});
    if (!looking_back) return tl::unexpected(looking_back.error());
    if (*looking_back) variant = *std::move(looking_back);
    if (const auto ok = variant->applicable(table); !ok) return tl::unexpected(ok.error());
    if (const auto ok = effects::check_derivatives(*variant, table); !ok) return tl::unexpected(ok.error());
  }
  const auto fit = fit::joint::fit_joint(table, fit::joint::joint_options(options));
  if (!fit) return tl::unexpected(fit.error());
  Residual residual(fit->problem, fit->state, pose_correlation(fit->problem, fit->state));
  const NoiseModel noise = noise_model(*fit, residual);
  residual.measure_by(noise.reference.scale2);
  const ScoredFamily scored =
      score_family(fit->problem, fit->state, residual, noise.reference, *candidate_effect);
  FormulaExamination out{.name = formula.name,
                         .where = candidate_effect->hypotheses.front().where,
                         .expression = *formula.find("expr"),
                         .k = static_cast<int>(candidate_effect->variants.front()->coefficients().size())};
  const Signature& s = scored.signatures[scored.testable() ? scored.winner().variant : 0];
  const double length = s.norms().squaredNorm();
  out.absorbed = length > 0 ? 1 - s.gram().trace() / length : 1;
  if (!scored.testable()) return out;
  tell_coefficients(*candidate_effect, scored, out);
  out.signature = added_variable(s, one_step(s, scored.where()), residual, fit->problem);
  out.alike = alike(*fit, residual, table, s.times(Eigen::MatrixXd::Identity(s.cols(), s.cols())));
  return out;
}

}  // namespace mgtd::calib::criticism::tests
