// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "daemon/serve/console/console_server.h"
#include "tests/support/event_loop.h"
#include "tests/support/line_peer.h"

/// A console server on a free port, and a client made of system calls: what a browser sends, and what others
/// send.
namespace mgtd::daemon::serve::console::test {

using mgtd::testing::LinePeer;
using mgtd::testing::run_until;

/// A text frame of a client, masked with zeros.
inline std::string frame(std::string_view text) {
  std::string out{static_cast<char>(0x81), static_cast<char>(0x80 | text.size())};
  out.append(4, '\0');
  out += text;
  return out;
}

class ConsoleServerBench : public ::testing::Test {
 protected:
  void start(ConsoleConfig config = {}) {
    config.listen = "127.0.0.1:0";
    server_ = std::make_unique<ConsoleServer>(
        io_, config,
        ConsoleSource{
            .hello = [] { return std::string(R"({"rig":"bench"})"); },
            .metrics = [] { return std::string("mgtd_up 1\n"); },
            .course = [] { return std::string("{\"run_id\":\"monday\"}\n"); },
            .events = []() -> Result<std::string> {
              return fail(ErrorCode::io, "the run file cannot be read");
            },
            .lane = [](std::string_view query) -> Result<std::string> { return std::string(query); },
            .stream = [this](const std::shared_ptr<Peer>& peer) { feed(peer); },
            .control = [this](const std::shared_ptr<Peer>& peer,
                              const std::string& via) { obey(peer, via); }});
    const auto started = server_->start();
    ASSERT_TRUE(started) << started.error().text();
    const std::string address = server_->address();
    host_ = address.substr(7, address.size() - 8);
  }
  void feed(const std::shared_ptr<Peer>& peer) {
    streamed_.push_back(peer);
    peer->start({.on_line = [this](std::string_view line) { heard_.emplace_back(line); },
                 .on_overlong = [] {},
                 .refill = [](std::string&) {},
                 .keep_after_end = {},
                 .on_close = [this](std::string_view) { ++closed_; }});
    peer->send("{\"class\":\"HELLO\"}\n");
  }
  void obey(const std::shared_ptr<Peer>& peer, const std::string& via) {
    via_ = via;
    feed(peer);
  }
  [[nodiscard]] LinePeer connect() const {
    return LinePeer::tcp(static_cast<std::uint16_t>(std::stoi(host_.substr(host_.rfind(':') + 1))));
  }
  /// Sends a request and waits for an answer that holds `until`.
  LinePeer ask(const std::string& request, const std::string& until) {
    LinePeer peer = connect();
    peer.send(request);
    EXPECT_TRUE(wait(peer, until)) << until << "\n" << request;
    return peer;
  }
  bool wait(LinePeer& peer, const std::string& text) {
    return run_until(io_,
                     [&] {
                       peer.pump();
                       return peer.count(text) > 0 || peer.closed;
                     }) &&
           peer.count(text) > 0;
  }
  [[nodiscard]] std::string get(const std::string& target, const std::string& more = "") const {
    return "GET " + target + " HTTP/1.1\r\nHost: " + host_ + "\r\n" + more + "\r\n";
  }
  [[nodiscard]] std::string upgrade(const std::string& target, const std::string& more) const {
    return get(target,
               "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
               "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n" +
                   more);
  }
  [[nodiscard]] std::string own() const { return "Origin: http://" + host_ + "\r\n"; }

  boost::asio::io_context io_;
  std::unique_ptr<ConsoleServer> server_;
  std::string host_, via_;
  std::vector<std::shared_ptr<Peer>> streamed_;
  std::vector<std::string> heard_;
  int closed_{0};
};

}  // namespace mgtd::daemon::serve::console::test
