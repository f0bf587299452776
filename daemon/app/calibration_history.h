// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <utility>

#include "calib/report/parameter_history.h"
#include "daemon/store/calibration_store.h"

/// CalibrationHistory answers `calibrations.history` with the history of a rig's calibrations: who decided
/// what, and how the parameters moved from one calibration to the next.
///
///   {"decisions":[{"t","event","id","origin","forced","why","by"}],
///    "moves":[parameter_history.h], "figure":{"name","title","svg","caption","good"} or null,
///    "unreadable":[ids]}
///
/// Moves are between neighbours in the order in which they were proposed, without those that were rejected
/// and those of another number of sensors than the newest; the latest of them, as many as one answer holds.
/// `by` is empty where an earlier version did not keep it. A pair is compared once: calibrations do not
/// change.
namespace mgtd::daemon::app {

class CalibrationHistory {
 public:
  /// `store` must outlive it.
  explicit CalibrationHistory(const store::CalibrationStore& store) : store_(store) {}

  [[nodiscard]] nlohmann::ordered_json report();

 private:
  [[nodiscard]] const calib::report::ParameterMoves* between(const std::string& from, const std::string& to);
  /// How many sensors a calibration is of; 0 where its file cannot be read.
  [[nodiscard]] std::size_t sensors_of(const std::string& id);

  const store::CalibrationStore& store_;
  std::map<std::string, std::size_t> sensors_;  ///< by id
  std::map<std::pair<std::string, std::string>, calib::report::ParameterMoves> moves_;
};

}  // namespace mgtd::daemon::app
