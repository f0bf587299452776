// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "proto/time.h"

/// A RunLog is what a run has written down of itself, the latest entries in the order of time: poses that
/// were bad or disturbed, pauses and what the operator did about them, lost devices, judgements. It answers
/// `run.events` on the control socket and GET /run/events of the console:
///
///   {"run_id","left_out","events":[{"t","what"}]}
///
/// `left_out`: how many earlier entries are not told; the run file has them all.
namespace mgtd {

struct RunLogEntry {
  WallTime t{};
  std::string what{};
};

struct RunLog {
  /// A screen shows no more, and an answer stays small.
  static constexpr std::size_t kMostEntries = 500;

  std::string run_id{};  ///< empty: no run
  std::size_t left_out{0};
  std::vector<RunLogEntry> entries{};
};

/// Of all entries of a run, the latest.
[[nodiscard]] RunLog latest_of(std::string run_id, std::vector<RunLogEntry> all);

[[nodiscard]] nlohmann::ordered_json to_json(const RunLog& log);

}  // namespace mgtd
