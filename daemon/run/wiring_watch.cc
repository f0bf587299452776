// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/wiring_watch.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <utility>

namespace mgtd::daemon::run {

std::optional<Check> WiringWatch::add(const Pose& pose) {
  constexpr std::size_t kFirst = 4, kLast = 32;
  if (wiring_.attitudes() >= kLast) return std::nullopt;
  wiring_.add(pose.y_nT, pose.angles());
  const std::size_t seen = wiring_.attitudes();
  if (seen < kFirst || (seen & (seen - 1)) != 0) return std::nullopt;
  std::vector<std::string> findings = wiring_.findings();
  if (findings == said_) return std::nullopt;
  said_ = std::move(findings);
  return Check{"wiring", said_.empty(),
               said_.empty() ? alike_in_words(pose.y_nT.size()) : fmt::format("{}", fmt::join(said_, "; ")),
               pose.y_nT.size() == 1 ? std::string("turning as the table does")
                                     : alike_in_words(pose.y_nT.size()) + ", turning as the table does",
               "if it is meant so, go on: the calibration finds every mounting; else look at the sensor's "
               "place and the wires of its axes"};
}

}  // namespace mgtd::daemon::run
