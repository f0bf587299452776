// SPDX-License-Identifier: Apache-2.0
// Who comes to the console to do harm: slow requests, half ones, paths that leave the page, floods, guessed
// tokens.
#include <spdlog/sinks/ringbuffer_sink.h>
#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <memory>
#include <string>
#include <vector>

#include "tests/unit/daemon/serve/console/console_server_bench.h"

namespace mgtd::daemon::serve::console {
namespace {

using test::frame;
using test::LinePeer;
using test::run_until;
using namespace std::chrono_literals;

class ConsoleDoor : public test::ConsoleServerBench {
 protected:
  /// Pumps all until the server has hung up on each of them.
  bool all_hung_up(std::vector<LinePeer>& peers) {
    return run_until(io_, [&] {
      bool all = true;
      for (LinePeer& peer : peers) {
        peer.pump();
        all = all && peer.closed;
      }
      return all;
    });
  }
};

/// A header line every now and then never completes a request: the time is that of the whole, not of a byte.
TEST_F(ConsoleDoor, ASlowRequestIsHungUpOnWhileItsBytesStillCome) {
  start({.patience = 100ms});
  LinePeer slow = connect();
  slow.send("GET / HTTP/1.1\r\nHost: " + host_ + "\r\n");
  std::size_t sent = 0;
  EXPECT_TRUE(run_until(io_, [&] {
    if (sent < 1000) sent += slow.send("A");
    slow.pump();
    return slow.closed;
  }));
  EXPECT_TRUE(slow.lines.empty());
  ask(get("/metrics"), "mgtd_up 1");
}

TEST_F(ConsoleDoor, HalfARequestAndHalfAHandshakeAreHungUpOn) {
  start({.patience = 50ms});
  const std::string whole = upgrade("/stream", own());
  std::vector<LinePeer> peers;
  for (const std::string& part : {std::string(), std::string("GET"), whole.substr(0, whole.size() / 2),
                                  whole.substr(0, whole.size() - 2)}) {
    peers.push_back(connect());
    peers.back().send(part);
  }
  EXPECT_TRUE(all_hung_up(peers));
  EXPECT_TRUE(streamed_.empty());
}

/// Neither one that says nothing after the handshake, nor one that begins a frame and does not end it.
TEST_F(ConsoleDoor, ControlWithoutATokenIsHungUpOn) {
  start({.patience = 50ms});
  std::vector<LinePeer> peers;
  for (const std::string& part :
       {std::string(), std::string("\x81\xa0", 2), frame("{\"token\":\"").substr(0, 9)}) {
    peers.push_back(ask(upgrade("/control", own()), "101 Switching"));
    peers.back().send(part);
  }
  EXPECT_TRUE(all_hung_up(peers));
  EXPECT_TRUE(via_.empty());
}

TEST_F(ConsoleDoor, NoPathLeavesThePage) {
  start({.rate = {.per_s = 1000, .burst = 1000}});
  for (const char* path :
       {"/page/../../../etc/passwd", "/page/..%2f..%2fetc/passwd", "/page/%2e%2e/%2e%2e/etc/passwd",
        "/%2e%2e/%2e%2e/etc/passwd", "/page/%2E%2E/index.html", "//etc/passwd", "/page//etc/passwd",
        "/page/main.js%00.css", "/page/main.js/", "/page/", "/page", "/.", "/page/MAIN.JS", "/page/main.js;x",
        "http://evil.org/", "*", "/\\..\\..\\etc\\passwd"})
    ask(get(path), "404 Not Found");
  ask(get("/page/main.js?%2e%2e"), "200 OK");
}

TEST_F(ConsoleDoor, OriginsThatLookLikeItsOwnAreNot) {
  start({.rate = {.per_s = 1000, .burst = 1000}});
  const std::string port = host_.substr(host_.rfind(':'));
  for (const std::string& origin :
       {std::string("null"), std::string("http://127.0.0.1"), std::string("http://127.0.0.1:1"),
        "https://" + host_, "http://" + host_ + ".evil.org", "http://evil.org" + port,
        "http://" + host_ + "/", "http://" + host_ + "@evil.org", std::string("file://")}) {
    ask(upgrade("/stream", "Origin: " + origin + "\r\n"), "403 Forbidden");
    ask(upgrade("/control", "Origin: " + origin + "\r\n"), "403 Forbidden");
    ask(get("/api/hello", "Origin: " + origin + "\r\n"), "403 Forbidden");
  }
  ask("GET / HTTP/1.1\r\nHost: rebound.evil.org" + port + "\r\n\r\n", "403 Forbidden");
  EXPECT_TRUE(streamed_.empty());
  EXPECT_TRUE(via_.empty());
}

/// As many as it has places for are answered, the others are hung up on at once; when they go there is room.
TEST_F(ConsoleDoor, TwoHundredConnectionsLeaveItStanding) {
  start({.max_connections = 48});
  std::vector<LinePeer> crowd;
  for (int i = 0; i < 200; ++i) crowd.push_back(connect());
  const auto hung_up = [&] {
    std::size_t count = 0;
    for (LinePeer& peer : crowd) {
      peer.pump();
      count += peer.closed ? 1U : 0U;
    }
    return count;
  };
  ASSERT_TRUE(run_until(io_, [&] { return hung_up() == 152; }));
  for (LinePeer& peer : crowd) {
    if (peer.closed) continue;
    peer.send(get("/metrics"));
    EXPECT_TRUE(wait(peer, "mgtd_up 1"));
  }
  EXPECT_EQ(hung_up(), 152U);
  crowd.clear();
  EXPECT_TRUE(run_until(io_, [&] {
    LinePeer peer = connect();
    peer.send(get("/metrics"));
    return wait(peer, "mgtd_up 1");
  }));
}

/// Half by the header of a job, half by the first line of control. Each is answered, counted and in vain; the
/// log has a line a minute.
TEST_F(ConsoleDoor, AThousandWrongTokensAreCountedAndFillNoLog) {
  const auto lines = std::make_shared<spdlog::sinks::ringbuffer_sink_mt>(2000);
  const auto before = spdlog::default_logger();
  spdlog::set_default_logger(std::make_shared<spdlog::logger>("door", lines));
  const mgtd::testing::ScratchDirectory dir;
  const auto began = std::chrono::steady_clock::now();
  start({.wrong_token_wait = 0ms, .workbench = WorkbenchConfig{.runs = dir / "", .mgt = "/bin/false"}});
  const std::string control = upgrade("/control", own());
  for (int i = 0; i < 500; ++i) {
    const std::string guess = "0000" + std::to_string(100'000 + i);
    ask(get("/jobs/1", "Authorization: Bearer " + guess + "\r\n"), "403 Forbidden");
    LinePeer peer = ask(control, "101 Switching");
    peer.send(frame("{\"token\":\"" + guess + "\"}"));
    ASSERT_TRUE(wait(peer, "the token is wrong")) << i;
  }
  const auto minutes =
      std::chrono::duration_cast<std::chrono::minutes>(std::chrono::steady_clock::now() - began);
  spdlog::set_default_logger(before);
  EXPECT_EQ(server_->refused(), 1000U);
  EXPECT_LE(lines->last_raw().size(), static_cast<std::size_t>(1 + minutes.count()));
  EXPECT_GE(lines->last_raw().size(), 1U);
  EXPECT_TRUE(via_.empty());
  LinePeer right = ask(control, "101 Switching");
  right.send(frame("{\"token\":\"" + server_->token().text() + "\"}"));
  EXPECT_TRUE(run_until(io_, [&] { return !via_.empty(); })) << "the right one still opens";
}

}  // namespace
}  // namespace mgtd::daemon::serve::console
