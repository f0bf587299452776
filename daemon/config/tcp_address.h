// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include <boost/asio/ip/tcp.hpp>
#include <string_view>

#include "proto/error.h"

/// A TcpAddress is an address as the configuration and the command line write it.
namespace mgtd::daemon::config {

/// "127.0.0.1:7450", "[::1]:7450", "localhost:7450" (the IPv4 loopback). Other names are not looked up.
[[nodiscard]] Result<boost::asio::ip::tcp::endpoint> parse_tcp_address(std::string_view text);

}  // namespace mgtd::daemon::config
