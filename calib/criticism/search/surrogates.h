// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <set>
#include <string>

#include "calib/criticism/search/explain_report.h"
#include "calib/criticism/tests/criticism.h"

/// Surrogates are effects that describe a law of no library without being its cause. Enough laws follow any
/// curve, so a search that goes on adds one after the other to the axis on which the unknown law acts, and
/// each looks significant. The signs of it:
///
///   - three effects or more on one axis; where nothing is left after them and all depend on temperature,
///     the linear and the square term of one dependence count as one: they describe its curve, as meant;
///   - two on one axis that leave most of what is left there; or of all axes, seen on this one, if each of
///     them took little away;
///   - two on one sensor that leave more than a tenth of the misfit, most of it on this sensor: nothing is
///     then named at all, because what bends a sensor bends the others through the field of the pose;
///   - effects, wherever they act, after which most of the misfit is still there, on one axis.
namespace mgtd::calib::criticism::search {

struct Surrogates {
  std::string where{};   ///< "s3.z" or "s3"; empty where there are none
  std::size_t first{0};  ///< the first round that is one of them
  [[nodiscard]] bool any() const { return !where.empty(); }
  [[nodiscard]] bool whole_sensor() const { return any() && where.find('.') == std::string::npos; }
};

/// Axes that the effects of a round were put on one by one.
[[nodiscard]] std::set<std::string> axes_of(const Round& round);

/// Of the misfit that the first round found, squared and beyond the noise, what all of them leave; 0 where
/// the noise is not known. `report` has a round.
[[nodiscard]] double share_left(const ExplainReport& report);

/// That share from which on several effects are not what is there.
inline constexpr double kMuch = 0.1;

/// In the rounds of `report`, after which `last` was found. What is left on an axis that is `closed` to names
/// already is no sign against the other rounds.
[[nodiscard]] Surrogates find_surrogates(const ExplainReport& report, const tests::Criticism& last,
                                         const std::set<std::string>& closed);

}  // namespace mgtd::calib::criticism::search
