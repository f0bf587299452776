// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/control_server.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pwd.h>
#include <sys/stat.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "daemon/serve/control_client.h"
#include "daemon/serve/stream_reader.h"
#include "daemon/serve/stream_server.h"
#include "tests/support/event_loop.h"
#include "tests/support/line_peer.h"

namespace mgtd::daemon::serve {
namespace {

using Json = nlohmann::json;
using mgtd::testing::LinePeer;
using ::testing::HasSubstr;

/// Answers with what was asked; refuses run.start.
Result<nlohmann::ordered_json> echo(const ControlRequest& request) {
  if (request.command == ControlCommand::run_start) {
    return fail(ErrorCode::state, "a run is active: r7, 30 of 157 poses", "mgt run abort ends it");
  }
  return nlohmann::ordered_json{{"command", name(request.command)}, {"args", request.args}};
}

class ControlServerTest : public ::testing::Test {
 protected:
  void start(ControlServer::Handler handler = echo, std::size_t max_clients = 4,
             RateLimit rate = {.per_s = 50, .burst = 200}) {
    server_ = std::make_unique<ControlServer>(io_, ControlConfig{path_, 0660, max_clients, rate},
                                              std::move(handler));
    const auto started = server_->start();
    ASSERT_TRUE(started) << started.error().text();
  }
  template <class Condition>
  bool wait(LinePeer& peer, Condition condition) {
    return mgtd::testing::run_until(io_, [&] {
      peer.pump();
      return condition();
    });
  }

  boost::asio::io_context io_;
  mgtd::testing::ScratchDirectory scratch_;
  std::string path_ = scratch_ / "control.sock";
  std::unique_ptr<ControlServer> server_;
};

/// The kernel says who asks; a client cannot.
TEST_F(ControlServerTest, TellsWhoWantsAChange) {
  start([](const ControlRequest& request) -> Result<nlohmann::ordered_json> {
    return nlohmann::ordered_json{{"from", request.from}};
  });
  LinePeer peer = LinePeer::unix_socket(path_);
  peer.send_line(R"({"cmd":"calibrations.rollback","id":1})");
  peer.send_line(R"({"cmd":"status","id":2})");
  peer.send_line(R"({"cmd":"calibrations.rollback","from":"somebody else","id":3})");
  ASSERT_TRUE(wait(peer, [&] { return peer.lines.size() == 3; }));
  const passwd* const me = getpwuid(getuid());
  EXPECT_EQ(Json::parse(peer.lines[0]).at("result").at("from"),
            me == nullptr ? fmt::format("uid {}", getuid()) : std::string(me->pw_name));
  EXPECT_EQ(Json::parse(peer.lines[1]).at("result").at("from"), "") << "who only looks is not asked";
  EXPECT_THAT(peer.lines[2], HasSubstr("unknown key 'from'"));
}

TEST_F(ControlServerTest, AnswersInOrderWithTheIdsItWasGiven) {
  start();
  LinePeer peer = LinePeer::unix_socket(path_);
  peer.send_line(R"({"cmd":"status","id":1})");
  peer.send_line(R"({"cmd":"calibrations.show","args":{"id":"c1"},"id":"two"})");
  peer.send_line(R"({"cmd":"run.start","id":3})");
  peer.send_line(R"({"cmd":"version"})");
  ASSERT_TRUE(wait(peer, [&] { return peer.lines.size() == 4; }));
  EXPECT_EQ(peer.lines[0], R"({"ok":true,"id":1,"result":{"command":"status","args":{}}})");
  EXPECT_EQ(peer.lines[1],
            R"({"ok":true,"id":"two","result":{"command":"calibrations.show","args":{"id":"c1"}}})");
  EXPECT_EQ(peer.lines[2],
            R"({"ok":false,"id":3,"error":{"code":"state","message":"a run is active: r7, 30 of 157 poses",)"
            R"("remedy":"mgt run abort ends it"}})");
  EXPECT_EQ(peer.lines[3], R"({"ok":true,"id":null,"result":{"command":"version","args":{}}})");
}

TEST_F(ControlServerTest, ABrokenLineIsAnsweredAndTheNextOneWorks) {
  start();
  LinePeer peer = LinePeer::unix_socket(path_);
  for (const char* line : {"nonsense", R"({"cmd":"explode","id":9})", R"({"cmd":"version","id":10})"}) {
    peer.send_line(line);
  }
  ASSERT_TRUE(wait(peer, [&] { return peer.lines.size() == 3; }));
  EXPECT_THAT(peer.lines[0], HasSubstr(R"("ok":false,"id":null)"));
  EXPECT_THAT(peer.lines[1], HasSubstr(R"("id":9,"error":{"code":"usage","message":"command 'explode')"));
  EXPECT_THAT(peer.lines[2], HasSubstr(R"("ok":true,"id":10)"));
}

TEST_F(ControlServerTest, ARequestWithoutEndIsCutOff) {
  start();
  LinePeer peer = LinePeer::unix_socket(path_);
  ASSERT_TRUE(mgtd::testing::run_until(io_, [&] {
    peer.send(std::string(4096, 'x'));
    peer.pump();
    return peer.closed;
  }));
  ASSERT_EQ(peer.lines.size(), 1U);
  EXPECT_THAT(peer.lines[0], HasSubstr(fmt::format("longer than {} bytes", kControlLineLimit)));
}

TEST_F(ControlServerTest, WhoAsksTooOftenIsToldAndDisconnectedAndOthersAreNot) {
  start(echo, 4, {.per_s = 0.001, .burst = 8});
  LinePeer calm = LinePeer::unix_socket(path_);
  LinePeer hasty = LinePeer::unix_socket(path_);
  for (int i = 0; i < 9; ++i) hasty.send_line(R"({"cmd":"version"})");
  ASSERT_TRUE(wait(hasty, [&] { return hasty.closed; }));
  ASSERT_EQ(hasty.lines.size(), 9U);
  EXPECT_THAT(hasty.lines[8], HasSubstr("disconnected: more than 0.001 requests a second"));
  calm.send_line(R"({"cmd":"version"})");
  ASSERT_TRUE(wait(calm, [&] { return calm.lines.size() == 1; }));
  const ControlStatus counted = server_->stats();
  EXPECT_EQ(counted.drops[static_cast<std::size_t>(DropReason::too_often)], 1U);
  EXPECT_THAT(counted.last_drop, HasSubstr("more than 0.001 requests"));
}

TEST_F(ControlServerTest, OneControlsTheOtherIsToldWhoDoes) {
  start();
  LinePeer first = LinePeer::unix_socket(path_);
  first.send_line(R"({"cmd":"control.take","args":{"why":"at the table"},"id":1})");
  ASSERT_TRUE(wait(first, [&] { return first.lines.size() == 1; }));
  EXPECT_THAT(first.lines[0], HasSubstr(fmt::format(R"("ok":true,"id":1,"result":{{"pid":{})", getpid())));
  LinePeer second = LinePeer::unix_socket(path_);
  for (const char* line :
       {R"({"cmd":"run.finish"})", R"({"cmd":"run.abort"})", R"({"cmd":"control.release"})"})
    second.send_line(line);
  ASSERT_TRUE(wait(second, [&] { return second.lines.size() == 3; }));
  EXPECT_THAT(second.lines[0], HasSubstr(fmt::format("pid {} (uid {})", getpid(), getuid())));
  EXPECT_THAT(second.lines[0], HasSubstr("at the table"));
  EXPECT_THAT(second.lines[1], HasSubstr(R"("command":"run.abort")"));
  EXPECT_THAT(second.lines[2], HasSubstr(R"("ok":false)"));
  EXPECT_TRUE(server_->stats().holder);
  first.close();
  ASSERT_TRUE(wait(second, [&] { return server_->stats().clients == 1; }));
  EXPECT_FALSE(server_->stats().holder) << "gone with its connection";
  second.send_line(R"({"cmd":"run.finish"})");
  ASSERT_TRUE(wait(second, [&] { return second.lines.size() == 4; }));
  EXPECT_THAT(second.lines[3], HasSubstr(R"("command":"run.finish")"));
}

TEST_F(ControlServerTest, ControlIsBrokenByWhoeverAsksForThat) {
  start();
  LinePeer first = LinePeer::unix_socket(path_);
  first.send_line(R"({"cmd":"control.take"})");
  ASSERT_TRUE(wait(first, [&] { return first.lines.size() == 1; }));
  LinePeer second = LinePeer::unix_socket(path_);
  second.send_line(R"({"cmd":"control.break"})");
  second.send_line(R"({"cmd":"run.finish"})");
  ASSERT_TRUE(wait(second, [&] { return second.lines.size() == 2; }));
  EXPECT_THAT(second.lines[0], HasSubstr(fmt::format(R"("was":{{"pid":{})", getpid())));
  EXPECT_THAT(second.lines[1], HasSubstr(R"("ok":true)"));
}

TEST_F(ControlServerTest, WhoAsksAndNeverReadsIsClosed) {
  start(echo, 4, {.per_s = 1, .burst = 1e9});
  LinePeer peer = LinePeer::unix_socket(path_);
  std::string requests;
  for (int i = 0; i < 200; ++i) requests += "{\"cmd\":\"status\"}\n";
  bool seen = false;
  ASSERT_TRUE(mgtd::testing::run_until(io_, [&] {
    peer.send(requests);
    seen = seen || server_->stats().clients == 1;
    return seen && server_->stats().clients == 0;
  }));
}

TEST_F(ControlServerTest, SeveralMayLookAtOnceUpToTheLimit) {
  start(echo, 2);
  std::vector<LinePeer> peers;
  for (int i = 0; i < 3; ++i) {
    peers.push_back(LinePeer::unix_socket(path_));
    peers.back().send_line(R"({"cmd":"version"})");
    ASSERT_TRUE(wait(peers.back(), [&] { return peers.back().lines.size() == 1; }));
  }
  EXPECT_THAT(peers[0].lines[0], HasSubstr("\"ok\":true"));
  EXPECT_THAT(peers[1].lines[0], HasSubstr("\"ok\":true"));
  EXPECT_THAT(peers[2].lines[0], HasSubstr("2 control clients are connected, which is the limit"));
}

TEST_F(ControlServerTest, TheFileModeSaysWhoMay) {
  start();
  struct stat file {};
  ASSERT_EQ(::stat(path_.c_str(), &file), 0);
  EXPECT_EQ(file.st_mode & 0777U, 0660U);
}

TEST_F(ControlServerTest, StoppingClosesEveryClientEvenFromInsideARequest) {
  start([this](const ControlRequest&) -> Result<nlohmann::ordered_json> {
    server_->stop();
    return nlohmann::ordered_json::object();
  });
  LinePeer peer = LinePeer::unix_socket(path_);
  peer.send_line(R"({"cmd":"version"})");
  ASSERT_TRUE(wait(peer, [&] { return peer.closed; }));
  EXPECT_FALSE(std::filesystem::exists(path_));
}

/// The blocking clients of the operator's tool, against servers that run on a thread of their own.
class ClientTest : public ::testing::Test {
 protected:
  void run() {
    thread_ = std::thread([this] { io_.run(); });
  }
  ~ClientTest() override {
    work_.reset();
    io_.stop();
    if (thread_.joinable()) thread_.join();
  }

  boost::asio::io_context io_;
  mgtd::testing::ScratchDirectory scratch_;
  boost::asio::executor_work_guard<boost::asio::io_context::executor_type> work_{io_.get_executor()};
  std::thread thread_;
};

TEST_F(ClientTest, ControlClientAsksAndIsAnswered) {
  ControlServer server(io_, {.path = scratch_ / "c.sock"}, echo);
  ASSERT_TRUE(server.start());
  run();
  auto client = ControlClient::connect(scratch_ / "c.sock");
  ASSERT_TRUE(client) << client.error().text();
  const auto shown = client->request(ControlCommand::calibrations_show, {{"id", "c1"}});
  ASSERT_TRUE(shown) << shown.error().text();
  EXPECT_EQ(*shown, Json({{"command", "calibrations.show"}, {"args", {{"id", "c1"}}}}));
  const auto refused = client->request(ControlCommand::run_start);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::state);
  EXPECT_EQ(refused.error().remedy, "mgt run abort ends it");
  io_.stop();
  thread_.join();
}

TEST_F(ClientTest, ADaemonThatIsSilentOrAbsentIsUnreachable) {
  const auto absent = ControlClient::connect(scratch_ / "c.sock");
  ASSERT_FALSE(absent);
  EXPECT_EQ(exit_code(absent.error().code), 3);
  ControlServer server(io_, {.path = scratch_ / "c.sock"}, echo);
  ASSERT_TRUE(server.start());  // accepts in the kernel; nobody runs its loop
  auto client = ControlClient::connect(scratch_ / "c.sock");
  ASSERT_TRUE(client);
  const auto unanswered = client->request(ControlCommand::status, Json::object(), from_seconds(0.02));
  ASSERT_FALSE(unanswered);
  EXPECT_EQ(unanswered.error().code, ErrorCode::unreachable);
  EXPECT_THAT(unanswered.error().message, HasSubstr("did not answer status within 0.02 s"));
}

TEST_F(ClientTest, StreamReaderIsGreetedAndReads) {
  StreamConfig config;
  config.tcp = "127.0.0.1:0";
  config.unix_path = scratch_ / "s.sock";
  StreamServer server(io_, config, {"bench rig", "mgtd test"});
  ASSERT_TRUE(server.start());
  for (std::uint64_t seq = 0; seq < 3; ++seq) {
    TensorSample sample;
    sample.seq = seq;
    server.publish(sample);
  }
  const std::string tcp = "127.0.0.1:" + std::to_string(server.tcp_port());
  run();
  for (const std::string& where : {scratch_ / "s.sock", tcp}) {
    auto reader = StreamReader::open(where, {StreamClasses::all(), std::nullopt, 0});
    ASSERT_TRUE(reader) << reader.error().text();
    EXPECT_EQ(reader->greeting()["rig"], "bench rig");
    for (std::uint64_t seq = 0; seq < 3; ++seq) {
      const auto object = reader->next(std::chrono::seconds(30));
      ASSERT_TRUE(object && *object);
      EXPECT_EQ((**object)["seq"], seq);
    }
  }
  auto ahead = StreamReader::open(tcp, {StreamClasses::all(), std::nullopt, 99});
  ASSERT_TRUE(ahead);
  const auto told = ahead->next(std::chrono::seconds(30));
  ASSERT_FALSE(told);
  EXPECT_THAT(told.error().message, HasSubstr("from_seq 99 lies ahead"));
  io_.stop();
  thread_.join();
}

TEST_F(ClientTest, StreamReaderRefusesWhatIsNoStream) {
  ControlServer server(io_, {.path = scratch_ / "c.sock"}, echo);
  ASSERT_TRUE(server.start());
  auto absent = StreamReader::open(scratch_ / "s.sock", {});
  ASSERT_FALSE(absent);
  EXPECT_EQ(absent.error().code, ErrorCode::unreachable);
  auto closed_port = StreamReader::open("127.0.0.1:1", {});
  ASSERT_FALSE(closed_port);
  EXPECT_EQ(closed_port.error().code, ErrorCode::unreachable);
  auto silent = StreamReader::open(scratch_ / "c.sock", {}, from_seconds(0.02));
  ASSERT_FALSE(silent);
  EXPECT_EQ(silent.error().code, ErrorCode::unreachable);
  EXPECT_THAT(silent.error().message, HasSubstr("nothing came from it within 0.02 s"));
}

}  // namespace
}  // namespace mgtd::daemon::serve
