// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "calib/effects/effect_spec.h"
#include "calib/effects/library/library.h"

/// An EffectFamily describes one effect of the library as data: what it is, how large it is in practice, how
/// it can be told apart, and how to make it. These descriptions are the one source for the program, its pages
/// and its tests.
namespace mgtd::calib::effects::library {

/// A fixed number of an effect that a score test tries one after the other, because the effect is not linear
/// in it. A fit that has the effect in its model estimates it too (calib/fit/joint/profile_search.h).
struct Scan {
  enum class Range {
    linear,       ///< from .. to
    logarithmic,  ///< the same, in equal ratios
    run,          ///< from .. to as shares of the run: values lie half-way between poses, in hours
    index         ///< whole numbers from .. to
  };
  std::string_view parameter, unit;
  double from{0}, to{0};
  int steps{0};
  Range range{Range::linear};
  /// The family has a form without the parameter, to be tested beside the scanned one.
  bool optional{false};
};

/// Another effect that looks alike, and what separates them.
struct Confusion {
  std::string_view with, broken_by;
};

struct EffectFamily {
  std::string_view name;
  Level level{Level::axis};
  std::string_view title;         ///< "offset follows temperature"
  std::string_view cause;         ///< physics, a sentence
  std::string_view equation;      ///< as the code computes it
  std::string_view coefficients;  ///< names and units, for a person
  double typical{1};              ///< of one coefficient, in its unit (Coefficient::unit)
  double bound{0};                ///< beyond this a coefficient is not believed
  std::string_view source;        ///< of the typical size
  /// Scales it can be tested at, finest first; `own` alone for effects of site and table.
  std::span<const Where::Scale> scales;
  std::optional<Scan> scan;
  /// Columns without which it cannot be evaluated: "T_degC" stands for each sensor's own.
  std::string_view needs;
  std::string_view signature;  ///< how it shows in the residual
  std::span<const Confusion> confusions;
  /// Not empty: no residual can show it, for this reason; `experiment` says what would.
  std::string_view untestable, experiment;
  Result<EffectPtr> (*from_spec)(const EffectSpec&){nullptr};
};

/// In the order of the library's page.
[[nodiscard]] std::span<const EffectFamily> effect_families();
[[nodiscard]] std::span<const EffectFamily> axis_families();
[[nodiscard]] std::span<const EffectFamily> nonlinearity_families();
[[nodiscard]] std::span<const EffectFamily> platform_families();
[[nodiscard]] std::span<const EffectFamily> table_families();
[[nodiscard]] std::span<const EffectFamily> site_families();
/// Null when there is none of that name.
[[nodiscard]] const EffectFamily* find_family(std::string_view name);

/// The numbers a score test tries; empty for a family without a scan. `run` ranges need the context's table.
[[nodiscard]] std::vector<double> scan_values(const EffectFamily& family, const EffectContext& context);

/// Poses that a step must leave on either side: fewer that differ from all others are bad poses.
inline constexpr std::size_t kStepPoses = 3;

/// Hours half-way between successive poses, ascending: the times that a step may have.
[[nodiscard]] std::vector<double> run_gaps_h(const EffectContext& context);

/// An effect of a family on a run. `where` defaults to the family's own (each-axis for sensors and axes).
[[nodiscard]] Result<EffectPtr> make(const EffectFamily& family, std::optional<Where> where,
                                     std::optional<double> scan, const EffectContext& context);

}  // namespace mgtd::calib::effects::library
