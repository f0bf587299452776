// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/polish.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "calib/effects/effect_family.h"
#include "calib/fit/tune.h"

namespace mgtd::calib {
namespace {

constexpr double kTold = 3.5;    ///< standard deviations from zero: one of 2000 that are zero
constexpr std::size_t kFew = 4;  ///< axes that are listed one by one

/// The effect with its smooth number left open; null where it has none.
EffectPtr opened(const Effect& effect) {
  const EffectFamily* family = find_family(effect.name());
  if (family == nullptr || !family->scan || family->scan->optional) return nullptr;
  if (family->scan->range != Scan::Range::linear && family->scan->range != Scan::Range::logarithmic)
    return nullptr;
  auto spec = EffectSpec::parse(effect.spec());
  if (!spec || spec->parameters.empty()) return nullptr;
  spec->parameters.clear();
  auto made = make_effect(*spec);
  return made ? *std::move(made) : nullptr;
}

/// With the numbers of `effects` searched, those of the others as they stand.
Result<std::vector<EffectPtr>> searched(const PoseTable& table, const JointOptions& options,
                                        std::size_t given) {
  JointOptions open = options;
  for (std::size_t i = given; i < open.effects.size(); ++i)
    if (EffectPtr effect = opened(*open.effects[i])) open.effects[i] = std::move(effect);
  return tune(table, open);
}

/// Axes of an effect whose coefficients are told from zero. `first`: its slot in the fit.
std::set<std::string> told_axes(const JointFit& fit, const Effect& effect, Eigen::Index first) {
  std::set<std::string> out;
  for (std::size_t j = 0; j < effect.coefficients().size(); ++j) {
    const Eigen::Index slot = first + static_cast<Eigen::Index>(j);
    const double sd = std::sqrt(fit.covariance(kEffectSlot + slot, kEffectSlot + slot));
    if (std::abs(fit.state.coefficients[slot]) > kTold * sd)
      out.insert(effect.coefficients()[j].name.substr(0, 4));
  }
  return out;
}

/// One effect for each of those axes; the effect itself where they are many.
std::vector<EffectPtr> on_told_axes(const JointFit& fit, const EffectPtr& effect, Eigen::Index first) {
  auto spec = EffectSpec::parse(effect->spec());
  if (effect->level() != Level::axis || !spec || !spec->where ||
      spec->where->scale != Where::Scale::each_axis)
    return {effect};
  const std::set<std::string> axes = told_axes(fit, *effect, first);
  if (axes.size() > kFew) return {effect};
  std::vector<EffectPtr> out;
  for (const std::string& axis : axes) {
    const auto where = Where::parse(axis);
    if (!where) return {effect};
    spec->where = *where;
    auto made = make_effect(*spec);
    if (!made) return {effect};
    out.push_back(*std::move(made));
  }
  return out;
}

}  // namespace

Result<std::vector<EffectPtr>> polished(const PoseTable& table, const JointOptions& options,
                                        std::size_t given) {
  JointOptions model = options;
  auto effects = searched(table, model, given);
  if (!effects) return effects;
  model.effects = *std::move(effects);
  const auto fit = fit_joint_at_size(table, model);
  if (!fit) return tl::unexpected(fit.error());
  std::vector<EffectPtr> few;
  Eigen::Index slot = 0;
  for (std::size_t i = 0; i < model.effects.size(); ++i) {
    const EffectPtr& effect = model.effects[i];
    if (i < given) {
      few.push_back(effect);
    } else {
      for (EffectPtr& part : on_told_axes(*fit, effect, slot)) few.push_back(std::move(part));
    }
    slot += static_cast<Eigen::Index>(effect->coefficients().size());
  }
  if (few.size() == model.effects.size() && std::equal(few.begin(), few.end(), model.effects.begin()))
    return model.effects;
  model.effects = std::move(few);
  return searched(table, model, given);
}

}  // namespace mgtd::calib
