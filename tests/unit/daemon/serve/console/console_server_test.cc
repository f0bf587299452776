// SPDX-License-Identifier: Apache-2.0
// The door over the wire, with a client made of system calls: what a browser sends, and what others send.
#include "daemon/serve/console/console_server.h"

#include <gmock/gmock.h>

#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/event_loop.h"
#include "tests/support/line_peer.h"

namespace mgtd::daemon::serve::console {
namespace {

using mgtd::testing::LinePeer;
using mgtd::testing::run_until;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A text frame of a client, masked with zeros.
std::string frame(std::string_view text) {
  std::string out{static_cast<char>(0x81), static_cast<char>(0x80 | text.size())};
  out.append(4, '\0');
  out += text;
  return out;
}

class ConsoleServerTest : public ::testing::Test {
 protected:
  void start(ConsoleConfig config = {}) {
    config.listen = "127.0.0.1:0";
    server_ = std::make_unique<ConsoleServer>(
        io_, config,
        ConsoleSource{
            .hello = [] { return std::string(R"({"rig":"bench"})"); },
            .metrics = [] { return std::string("mgtd_up 1\n"); },
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

TEST_F(ConsoleServerTest, HandsOutThePageAndForbidsItAllElse) {
  start();
  const LinePeer page = ask(get("/"), "</html>");
  EXPECT_THAT(page.lines.front(), HasSubstr("200 OK"));
  EXPECT_EQ(page.count("default-src 'none'"), 1U);
  EXPECT_EQ(page.count("trusted-types 'none'"), 1U);
  EXPECT_EQ(page.count("X-Content-Type-Options: nosniff"), 1U);
  ask(get("/page/main.js"), "openStream");
  ask(get("/metrics"), "mgtd_up 1");
  ask(get("/nothing"), "404 Not Found");
  ask(get("/page/../console_server.cc"), "404 Not Found");
}

TEST_F(ConsoleServerTest, AnswersOneRequestAfterTheOther) {
  start();
  LinePeer peer = ask(get("/metrics"), "mgtd_up 1");
  peer.send(get("/metrics"));
  EXPECT_TRUE(run_until(io_, [&] {
    peer.pump();
    return peer.count("mgtd_up 1") == 2;
  }));
}

TEST_F(ConsoleServerTest, RefusesOtherHostsPagesAndMethods) {
  start();
  ask("GET / HTTP/1.1\r\nHost: evil.org\r\n\r\n", "403 Forbidden");
  ask("GET / HTTP/1.0\r\n\r\n", "403 Forbidden");
  ask(get("/", "Origin: http://evil.org\r\n"), "403 Forbidden");
  ask(get("/api/hello", "Sec-Fetch-Site: cross-site\r\n"), "403 Forbidden");
  ask("POST / HTTP/1.1\r\nHost: " + host_ + "\r\nContent-Length: 0\r\n\r\n", "405 Method Not Allowed");
  ask("POST / HTTP/1.1\r\nHost: " + host_ + "\r\nContent-Length: 99\r\n\r\n", "413 Payload Too Large");
  ask(get("/", "X: " + std::string(9000, 'x') + "\r\n"), "413 Payload Too Large");
  ask(upgrade("/stream", ""), "403 Forbidden");
  ask(upgrade("/stream", "Origin: http://evil.org\r\n"), "403 Forbidden");
  EXPECT_TRUE(streamed_.empty());
}

TEST_F(ConsoleServerTest, AWebSocketGetsTheLinesOfTheStream) {
  start();
  LinePeer peer = ask(upgrade("/stream", own()), "HELLO");
  EXPECT_THAT(peer.lines.front(), HasSubstr("101 Switching Protocols"));
  peer.send(frame(R"({"watch":{}})"));
  ASSERT_TRUE(run_until(io_, [&] { return !heard_.empty(); }));
  EXPECT_THAT(heard_, ElementsAre(R"({"watch":{}})"));
  streamed_.front()->send("{\"class\":\"TENSOR\"}\n");
  EXPECT_TRUE(wait(peer, "TENSOR"));
  peer.close();
  EXPECT_TRUE(run_until(io_, [&] { return closed_ == 1; }));
}

TEST_F(ConsoleServerTest, ControlNeedsTheToken) {
  start();
  LinePeer right = ask(upgrade("/control", own()), "101 Switching");
  right.send(frame("{\"token\":\"" + server_->token().text() + "\"}"));
  ASSERT_TRUE(run_until(io_, [&] { return !via_.empty(); }));
  EXPECT_EQ(via_, "the console, from 127.0.0.1");
  right.send(frame(R"({"cmd":"status"})"));
  ASSERT_TRUE(run_until(io_, [&] { return !heard_.empty(); }));
  for (const char* wrong : {R"({"token":"00000000000000000000000000000000"})", R"({"token":7})", "x"}) {
    LinePeer peer = ask(upgrade("/control", own()), "101 Switching");
    peer.send(frame(wrong));
    peer.send(frame(R"({"cmd":"run.abort"})"));
    EXPECT_TRUE(wait(peer, "the token is wrong")) << wrong;
  }
  EXPECT_EQ(heard_.size(), 1U);
}

TEST_F(ConsoleServerTest, TooManyConnectionsAndRequestsAreRefused) {
  start({.max_connections = 2, .rate = {.per_s = 0.001, .burst = 2}});
  LinePeer first = ask(get("/metrics"), "mgtd_up"), second = ask(get("/metrics"), "mgtd_up");
  LinePeer third = connect();
  third.send(get("/metrics"));
  EXPECT_TRUE(run_until(io_, [&] {
    third.pump();
    return third.closed;
  }));
  EXPECT_EQ(third.count("mgtd_up"), 0U);
  second.send(get("/metrics"));
  EXPECT_TRUE(wait(second, "429 Too Many Requests"));
}

class ConsoleServerWithRuns : public ConsoleServerTest {
 protected:
  void SetUp() override {
    std::ofstream(dir_ / "a.csv") << "pose,s1_x_nT\n1,2\n";
    start({.rate = {.per_s = 1000, .burst = 1000},
           .workbench = WorkbenchConfig{.runs = dir_ / "", .mgt = "/bin/echo"}});
  }
  [[nodiscard]] std::string job(const std::string& method, const std::string& target, const std::string& body,
                                const std::string& more = "") const {
    return method + " " + target + " HTTP/1.1\r\nHost: " + host_ + "\r\n" + more +
           "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body;
  }
  [[nodiscard]] std::string bearer() const {
    return "Authorization: Bearer " + server_->token().text() + "\r\n";
  }

  mgtd::testing::ScratchDirectory dir_;
  const std::string body_ = R"({"verb":"explain","run":"a.csv"})";
};

TEST_F(ConsoleServerWithRuns, ComputesForWhoHasTheToken) {
  ask(get("/runs"), R"("name":"a.csv")");
  ask(job("POST", "/jobs", body_, bearer()), R"({"job":1})");
  ASSERT_TRUE(run_until(io_, [this] {
    LinePeer peer = connect();
    peer.send(get("/jobs/1", bearer()));
    return wait(peer, R"("state":)") && peer.count(R"("state":"done")") == 1;
  }));
  ask(get("/jobs/1/result", bearer()),
      "explain " + (dir_ / "a.csv") + " --confusion --impact --no-law --json");
  ask(get("/jobs/9", bearer()), "404 Not Found");
  ask(job("POST", "/jobs", R"({"verb":"explain","run":"../a.csv"})", bearer()), "404 Not Found");
  ask(job("POST", "/jobs", R"({"verb":"undo","run":"a.csv"})", bearer()), "keeps no model");
  ask(job("DELETE", "/jobs/1", "", bearer()), R"("state":"cancelled")");
}

TEST_F(ConsoleServerWithRuns, ComputesForNobodyElse) {
  ask(job("POST", "/jobs", body_), "403 Forbidden");
  ask(job("POST", "/jobs", body_, "Authorization: Bearer 0000\r\n"), "403 Forbidden");
  ask(job("POST", "/jobs", body_, bearer() + "Origin: http://evil.org\r\n"), "403 Forbidden");
  ask(job("DELETE", "/jobs/1", "", "Authorization: Bearer 0000\r\n"), "403 Forbidden");
  ask(get("/jobs/1"), "403 Forbidden");
  ask(job("POST", "/elsewhere", body_, bearer()), "413 Payload Too Large");
  ask("POST /jobs HTTP/1.1\r\nHost: " + host_ + "\r\n" + bearer() + "Content-Length: 70000\r\n\r\n",
      "413 Payload Too Large");
  ask(get("/jobs/1", bearer()), "404 Not Found");
}

TEST_F(ConsoleServerTest, WithoutRunsThereAreNoJobs) {
  start();
  ask(get("/runs"), "404 Not Found");
  ask(get("/jobs/1"), "404 Not Found");
}

TEST_F(ConsoleServerTest, WithoutAnAddressThereIsNoConsole) {
  ConsoleServer none(io_, {.listen = ""}, {});
  EXPECT_TRUE(none.start());
  EXPECT_TRUE(none.address().empty());
}

TEST_F(ConsoleServerTest, StoppingClosesWhatIsOpen) {
  start();
  LinePeer idle = ask(get("/metrics"), "mgtd_up");
  server_->stop();
  EXPECT_TRUE(run_until(io_, [&] {
    idle.pump();
    return idle.closed;
  }));
}

}  // namespace
}  // namespace mgtd::daemon::serve::console
