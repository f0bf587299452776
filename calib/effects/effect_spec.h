// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "calib/effects/where.h"
#include "proto/error.h"

/// An EffectSpec is the text that names an effect:  NAME[@WHERE][,PARAM=VALUE]...
///     axis.offset.temperature@s3.z      axis.hysteresis@s2,w=0.1      platform.current,columns=motor_A
/// A parameter "expr" comes last and takes all text after it: it is a user's formula, see formula.h.
/// The text of a spec that parse() gave reads back to the same spec.
namespace mgtd::calib::effects {

struct EffectSpec {
  std::string name;            ///< of the family
  std::optional<Where> where;  ///< not said: the family's own default
  std::vector<std::pair<std::string, std::string>> parameters;
  int sensors{kSensors};  ///< of the array that the effect is laid over; not part of the text

  [[nodiscard]] static Result<EffectSpec> parse(std::string_view text);
  [[nodiscard]] std::string text() const;

  [[nodiscard]] const std::string* find(std::string_view parameter) const;
  void set(std::string_view parameter, double value);  ///< to six digits
  void set(std::string_view parameter, std::string value);
  /// The number under `parameter`, `otherwise` when it is not given; refuses what is no number within
  /// [lowest, highest].
  [[nodiscard]] Result<double> number(std::string_view parameter, double otherwise, double lowest,
                                      double highest) const;
  /// Refuses a parameter that is not in `known`.
  [[nodiscard]] Result<void> only(std::initializer_list<std::string_view> known) const;
};

/// The part before '@' and ','.
[[nodiscard]] std::string_view family_name(std::string_view spec);

}  // namespace mgtd::calib::effects
