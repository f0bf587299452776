// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/search/prune.h"

#include <cmath>
#include <set>

#include "calib/criticism/search/nonlinear_parameters.h"
#include "calib/effects/effect_spec.h"
#include "calib/effects/library/library.h"

namespace mgtd::calib::criticism::search {
namespace {

constexpr double kSignificant = 3.5;  ///< standard deviations from zero: one of 2000 that are zero
constexpr std::size_t kFew = 4;       ///< axes that are listed one by one

/// Axes of an effect whose coefficients differ significantly from zero. `first`: its slot in the fit.
std::set<std::string> significant_axes(const fit::joint::JointFit& fit, const effects::Effect& effect,
                                       Eigen::Index first) {
  std::set<std::string> out;
  for (std::size_t j = 0; j < effect.coefficients().size(); ++j) {
    const Eigen::Index slot = first + static_cast<Eigen::Index>(j);
    const double sd =
        std::sqrt(fit.covariance(fit.problem.slots().effects() + slot, fit.problem.slots().effects() + slot));
    if (std::abs(fit.state.coefficients[slot]) > kSignificant * sd) {
      const std::string& name = effect.coefficients()[j].name;
      out.insert(name.substr(0, name.find('.') + 2));
    }
  }
  return out;
}

/// One effect for each of those axes; the effect itself where they are many.
std::vector<effects::EffectPtr> on_significant_axes(const fit::joint::JointFit& fit,
                                                    const effects::EffectPtr& effect, Eigen::Index first) {
  auto spec = effects::EffectSpec::parse(effect->spec());
  if (effect->level() != effects::Level::axis || !spec || !spec->where ||
      spec->where->scale != effects::Where::Scale::each_axis)
    return {effect};
  const std::set<std::string> axes = significant_axes(fit, *effect, first);
  if (axes.size() > kFew) return {effect};
  std::vector<effects::EffectPtr> out;
  for (const std::string& axis : axes) {
    const auto where = effects::Where::parse(axis);
    if (!where) return {effect};
    spec->where = *where;
    spec->sensors = fit.problem.sensors();
    auto made = effects::library::make_effect(*spec);
    if (!made) return {effect};
    out.push_back(*std::move(made));
  }
  return out;
}

}  // namespace

void prune(const PoseTable& table, std::size_t given, fit::joint::JointOptions& options,
           fit::joint::JointFit& fit) {
  fit::joint::JointOptions few = options;
  few.effects.clear();
  Eigen::Index slot = 0;
  for (std::size_t i = 0; i < options.effects.size(); ++i) {
    const effects::EffectPtr& effect = options.effects[i];
    if (i < given) {
      few.effects.push_back(effect);
    } else {
      for (effects::EffectPtr& part : on_significant_axes(fit, effect, slot))
        few.effects.push_back(std::move(part));
    }
    slot += static_cast<Eigen::Index>(effect->coefficients().size());
  }
  if (few.effects != options.effects) {
    auto narrow = fit::joint::fit_joint_at_size(table, few, &fit.state);
    if (!narrow) return;
    options = std::move(few);
    fit = *std::move(narrow);
  }
  refine_nonlinear_parameters(table, given, options, fit);
}

}  // namespace mgtd::calib::criticism::search
