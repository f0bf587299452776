// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "proto/control_codec.h"
#include "proto/control_hold.h"
#include "proto/error.h"
#include "proto/time.h"

/// The lease decides which client may change things: one controls, many look. Pure: connections are numbers,
/// time comes in.
///
/// - To look (status, run.status, dry-run, lists) needs no control.
/// - The first request that changes something takes control for its connection. It keeps it until it ends,
///   or until kKept_s have passed since its last change: commands that connect, ask and go, one after the
///   other and from several terminals, never stand in each other's way.
/// - control.take keeps it until control.release, the end of the connection, or the silence it stated.
/// - Pause and abort are never refused: everyone who may use the socket may stop the table.
/// - control.break takes control away from whoever has it; who breaks does not get it thereby.
namespace mgtd::daemon::serve {

struct ControlPeer {
  std::uint64_t connection{0};
  std::int64_t pid{0};  ///< 0: not known
  std::int64_t uid{0};
  std::string via{};  ///< "the console, from 127.0.0.1"; empty: the control socket
};

/// For people: "pid 812 (uid 1000)", "the console, from 127.0.0.1".
[[nodiscard]] std::string name(const ControlPeer& peer);

class ControlLease {
 public:
  static constexpr double kKept_s = 10;

  /// May this be carried out? Takes control when it has to. Refused (ErrorCode::state) with who has it, since
  /// when, and what to do.
  [[nodiscard]] Result<void> admit(const ControlPeer& peer, ControlCommand command, Stamp now);
  [[nodiscard]] Result<ControlHolder> take(const ControlPeer& peer, const TakeRequest& wish, Stamp now);
  /// Gives back what this connection has; refused when it is another's.
  [[nodiscard]] Result<void> release(const ControlPeer& peer, Instant now);
  /// Whose it was, if anyone's.
  std::optional<ControlHolder> break_hold(Instant now);
  void ended(std::uint64_t connection);

  [[nodiscard]] std::optional<ControlHolder> holder(Instant now) const;

 private:
  struct Hold {
    ControlPeer peer;
    Stamp since;
    Instant until;
    Duration kept;
    bool taken{false};
    std::string why;
  };
  [[nodiscard]] const Hold* held(Instant now) const;
  [[nodiscard]] Error refusal(Instant now) const;

  std::optional<Hold> hold_;
};

/// False for what only looks, and for what is never refused.
[[nodiscard]] bool needs_control(ControlCommand command);

}  // namespace mgtd::daemon::serve
