// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/control_lease.h"

#include <fmt/format.h>

#include <algorithm>

namespace mgtd::daemon::serve {

bool needs_control(ControlCommand command) {
  switch (command) {
    case ControlCommand::version:
    case ControlCommand::status:
    case ControlCommand::run_dry_run:
    case ControlCommand::run_pause:
    case ControlCommand::run_abort:
    case ControlCommand::run_status:
    case ControlCommand::run_course:
    case ControlCommand::run_events:
    case ControlCommand::calibrations_list:
    case ControlCommand::calibrations_history:
    case ControlCommand::calibrations_show:
    case ControlCommand::magnet_status:
    case ControlCommand::magnet_stop:
    case ControlCommand::control_take:
    case ControlCommand::control_release:
    case ControlCommand::control_break:
    case ControlCommand::console:
      return false;
    case ControlCommand::run_start:
    case ControlCommand::run_resume:
    case ControlCommand::run_finish:
    case ControlCommand::run_enter:
    case ControlCommand::run_redo:
    case ControlCommand::magnet_start:
    case ControlCommand::calibrations_accept:
    case ControlCommand::calibrations_import:
    case ControlCommand::calibrations_reject:
    case ControlCommand::calibrations_rollback:
      return true;
  }
  return true;
}

std::string name(const ControlPeer& peer) {
  if (!peer.via.empty()) return peer.via;
  return peer.pid > 0 ? fmt::format("pid {} (uid {})", peer.pid, peer.uid)
                      : fmt::format("a pid not known (uid {})", peer.uid);
}

const ControlLease::Hold* ControlLease::held(Instant now) const {
  return hold_ && now < hold_->until ? &*hold_ : nullptr;
}

Error ControlLease::refusal(Instant now) const {
  const std::string who = name(hold_->peer);
  const double left_s = to_seconds(hold_->until - now);
  return {ErrorCode::state,
          fmt::format("control is with {} since {}{}", who, format_utc(hold_->since.wall),
                      hold_->why.empty() ? "" : ": " + hold_->why),
          fmt::format("it is free when that program ends or has said nothing for another {:.0f} s; mgt run "
                      "pause and mgt run abort work for everyone; mgt control break takes it away",
                      std::max(1.0, left_s))};
}

Result<void> ControlLease::admit(const ControlPeer& peer, ControlCommand command, Stamp now) {
  const bool own = held(now.mono) != nullptr && hold_->peer.connection == peer.connection;
  if (own && (hold_->taken || needs_control(command))) hold_->until = now.mono + hold_->kept;
  if (own || !needs_control(command)) return {};
  if (held(now.mono) != nullptr) return tl::unexpected(refusal(now.mono));
  const Duration kept = from_seconds(kKept_s);
  hold_ = Hold{.peer = peer, .since = now, .until = now.mono + kept, .kept = kept, .taken = false, .why = {}};
  return {};
}

Result<ControlHolder> ControlLease::take(const ControlPeer& peer, const TakeRequest& wish, Stamp now) {
  const Hold* const by = held(now.mono);
  if (by != nullptr && by->peer.connection != peer.connection) return tl::unexpected(refusal(now.mono));
  const Duration kept = from_seconds(wish.idle_s);
  hold_ = Hold{.peer = peer,
               .since = by != nullptr ? by->since : now,
               .until = now.mono + kept,
               .kept = kept,
               .taken = true,
               .why = wish.why};
  return *holder(now.mono);
}

Result<void> ControlLease::release(const ControlPeer& peer, Instant now) {
  if (held(now) == nullptr) return {};
  if (hold_->peer.connection != peer.connection) return tl::unexpected(refusal(now));
  hold_.reset();
  return {};
}

std::optional<ControlHolder> ControlLease::break_hold(Instant now) {
  auto was = holder(now);
  hold_.reset();
  return was;
}

void ControlLease::ended(std::uint64_t connection) {
  if (hold_ && hold_->peer.connection == connection) hold_.reset();
}

std::optional<ControlHolder> ControlLease::holder(Instant now) const {
  const Hold* const by = held(now);
  if (by == nullptr) return std::nullopt;
  return ControlHolder{.pid = by->peer.pid,
                       .uid = by->peer.uid,
                       .via = by->peer.via,
                       .since = by->since.wall,
                       .taken = by->taken,
                       .why = by->why,
                       .left_s = to_seconds(by->until - now)};
}

}  // namespace mgtd::daemon::serve
