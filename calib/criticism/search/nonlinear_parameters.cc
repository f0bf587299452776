// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/nonlinear_parameters.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "calib/criticism/tests/residual.h"
#include "calib/effects/library/effect_family.h"
#include "calib/effects/library/library.h"
#include "calib/linear/qr.h"

namespace mgtd::calib::criticism::search {
namespace {

constexpr int kSteps = 6;
constexpr double kSettled = 0.003;  ///< of a number
constexpr double kLongest = 0.4;    ///< step, of a number
constexpr double kDifference = 0.01;

struct Number {
  std::size_t effect{0};
  Eigen::Index first{0};  ///< its coefficients among all
  const effects::library::Scan* scan{nullptr};
  effects::EffectSpec spec;
  double value{0};

  [[nodiscard]] Result<effects::EffectPtr> at(double x, const effects::EffectContext& context) const {
    effects::EffectSpec out = spec;
    out.set(scan->parameter, x);
    return effects::library::make_effect(out, context);
  }
};

std::vector<Number> numbers_of(const std::vector<effects::EffectPtr>& effects, std::size_t given) {
  std::vector<Number> out;
  Eigen::Index first = 0;
  for (std::size_t i = 0; i < effects.size(); ++i) {
    const effects::library::EffectFamily* family = effects::library::find_family(effects[i]->name());
    const auto own = static_cast<Eigen::Index>(effects[i]->coefficients().size());
    const bool smooth = family != nullptr && family->scan &&
                        family->scan->range == effects::library::Scan::Range::logarithmic;
    if (auto spec = effects::EffectSpec::parse(effects[i]->spec()); i >= given && smooth && spec) {
      const auto value = spec->number(family->scan->parameter, 0, 0, 1e9);
      if (value && *value > 0) out.push_back({i, first, &*family->scan, *std::move(spec), *value});
    }
    first += own;
  }
  return out;
}

/// What a change of a number, relative, does to the rows; empty where it cannot be asked.
std::optional<Eigen::VectorXd> column(const fit::joint::JointFit& fit, const Number& n,
                                      const effects::EffectContext& context) {
  const auto up = n.at(n.value * (1 + kDifference), context),
             down = n.at(n.value * (1 - kDifference), context);
  if (!up || !down) return std::nullopt;
  const auto c =
      fit.state.coefficients.segment(n.first, static_cast<Eigen::Index>((*up)->coefficients().size()));
  const Eigen::MatrixXd rows =
      tests::effect_rows(fit.problem, fit.state, *up) - tests::effect_rows(fit.problem, fit.state, *down);
  return Eigen::VectorXd(rows * c / (2 * kDifference));
}

/// Relative steps of the numbers; empty where the data do not tell them.
std::optional<Eigen::VectorXd> steps(const fit::joint::JointFit& fit, const std::vector<Number>& numbers,
                                     const effects::EffectContext& context) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(fit.problem.poses.size()) * fit.problem.pose_rows(),
                       static_cast<Eigen::Index>(numbers.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const auto one = column(fit, numbers[i], context);
    if (!one) return std::nullopt;
    rows.col(static_cast<Eigen::Index>(i)) = *one;
  }
  const tests::Residual residual(fit.problem, fit.state, 0);
  const Eigen::MatrixXd z = residual.project(rows).projected;
  const auto step = linear::unique_least_squares(z, residual.value());
  if (!step) return std::nullopt;
  return Eigen::VectorXd(step->cwiseMax(-kLongest).cwiseMin(kLongest));
}

/// What the fit makes small, comparable where the weights are estimated.
double size_of(const fit::joint::JointFit& fit) {
  return fit.noise_nT() * std::sqrt(fit.chi2 / std::max(fit.dof, 1.0));
}

bool step_once(const PoseTable& table, std::size_t given, fit::joint::JointOptions& options,
               fit::joint::JointFit& fit) {
  const std::vector<Number> numbers = numbers_of(options.effects, given);
  const effects::EffectContext context{.table = &table, .offset_nT = {}};
  if (numbers.empty()) return false;
  const auto step = steps(fit, numbers, context);
  if (!step || step->cwiseAbs().maxCoeff() < kSettled) return false;
  fit::joint::JointOptions next = options;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    const Number& n = numbers[i];
    const double value =
        std::clamp(n.value * (1 + (*step)[static_cast<Eigen::Index>(i)]), n.scan->from / 2, n.scan->to * 2);
    auto effect = n.at(value, context);
    if (!effect) return false;
    next.effects[n.effect] = *std::move(effect);
  }
  next.noise_inflation = fit.noise_inflation;
  auto after = fit::joint::fit_joint_at_size(table, next, &fit.state);
  if (!after || size_of(*after) >= size_of(fit)) return false;
  options.effects = std::move(next.effects);
  fit = *std::move(after);
  return true;
}

}  // namespace

void refine_nonlinear_parameters(const PoseTable& table, std::size_t given, fit::joint::JointOptions& options,
                                 fit::joint::JointFit& fit) {
  for (int i = 0; i < kSteps && step_once(table, given, options, fit); ++i) {
  }
}

}  // namespace mgtd::calib::criticism::search
