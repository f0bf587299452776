// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include <boost/asio/ip/tcp.hpp>
#include <string>

/// Inherited sockets are listening sockets that the service manager opened before the daemon started and
/// keeps while it is away (sd_listen_fds(3): LISTEN_PID, LISTEN_FDS). A client that connects while the daemon
/// starts again waits instead of being refused. Recognised by where they listen, not by name or order.
namespace mgtd::daemon::serve {

/// The inherited socket that listens there, close-on-exec and non-blocking; -1 when there is none. Each is
/// given away once.
[[nodiscard]] int take_inherited_unix(const std::string& path);
[[nodiscard]] int take_inherited_tcp(const boost::asio::ip::tcp::endpoint& endpoint);

}  // namespace mgtd::daemon::serve
