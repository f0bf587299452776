// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/effects/laws/axis_effect.h"

/// These effects make the reading of an axis depend on the field in a way that is not linear; x = v/F0,
/// coefficients in nT at F0:
///
///     axis.quadratic      y += q x^2
///     axis.cubic          y += c x^3
///     axis.transverse     y_a += tau1 (x_b^2 + x_c^2) + tau2 x_b x_c        b, c the other two axes
///     axis.zero-crossing  y += s sign(v)                                    nT
namespace mgtd::calib::effects::laws {

template <class S>
[[nodiscard]] S in_F0(std::span<const S> v, int axis) {
  return v[static_cast<std::size_t>(axis)] * S(1 / kReferenceField_nT);
}

struct Quadratic : PlainLaw {
  static constexpr std::string_view kName = "axis.quadratic";
  static AxisCoefficients coefficients() { return one_per_axis("nT", 2); }
  template <class S>
  static S shape(const Conditions&, int, int axis, std::span<const S> v, int) {
    const S x = in_F0(v, axis);
    return x * x;
  }
};

struct Cubic : PlainLaw {
  static constexpr std::string_view kName = "axis.cubic";
  static AxisCoefficients coefficients() { return one_per_axis("nT", 2); }
  template <class S>
  static S shape(const Conditions&, int, int axis, std::span<const S> v, int) {
    const S x = in_F0(v, axis);
    return x * x * x;
  }
};

struct Transverse : PlainLaw {
  static constexpr std::string_view kName = "axis.transverse";
  static constexpr int kPerAxis = 2;
  static AxisCoefficients coefficients() {
    const std::vector<std::string> two{".squares", ".product"};
    return {.suffix = {{two, two, two}}, .unit = "nT", .typical = 2};
  }
  template <class S>
  static S shape(const Conditions&, int, int axis, std::span<const S> v, int j) {
    const S b = in_F0(v, (axis + 1) % 3), c = in_F0(v, (axis + 2) % 3);
    return j == 0 ? b * b + c * c : b * c;
  }
};

struct ZeroCrossing : PlainLaw {
  static constexpr std::string_view kName = "axis.zero-crossing";
  static AxisCoefficients coefficients() { return one_per_axis("nT", 0.5); }
  template <class S>
  static S shape(const Conditions&, int, int axis, std::span<const S> v, int) {
    const double own = sensor::value_of(v[static_cast<std::size_t>(axis)]);
    return S(own > 0 ? 1.0 : own < 0 ? -1.0 : 0.0);
  }
};

}  // namespace mgtd::calib::effects::laws
