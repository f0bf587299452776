// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/growth.h"

namespace mgtd::calib {
namespace {

/// Whether coefficients laid out as `whole` can be those laid out as `part`.
bool holds(const Where& whole, const Where& part) {
  if (whole == part || whole.scale == Where::Scale::each_axis) return true;
  return whole.scale == Where::Scale::each_sensor &&
         (part.scale == Where::Scale::sensor || part.scale == Where::Scale::all);
}

bool holds(const Effect& whole, const Effect& part) {
  if (whole.name() != part.name()) return false;
  const auto a = EffectSpec::parse(whole.spec()), b = EffectSpec::parse(part.spec());
  if (!a || !b || a->parameters != b->parameters) return false;
  if (!a->where) return whole.level() != Level::axis;
  return b->where && holds(*a->where, *b->where);
}

}  // namespace

Result<std::vector<EffectPtr>> grown(const std::vector<EffectPtr>& model, const ScoredFamily& winner) {
  const Suspect& suspect = *winner.suspect;
  auto added = suspect.make(&winner.where(), suspect.values[winner.winner().variant]);
  if (!added) return tl::unexpected(added.error());
  std::vector<EffectPtr> out;
  for (const EffectPtr& effect : model)
    if (!holds(**added, *effect)) out.push_back(effect);
  out.push_back(*std::move(added));
  return out;
}

}  // namespace mgtd::calib
