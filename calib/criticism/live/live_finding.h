// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <string_view>
#include <vector>

#include "calib/sensor/channels.h"

/// A LiveFinding holds what live criticism found, as values; calib/report/live_report.h puts it into words.
namespace mgtd::calib::criticism::live {

enum class LiveState { none, learning, ok, suspect, near_source, exchanged, turned };
/// As the status and the stream write it: "near source".
[[nodiscard]] std::string_view to_string(LiveState state);

enum class Follows { temperature, time, attitude };

/// How well the closure of one window follows one quantity of the instrument's.
struct Following {
  bool tested{false};  ///< the window has enough blocks and x moves enough in it
  double log10_p{0};   ///< of so much by chance
  double share{0};     ///< of what the closure does beyond its noise
  /// The same of the best single interval of time: something that came and stayed or went, and follows
  /// nothing.
  double event_share{0};
  /// The quantity of the closure (of the cross 0 curl, 1..3 centre x, y, z) in which it is largest for the
  /// standard deviation that the calibration states there: slope per unit of x, the swing over the window,
  /// that standard deviation.
  int component{0};
  double slope{0}, slope_sd{0}, swing{0}, stated_sd{0}, range{0};
};

/// The quantity that the closure of a window follows.
struct FollowedQuantity {
  Follows what{Follows::temperature};
  Following evidence;
  double minutes{0};            ///< length of the window
  std::vector<Follows> also{};  ///< quantities that explain nearly as much, because they moved together
};

/// The mean closure of ten seconds that noise and calibration do not explain.
struct LargeClosure {
  sensor::FieldVector closure{};  ///< of the cross curl (nT/m), centre x, y, z (nT); else nT
  double samples{0};
  double log10_p{0};
  std::vector<Follows> tested{};  ///< quantities that it was found not to follow
};

struct LiveFinding {
  LiveState state{LiveState::none};            ///< never exchanged or turned: see rearrangement.h
  std::optional<FollowedQuantity> followed{};  ///< in state suspect
  std::optional<LargeClosure> large{};         ///< in state near_source; in state suspect it may be there too
  bool cross{true};  ///< the closure has the names of the cross; else it is numbers of FieldExpansion, nT
};

}  // namespace mgtd::calib::criticism::live
