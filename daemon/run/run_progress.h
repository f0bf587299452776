// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "daemon/plan/run_duration.h"
#include "daemon/plan/run_plan.h"
#include "proto/time.h"

/// How much of a plan is done and how long the rest will take. The estimate starts from the table's speed and
/// learns from every pose: what it took beside its dwell, against what was foreseen.
namespace mgtd::daemon {

class RunProgress {
 public:
  RunProgress(const RunPlan& plan, Pace pace);

  void set_done(std::size_t index) { done_.at(index) = true; }  ///< in an earlier life of the run
  void undo(std::size_t index) { done_.at(index) = false; }     ///< to be measured again
  [[nodiscard]] bool is_done(std::size_t index) const { return done_.at(index); }
  void begin(std::size_t index, Instant now);  ///< again after a pause: the pause does not count
  void finish(std::size_t index, Instant now);

  [[nodiscard]] std::size_t done() const;
  [[nodiscard]] std::optional<std::size_t> next() const;  ///< first that is not done
  [[nodiscard]] double remaining_s(Instant now) const;

 private:
  [[nodiscard]] double factor() const;

  std::vector<double> dwell_s_, overhead_s_;  ///< foreseen, per pose
  std::vector<bool> done_;
  double solve_s_;
  double foreseen_s_, measured_s_;  ///< overheads so far; starts with a prior of a few poses
  std::optional<std::size_t> current_;
  Instant begun_{};
};

}  // namespace mgtd::daemon
