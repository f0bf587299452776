// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <array>

#include "calib/effects/laws/axis_effect.h"
#include "calib/effects/library/effect_family.h"

/// The descriptions of the effects in the library are put together from these parts.
namespace mgtd::calib::effects::library {

/// Scales of an effect of the axes, and of one that is a vector or a rotation of each sensor.
inline constexpr std::array kAxisScales{Where::Scale::each_axis, Where::Scale::axis,
                                        Where::Scale::each_sensor, Where::Scale::sensor, Where::Scale::all};
inline constexpr std::array kSensorScales{Where::Scale::own, Where::Scale::sensor};
inline constexpr std::array kOwnScale{Where::Scale::own};

/// Refuses a place that is not among `scales`; without one the first of them is meant.
[[nodiscard]] Result<Where> where_of(const EffectSpec& spec, std::span<const Where::Scale> scales);

/// An axis effect whose law has no parameters.
template <class Law>
[[nodiscard]] Result<EffectPtr> plain_axis(const EffectSpec& spec) {
  if (const auto ok = spec.only({}); !ok) return tl::unexpected(ok.error());
  const auto where = where_of(spec, kAxisScales);
  if (!where) return tl::unexpected(where.error());
  return std::make_shared<const laws::AxisEffect<Law>>(Law{}, *where);
}

/// One whose law has one number, set through `member`.
template <class Law>
[[nodiscard]] Result<EffectPtr> axis_with(const EffectSpec& spec, std::string_view parameter,
                                          std::optional<double> Law::*member, double lowest, double highest) {
  if (const auto ok = spec.only({parameter}); !ok) return tl::unexpected(ok.error());
  const auto where = where_of(spec, kAxisScales);
  if (!where) return tl::unexpected(where.error());
  Law law;
  const auto value = spec.number(parameter, 0, lowest, highest);
  if (!value) return tl::unexpected(value.error());
  if (spec.find(parameter) != nullptr) law.*member = *value;
  return std::make_shared<const laws::AxisEffect<Law>>(std::move(law), *where);
}

/// An effect of its own place without parameters.
template <class E>
[[nodiscard]] Result<EffectPtr> plain(const EffectSpec& spec) {
  if (const auto ok = spec.only({}); !ok) return tl::unexpected(ok.error());
  if (const auto where = where_of(spec, kOwnScale); !where) return tl::unexpected(where.error());
  return std::make_shared<const E>();
}

}  // namespace mgtd::calib::effects::library
