// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string_view>
#include <vector>

#include "calib/effects/effect.h"
#include "calib/effects/effect_spec.h"

/// make_effect() makes an effect of the library by its name, so that it can be put in the model (`--with`).
/// effect_family.h says what each effect is.
namespace mgtd::calib::effects::library {

/// Names that make_effect knows, in the order they are listed to the user.
[[nodiscard]] std::vector<std::string_view> effect_names();
/// "no effect is called 'axis.cubik', did you mean 'axis.cubic'?"
[[nodiscard]] std::string no_such_effect(std::string_view name);
/// NAME[@WHERE][,PARAM=VALUE]..., see effect_spec.h. An effect that needs the run is not bound to one yet: a
/// fit does that. Refuses an unknown name with the list of known ones, and places and parameters it cannot
/// have.
[[nodiscard]] Result<EffectPtr> make_effect(std::string_view spec);
[[nodiscard]] Result<EffectPtr> make_effect(const EffectSpec& spec);
/// Laid over an array of so many sensors; without the number it is that of the cross, or of the run.
[[nodiscard]] Result<EffectPtr> make_effect(std::string_view spec, int sensors);
/// The same, bound to a run.
[[nodiscard]] Result<EffectPtr> make_effect(const EffectSpec& spec, const EffectContext& context);
/// Effects as they are on one run (Effect::bound), those that do not care unchanged.
[[nodiscard]] Result<std::vector<EffectPtr>> bound_to_run(const std::vector<EffectPtr>& effects,
                                                          const EffectContext& context);

}  // namespace mgtd::calib::effects::library
