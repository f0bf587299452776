// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/library/library.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "calib/effects/formula/formula.h"
#include "calib/effects/library/effect_family.h"
#include "proto/nearest_word.h"

namespace mgtd::calib::effects::library {

std::vector<std::string_view> effect_names() {
  std::vector<std::string_view> names;
  for (const EffectFamily& family : effect_families()) names.push_back(family.name);
  return names;
}

std::string no_such_effect(std::string_view name) {
  std::vector<std::string> known;
  for (const EffectFamily& family : effect_families()) known.emplace_back(family.name);
  const auto meant = nearest_word(name, known);
  return fmt::format("no effect is called '{}'{}", name,
                     meant ? fmt::format(", did you mean '{}'?", *meant) : std::string());
}

Result<EffectPtr> make_effect(const EffectSpec& spec) {
  if (formula::is_formula(spec)) return formula::make_formula(spec);
  if (const EffectFamily* family = find_family(spec.name)) return family->from_spec(spec);
  return fail(ErrorCode::usage, no_such_effect(spec.name),
              fmt::format("known effects: {}", fmt::join(effect_names(), ", ")));
}

Result<EffectPtr> make_effect(std::string_view text) {
  const auto spec = EffectSpec::parse(text);
  if (!spec) return tl::unexpected(spec.error());
  return make_effect(*spec);
}

Result<EffectPtr> make_effect(std::string_view text, int sensors) {
  auto spec = EffectSpec::parse(text);
  if (!spec) return tl::unexpected(spec.error());
  spec->sensors = sensors;
  return make_effect(*spec);
}

Result<EffectPtr> make_effect(const EffectSpec& spec, const EffectContext& context) {
  EffectSpec of_array = spec;
  of_array.sensors = context.sensors();
  auto effect = make_effect(of_array);
  if (!effect) return effect;
  auto bound = (*effect)->bound(context);
  if (!bound) return tl::unexpected(bound.error());
  return *bound ? *bound : *effect;
}

namespace {

/// An effect is made before the array is known, for the cross; here it is made anew where that is another.
Result<EffectPtr> laid_over(const EffectPtr& effect, int sensors) {
  if (sensors == kSensors) return effect;
  return make_effect(effect->spec(), sensors);
}

}  // namespace

Result<std::vector<EffectPtr>> bound_to_run(const std::vector<EffectPtr>& effects,
                                            const EffectContext& context) {
  std::vector<EffectPtr> out;
  for (const EffectPtr& given : effects) {
    auto effect = laid_over(given, context.sensors());
    if (!effect) return tl::unexpected(effect.error());
    auto bound = (*effect)->bound(context);
    if (!bound) return tl::unexpected(bound.error());
    out.push_back(*bound ? std::move(*bound) : *std::move(effect));
  }
  return out;
}

}  // namespace mgtd::calib::effects::library
