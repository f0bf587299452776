// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "proto/error.h"

/// The host rule decides from the head of a request whether a browser may be answered.
///
/// A browser sends requests for every page that it shows. What tells the console's own page from another is
///
///     Host            where the browser believes to be: a name of the list, with the port. After DNS
///                     rebinding it is the name of the attacker.
///     Origin          whose page asks, where a browser sends it: http://NAME:PORT of the same list, never
///                     merely equal to Host.
///     Sec-Fetch-Site  where a browser sends it: same-origin, or none (typed by a person).
///
/// A WebSocket has no other protection than these (browsers let every page open one), so it needs an Origin;
/// a script without one uses the stream's own socket. Pure. Does not know tokens (console_token.h).
namespace mgtd::daemon::serve::console {

/// What counts of a request's head; views into it.
struct RequestHead {
  std::string_view host;
  std::optional<std::string_view> origin{}, fetch_site{};
  bool websocket{false};
};

class HostRule {
 public:
  /// `names`: host names and addresses without port ("rig7.local", "10.0.0.5", "::1"); loopback is always
  /// among them.
  HostRule(std::uint16_t port, const std::vector<std::string>& names);

  /// Refused with the header, what it was, and what to do.
  [[nodiscard]] Result<void> admit(const RequestHead& head) const;

 private:
  [[nodiscard]] bool known(std::string_view host) const;

  std::vector<std::string> hosts_;  ///< with port, in lower case
};

}  // namespace mgtd::daemon::serve::console
