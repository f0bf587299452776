// SPDX-License-Identifier: Apache-2.0
// The door over the wire, with a client made of system calls: what a browser sends, and what others send.
#include "daemon/serve/console/console_server.h"

#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/unit/daemon/serve/console/console_server_bench.h"

namespace mgtd::daemon::serve::console {
namespace {

using test::frame;
using test::LinePeer;
using test::run_until;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

using ConsoleServerTest = test::ConsoleServerBench;

TEST_F(ConsoleServerTest, HandsOutThePageAndForbidsItAllElse) {
  start();
  const LinePeer page = ask(get("/"), "</html>");
  EXPECT_THAT(page.lines.front(), HasSubstr("200 OK"));
  EXPECT_EQ(page.count("default-src 'none'"), 1U);
  EXPECT_EQ(page.count("trusted-types 'none'"), 1U);
  EXPECT_EQ(page.count("X-Content-Type-Options: nosniff"), 1U);
  ask(get("/page/main.js"), "openStream");
  ask(get("/metrics"), "mgtd_up 1");
  ask(get("/run/course"), R"({"run_id":"monday"})");
  ask(get("/run/events"), "500 Internal Server Error");
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
  EXPECT_EQ(second.count("Retry-After: 1"), 1U);  // nothing was begun: the same may be asked again
}

class ConsoleServerWithRuns : public ConsoleServerTest {
 protected:
  void SetUp() override {
    std::ofstream(dir_ / "a.csv") << "pose,s1_x_nT\n1,2\n";
    std::ofstream(dir_ / "b.mgtrun") << "no run";
    start({.rate = {.per_s = 1000, .burst = 1000},
           .workbench = WorkbenchConfig{.runs = dir_ / "", .mgt = "/bin/echo", .for_others = true}});
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

TEST_F(ConsoleServerWithRuns, StepsAreKeptUnderWhereTheRequestCameFrom) {
  ask(job("POST", "/jobs", R"({"verb":"undo","run":"b.mgtrun"})", bearer()), R"({"job":1})");
  ASSERT_TRUE(run_until(io_, [this] {
    LinePeer peer = connect();
    peer.send(get("/jobs/1", bearer()));
    return wait(peer, R"("state":)") && peer.count(R"("state":"done")") == 1;
  }));
  ask(get("/jobs/1/result", bearer()),
      "undo " + (dir_ / "b.mgtrun") + " --who=the console, from 127.0.0.1 --json");
  ask(get("/jobs/1", bearer()), R"("command":"mgt undo b.mgtrun --json")");
}

TEST_F(ConsoleServerWithRuns, ComputesForWhoHasTheToken) {
  ask(get("/runs"), R"("name":"a.csv")");
  ask(job("POST", "/jobs", body_, bearer()), R"({"job":1})");
  ASSERT_TRUE(run_until(io_, [this] {
    LinePeer peer = connect();
    peer.send(get("/jobs/1", bearer()));
    return wait(peer, R"("state":)") && peer.count(R"("state":"done")") == 1;
  }));
  ask(get("/jobs/1/result", bearer()), "explain " + (dir_ / "a.csv") + " --confusion --impact --json");
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
