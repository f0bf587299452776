// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <optional>
#include <vector>

#include "daemon/plan/run_duration.h"
#include "daemon/plan/run_plan.h"
#include "proto/time.h"

/// RunProgress keeps how much of a plan is done, which pose is under way and how often it failed, and how
/// long the rest will take. The estimate starts from the table's speed and learns from every pose: what it
/// took beside its dwell, against what was foreseen.
namespace mgtd::daemon::run {

class RunProgress {
 public:
  RunProgress(const plan::RunPlan& plan, plan::Pace pace);

  void extend(const plan::RunPlan& plan, plan::Pace pace);      ///< by the poses behind those that it knows
  void set_done(std::size_t index) { done_.at(index) = true; }  ///< in an earlier life of the run
  void undo(std::size_t index) { done_.at(index) = false; }     ///< to be measured again
  [[nodiscard]] bool is_done(std::size_t index) const { return done_.at(index); }
  void begin(std::size_t index, Instant now);  ///< again after a pause: the pause does not count
  void finish(std::size_t index, Instant now);
  /// No further pose: what is done is enough.
  void cut_short() { cut_ = true; }

  [[nodiscard]] std::size_t done() const;
  [[nodiscard]] std::optional<std::size_t> next()
      const;  ///< first that is not done; empty: none, or cut short
  [[nodiscard]] bool cut() const { return cut_; }
  [[nodiscard]] std::size_t index() const { return index_; }  ///< of the pose begun last; 0 before the first
  [[nodiscard]] std::optional<std::size_t> last() const { return last_; }  ///< finished last in this life
  void forget_last() { last_.reset(); }

  /// An attempt at the pose under way failed; returns how many did.
  int failed();
  /// It is measured again through no fault of its own.
  void repeat() { ++retries_; }
  void forgive() { attempt_ = 0; }                        ///< failed attempts count anew
  [[nodiscard]] int retries() const { return retries_; }  ///< of the whole run
  [[nodiscard]] double remaining_s(Instant now) const;

 private:
  [[nodiscard]] double factor() const;

  std::vector<double> dwell_s_, overhead_s_;  ///< foreseen, per pose
  std::vector<bool> done_;
  double solve_s_;
  double foreseen_s_, measured_s_;      ///< overheads so far; starts with a prior of a few poses
  std::optional<std::size_t> current_;  ///< begun and not finished
  Instant begun_{};
  std::size_t index_{0};
  std::optional<std::size_t> last_;
  int attempt_{0}, retries_{0};
  bool cut_{false};
};

}  // namespace mgtd::daemon::run
