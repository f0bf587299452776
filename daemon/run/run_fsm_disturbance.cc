// SPDX-License-Identifier: Apache-2.0
// A field that does not stand still: the dwell is suspended, and goes on by itself.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "daemon/run/run_fsm.h"

namespace mgtd::daemon {

namespace {

constexpr double kSamePlace_rad = 1e-3;

bool elsewhere(const TableAngles& a, const TableAngles& b) {
  return std::abs(a.azimuth_rad - b.azimuth_rad) > kSamePlace_rad ||
         std::abs(a.pitch_rad - b.pitch_rad) > kSamePlace_rad ||
         std::abs(a.roll_rad - b.roll_rad) > kSamePlace_rad;
}

}  // namespace

/// When the table really came to rest: a pose that is measured again does not begin a new rest.
void RunFsm::follow_rest(const TableReading& reading) {
  if (reading.moving || (rests_ && elsewhere(rests_->angles, reading.angles))) rests_.reset();
  if (!reading.moving && !rests_) rests_ = reading;
}

std::optional<Instant> RunFsm::stopped() const {
  const auto told = settle_->stopped();
  return rests_ && told ? std::min(rests_->arrival.mono, *told) : told;
}

void RunFsm::watch_field(Instant from) {
  still_.emplace(config_.dwell.rate_hz, from);
  judged_ = 0;
}

/// Judged once for every block.
std::optional<FieldDisturbance> RunFsm::disturbed(double length_s) {
  if (!still_ || still_->blocks() == judged_) return std::nullopt;
  judged_ = still_->blocks();
  return unrest(*still_, field_noise_, config_.unrest,
                static_cast<std::size_t>(std::ceil(length_s / FieldBlocks::kBlock_s)));
}

/// What came while the table moved, and stands there now, is not seen by a dwell.
std::optional<std::string> RunFsm::at_another_level(std::optional<double> f_nT) const {
  if (!level_nT_ || !f_nT || config_.field_step_nT <= 0 ||
      std::abs(*f_nT - *level_nT_) <= config_.field_step_nT)
    return std::nullopt;
  return fmt::format(
      "the scalar reference reads {:.1f} nT, {:+.1f} nT against the pose before (limit {:.1f} nT)", *f_nT,
      *f_nT - *level_nT_, config_.field_step_nT);
}

void RunFsm::suspend(const std::string& why) {
  ++retries_;
  const bool railed = dwell_ && dwell_->quality().saturated > 0;
  dwell_.reset();
  watch_field(now_.mono);
  if (!disturbed_since_) disturbed_since_ = now_.mono;
  enter(Phase::suspended,
        fmt::format("pose {} is suspended: {}; {}; it is measured again when the field is calm",
                    planned().number, why,
                    railed ? "a sensor is at the end of its range: look at its supply and range, and for "
                             "magnets and iron near it"
                           : "something magnetic is passing or has been put down nearby, or the array itself "
                             "moves"));
  act(Record{message_});
}

void RunFsm::advance_suspended() {
  if (!homed_) return lost_reference();
  if (to_seconds(now_.mono - *disturbed_since_) > config_.calm_max_s) {
    hold(fmt::format(
        "{}; it has not become so within {:.0f} s: look what moves or was put down near the array "
        "and the reference; mgt run resume takes the field as it is",
        message_, config_.calm_max_s));
    return;
  }
  if (disturbed(config_.calm_s)) return watch_field(now_.mono);
  if (static_cast<double>(still_->blocks()) * FieldBlocks::kBlock_s < config_.calm_s) return;
  const std::vector<double>& f_nT = still_->scalar_nT();
  std::optional<double> mean_nT;
  if (!f_nT.empty())
    mean_nT = std::accumulate(f_nT.begin(), f_nT.end(), 0.0) / static_cast<double>(f_nT.size());
  if (at_another_level(mean_nT)) return watch_field(now_.mono);
  act(Record{fmt::format("the field is calm after {:.0f} s: pose {} is measured again",
                         to_seconds(now_.mono - entered_), planned().number)});
  go_on();
}

}  // namespace mgtd::daemon
