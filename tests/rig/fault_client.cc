// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/fault_client.h"

#include <boost/asio/io_context.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/streambuf.hpp>
#include <boost/asio/write.hpp>
#include <istream>

namespace mgtd::rig {
namespace {

/// sockaddr_un holds so many characters and a zero.
constexpr std::size_t kLongestPath = 107;

}  // namespace

std::string fault_socket(const std::string& dir) { return dir + "/fault.sock"; }

std::optional<std::string> ask_rig(const std::string& dir, const std::string& line) {
  return ask_socket(fault_socket(dir), line);
}

std::optional<std::string> ask_socket(const std::string& path, const std::string& line) {
  namespace asio = boost::asio;
  using local = asio::local::stream_protocol;
  if (path.size() > kLongestPath) return std::nullopt;
  asio::io_context io(1);
  local::socket socket(io);
  boost::system::error_code ec;
  socket.connect(local::endpoint(path), ec);
  if (!ec) asio::write(socket, asio::buffer(line + "\n"), ec);
  if (ec) return std::nullopt;
  asio::streambuf buffer;
  asio::read_until(socket, buffer, '\n', ec);
  std::istream in(&buffer);
  std::string answer;
  if (!std::getline(in, answer)) return std::nullopt;
  return answer;
}

}  // namespace mgtd::rig
