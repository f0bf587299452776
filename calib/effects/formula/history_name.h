// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

/// A HistoryName is a name in a formula that looks back over the run:
///
///     prev_X       X at the pose before                              its unit
///     lag600_X     X behind a low-pass of 600 s, dz/dt = (X - z)/tau its unit
///     rate_X       slope of X over the nine poses around             its unit an hour
///
/// X is T_degC (the sensor's own), s3_T_degC, a reading s3_x_nT, or, of prev alone, u, ux, uy, uz; of a lag
/// any column, too. What else begins with prev_ or rate_ is a column of the user's own, like rate_hz. X is
/// taken to go straight from pose to pose; the low-pass begins at rest. A pose before which there is none has
/// no prev_X.
namespace mgtd::calib::effects::formula {

struct HistoryName {
  enum class Kind { previous, lag, rate };
  Kind kind{Kind::previous};
  double tau_s{0};  ///< of a lag
  std::string of;   ///< X
};

/// Empty where the name does not look back.
[[nodiscard]] std::optional<HistoryName> history_name(std::string_view name);

/// Its values at the poses of a run, in the order they were measured; NaN where there is none.
[[nodiscard]] std::vector<double> history(const HistoryName& name, std::span<const double> t_h,
                                          std::span<const double> of);

}  // namespace mgtd::calib::effects::formula
