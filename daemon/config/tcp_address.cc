// SPDX-License-Identifier: Apache-2.0
#include "daemon/config/tcp_address.h"

#include <fmt/format.h>

#include <boost/asio/ip/address.hpp>
#include <string>

#include "proto/number.h"

namespace mgtd::daemon::config {

Result<boost::asio::ip::tcp::endpoint> parse_tcp_address(std::string_view text) {
  const auto bad = [&] {
    return fail(ErrorCode::bad_input, fmt::format("'{}' is not a TCP address", text),
                "write a number address and a port, like 127.0.0.1:7450 or [::1]:7450");
  };
  const std::size_t colon = text.rfind(':');
  if (colon == std::string_view::npos) return bad();
  std::string host(text.substr(0, colon));
  const auto port = parse_integer(text.substr(colon + 1));
  if (!port || *port < 0 || *port > 65'535) return bad();
  if (host.starts_with('[') && host.ends_with(']')) {
    host = host.substr(1, host.size() - 2);
  } else if (host.find(':') != std::string::npos) {
    return bad();
  }
  if (host == "localhost") host = "127.0.0.1";
  boost::system::error_code ec;
  const auto address = boost::asio::ip::make_address(host, ec);
  if (ec) return bad();
  return boost::asio::ip::tcp::endpoint(address, static_cast<std::uint16_t>(*port));
}

}  // namespace mgtd::daemon::config
