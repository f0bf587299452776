// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "tests/rig/effect.h"

/// An EffectKind describes an effect as data: its name, the numbers it takes, and what it does with them.
/// Those that depend on the present only are a function; the others are a class that `build` makes.
namespace mgtd::rig {

enum class Scope { none, sensor, axis };  ///< what "where" may name

/// One key of an effect: `count` numbers.
struct Key {
  const char* name{nullptr};
  int count{1};
  double typical{1};  ///< a size worth finding: several sigma of a default run with 0.3 nT pose noise
  /// Where a random effect draws it from instead, for numbers inside the law (times, widths).
  double low{0}, high{0};
  double fallback{std::numeric_limits<double>::quiet_NaN()};  ///< of an absent key; NaN: it must be there
};

/// The numbers of an effect, key after key, and the covariate it hangs on.
struct Numbers {
  std::vector<double> value;
  double covariate{0};
  [[nodiscard]] double operator[](std::size_t i) const { return value[i]; }
  [[nodiscard]] Eigen::Vector3d vector(std::size_t first = 0) const {
    return {value[first], value[first + 1], value[first + 2]};
  }
};

struct EffectKind {
  const char* name;
  Scope scope{Scope::none};
  std::array<Key, 4> keys{};
  bool needs_covariate{false};  ///< key `of`
  /// The program's library has no name for it: what is left for the generic maps.
  bool unnamed{false};
  double (*axis)(const AxisContext&, const Numbers&){nullptr};
  Eigen::Vector3d (*site)(double t_s, const Eigen::Vector3d& x_m, const Numbers&){nullptr};
  Eigen::Vector3d (*platform)(const PlatformContext&, const Numbers&){nullptr};
  Eigen::Vector3d (*turn_rad)(const PlatformContext&, const Numbers&){nullptr};
  TableError (*table)(const TableContext&, const Numbers&){nullptr};
  double (*reference)(const Eigen::Vector3d& u, const Numbers&){nullptr};
  std::unique_ptr<Effect> (*build)(const EffectKind&, const Where&, const Numbers&){nullptr};
};

/// Level by level; all_kinds() is their sum.
[[nodiscard]] std::span<const EffectKind> axis_kinds();
[[nodiscard]] std::span<const EffectKind> platform_kinds();
[[nodiscard]] std::span<const EffectKind> site_kinds();
[[nodiscard]] std::span<const EffectKind> table_kinds();
[[nodiscard]] std::span<const EffectKind> unnamed_kinds();
[[nodiscard]] std::vector<const EffectKind*> all_kinds();

/// What every kind without a class of its own becomes.
[[nodiscard]] std::unique_ptr<Effect> make_effect(const EffectKind& kind, const Where& where, Numbers numbers,
                                                  const std::string& covariate);

}  // namespace mgtd::rig
