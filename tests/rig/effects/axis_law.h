// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include "tests/rig/effect.h"

/// Effects of one axis that depend on the present only: y += coefficient * shape.
namespace mgtd::rig {

/// One law of the list. `second` is a parameter inside the shape, where `second_key` names one.
struct AxisLaw {
  const char* name;
  const char* key;         ///< of the coefficient, with its unit
  const char* second_key;  ///< nullptr when the shape has no parameter
  double (*shape)(const AxisContext& c, double second);
};

class AxisEffect final : public Effect {
 public:
  AxisEffect(const AxisLaw& law, Where where, double coefficient, double second)
      : law_(law), where_(std::move(where)), coefficient_(coefficient), second_(second) {}
  [[nodiscard]] std::unique_ptr<Effect> fresh() const override { return std::make_unique<AxisEffect>(*this); }
  [[nodiscard]] double axis_nT(const AxisContext& c) const override {
    return where_.covers(c) ? coefficient_ * law_.shape(c, second_) : 0;
  }
  [[nodiscard]] nlohmann::json truth() const override {
    nlohmann::json out{{"effect", law_.name}, {"where", where_.text()}, {law_.key, coefficient_}};
    if (law_.second_key != nullptr) out[law_.second_key] = second_;
    return out;
  }

 private:
  AxisLaw law_;
  Where where_;
  double coefficient_, second_;
};

}  // namespace mgtd::rig
