// SPDX-License-Identifier: Apache-2.0
#include "daemon/stream_server.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "proto/watch_request.h"
#include "tests/support/event_loop.h"
#include "tests/support/line_peer.h"

namespace mgtd::daemon {
namespace {

using Json = nlohmann::json;
using mgtd::testing::LinePeer;
using ::testing::HasSubstr;

constexpr const char* kWatchTensor = R"({"watch":{"class":["TENSOR"]}})";

class StreamServerTest : public ::testing::Test {
 protected:
  void start(std::size_t ring_lines = 1024, std::size_t max_clients = 8,
             RateLimit rate = StreamConfig{}.rate) {
    StreamConfig config;
    config.rate = rate;
    config.tcp = "127.0.0.1:0";
    config.unix_path = scratch_ / "stream.sock";
    config.max_clients = max_clients;
    config.ring_lines = ring_lines;
    server_ = std::make_unique<StreamServer>(io_, config, Greeting{"bench rig", "mgtd test"});
    if (disk_) server_->keep(*disk_);
    const auto started = server_->start();
    ASSERT_TRUE(started) << started.error().text();
  }

  LinePeer connect() { return greeted(LinePeer::unix_socket(scratch_ / "stream.sock")); }
  LinePeer connect_tcp() { return greeted(LinePeer::tcp(server_->tcp_port())); }
  LinePeer greeted(LinePeer peer) {
    EXPECT_TRUE(wait(peer, [&] { return !peer.lines.empty(); }));
    return peer;
  }
  /// Sends a watch and waits until the server has read it: an unknown key is answered, and answers keep their
  /// order.
  void watch(LinePeer& peer, std::string_view line) {
    const std::size_t before = peer.count("no key 'mark'");
    peer.send_line(line);
    peer.send_line(R"({"watch":{"mark":1}})");
    ASSERT_TRUE(wait(peer, [&] { return peer.count("no key 'mark'") > before; }));
  }
  template <class Condition>
  bool wait(LinePeer& peer, Condition condition) {
    return mgtd::testing::run_until(io_, [&] {
      peer.pump();
      return condition();
    });
  }
  template <class Condition>
  bool wait(Condition condition) {
    return mgtd::testing::run_until(io_, condition);
  }

  /// Samples first .. last at 50 Hz.
  void publish(std::uint64_t first, std::uint64_t last) {
    for (std::uint64_t seq = first; seq <= last; ++seq) {
      TensorSample sample;
      sample.seq = seq;
      sample.t.mono = Instant{Duration{static_cast<std::int64_t>(seq) * 20'000'000}};
      sample.t.wall.ns = static_cast<std::int64_t>(seq) * 20'000'000;
      server_->publish(sample);
    }
  }
  static std::vector<std::uint64_t> seqs(const LinePeer& peer) {
    std::vector<std::uint64_t> out;
    for (const std::string& line : peer.lines) {
      const Json object = Json::parse(line);
      if (object["class"] == "TENSOR") out.push_back(object["seq"].get<std::uint64_t>());
    }
    return out;
  }

  boost::asio::io_context io_;
  mgtd::testing::ScratchDirectory scratch_;
  std::optional<DiskRing> disk_;
  std::unique_ptr<StreamServer> server_;
};

/// Every epoch from `next` on, once, as a sample or in a gap; gives the one after the last.
std::uint64_t expect_whole(const LinePeer& peer, std::uint64_t next) {
  for (const std::string& line : peer.lines) {
    const Json object = Json::parse(line);
    const bool is_gap = object["class"] == "GAP";
    if (!is_gap && object["class"] != "TENSOR") continue;
    EXPECT_EQ(object[is_gap ? "from_seq" : "seq"], next) << line;
    next = object[is_gap ? "to_seq" : "seq"].get<std::uint64_t>() + 1;
  }
  return next;
}

TEST_F(StreamServerTest, AClientThatComesBackAfterARestartGetsWhatItMissed) {
  const auto at = [](double s) { return Stamp{Instant{from_seconds(s)}, WallTime{from_seconds(s).count()}}; };
  const DiskRingConfig config{.directory = scratch_ / "ring", .rig = "bench", .bytes = 8U << 20U};
  disk_.emplace(config, at(0));
  start(64);
  publish(0, 4999);
  server_.reset();
  disk_.emplace(config, at(110));
  start(64);
  const std::uint64_t again = disk_->first_seq();
  EXPECT_GE(again, 5500U);
  publish(again, again + 499);
  disk_->tick(at(130));
  for (const std::uint64_t from : {std::uint64_t{0}, std::uint64_t{3333}, again + 10, again + 490}) {
    LinePeer peer = connect();
    watch(peer, R"({"watch":{"class":["TENSOR"],"from_seq":)" + std::to_string(from) + "}}");
    const std::string last = fmt::format("\"seq\":{},", again + 499);
    ASSERT_TRUE(wait(peer, [&] { return peer.count(last) == 1; })) << from;
    EXPECT_EQ(expect_whole(peer, from), again + 500);
    EXPECT_EQ(peer.count("without a word") + peer.count("was stopped"), from < 5000 ? 1U : 0U);
  }
}

TEST_F(StreamServerTest, GreetsAndThenSaysNothingUntilAsked) {
  start();
  std::vector<LinePeer> peers;
  peers.push_back(connect());
  peers.push_back(connect_tcp());
  for (LinePeer& peer : peers) {
    EXPECT_EQ(
        peer.lines[0],
        R"({"class":"HELLO","protocol":{"major":1,"minor":0},"rig":"bench rig","software":"mgtd test"})");
    publish(1, 10);
    watch(peer, R"({"watch":{"class":[]}})");  // asks for nothing: whatever was sent before is here now
    EXPECT_EQ(peer.count("TENSOR\""), 0U);
    watch(peer, kWatchTensor);
    publish(11, 12);
    ASSERT_TRUE(wait(peer, [&] { return peer.count("\"TENSOR\"") == 2; }));
    EXPECT_EQ(seqs(peer), (std::vector<std::uint64_t>{11, 12}));
  }
}

TEST_F(StreamServerTest, TwoClientsEachGetTheirRate) {
  start();
  LinePeer fast = connect();
  LinePeer slow = connect_tcp();
  watch(fast, kWatchTensor);
  watch(slow, R"({"watch":{"class":["TENSOR"],"rate_hz":10}})");
  publish(0, 49);
  server_->publish(Gap{50, 51, {}, "s2 silent"});
  ASSERT_TRUE(wait(fast, [&] { return fast.count("GAP") == 1; }));
  ASSERT_TRUE(wait(slow, [&] { return slow.count("GAP") == 1; }));
  EXPECT_EQ(seqs(fast).size(), 50U);
  EXPECT_EQ(seqs(slow), (std::vector<std::uint64_t>{0, 5, 10, 15, 20, 25, 30, 35, 40, 45}));
  EXPECT_EQ(slow.lines.back(), R"({"class":"GAP","from_seq":50,"to_seq":51,"why":"s2 silent"})");
}

TEST_F(StreamServerTest, StatusAndRunReachWhoAsksForThem) {
  start();
  LinePeer peer = connect();
  watch(peer, R"({"watch":{"class":["STATUS","RUN"]}})");
  publish(0, 3);
  server_->publish(StatusReport{});
  server_->publish(RunStatus{});
  ASSERT_TRUE(wait(peer, [&] { return peer.count(R"("class":"RUN")") == 1; }));
  EXPECT_EQ(peer.count(R"("class":"STATUS")"), 1U);
  EXPECT_EQ(seqs(peer).size(), 0U);
}

TEST_F(StreamServerTest, ResumesFromTheRing) {
  start(/*ring_lines=*/100);
  publish(0, 149);
  LinePeer peer = connect();
  watch(peer, R"({"watch":{"class":["TENSOR"],"from_seq":40}})");
  ASSERT_TRUE(wait(peer, [&] { return seqs(peer).size() == 100; }));
  EXPECT_EQ(seqs(peer).front(), 50U);
  EXPECT_EQ(peer.count(R"({"class":"GAP","from_seq":40,"to_seq":49,"why":"no longer held"})"), 1U);
}

TEST_F(StreamServerTest, ALongReplayIsWrittenInTurnsToItsEnd) {
  start(/*ring_lines=*/5000);
  publish(0, 4999);  // some 2.5 MB, many times what is written in one turn
  LinePeer peer = connect_tcp();
  watch(peer, R"({"watch":{"class":["TENSOR"],"from_seq":0}})");
  ASSERT_TRUE(wait(peer, [&] { return seqs(peer).size() == 5000; }));
}

TEST_F(StreamServerTest, ABadLineIsAnsweredAndTheConnectionStays) {
  start();
  LinePeer peer = connect();
  const char* const bad[] = {"\x01\x02garbage", R"({"watch":{"class":["TENSER"]}})",
                             R"({"watch":{"rate_hz":-1}})"};
  for (const char* line : bad) peer.send_line(line);
  peer.send_line(std::string(kWatchLineLimit + 1, 'x'));
  ASSERT_TRUE(wait(peer, [&] { return peer.count(R"("class":"ERROR")") == 4; }));
  for (const std::string& line : peer.lines) {
    const Json object = Json::parse(line);
    if (object["class"] == "ERROR") {
      EXPECT_NE(object["remedy"], "") << line;
    }
  }
  EXPECT_EQ(peer.count("longer than 4096 bytes"), 1U);
  watch(peer, kWatchTensor);
  publish(0, 0);
  ASSERT_TRUE(wait(peer, [&] { return seqs(peer).size() == 1; }));
}

TEST_F(StreamServerTest, TheStreamTakesNoCommands) {
  start();
  LinePeer peer = connect_tcp();
  peer.send_line(R"({"cmd":"run.start"})");
  ASSERT_TRUE(wait(peer, [&] { return peer.count("read-only") == 1; }));
  EXPECT_EQ(peer.count("control socket"), 1U);
}

TEST_F(StreamServerTest, AFloodOfBadLinesEndsWithAReason) {
  start();
  LinePeer peer = connect_tcp();
  for (int i = 0; i < 40; ++i) peer.send_line("nonsense");
  ASSERT_TRUE(wait(peer, [&] { return peer.closed; }));
  EXPECT_EQ(peer.count("32 bad lines in a row"), 1U);
  EXPECT_EQ(server_->stats().clients, 0U);
  EXPECT_EQ(server_->stats().dropped(), 1U);
}

TEST_F(StreamServerTest, AFloodWithoutALineEndEndsToo) {
  start();
  LinePeer peer = connect();
  ASSERT_TRUE(wait([&] {
    peer.send(std::string(8192, 'x'));
    peer.pump();
    return peer.closed;
  }));
  EXPECT_EQ(server_->stats().dropped(), 1U);
}

TEST_F(StreamServerTest, WhoAsksTooOftenIsToldAndDisconnected) {
  start(1024, 8, {.per_s = 0.001, .burst = 5});
  LinePeer calm = connect();
  LinePeer hasty = connect();
  for (int i = 0; i < 6; ++i) hasty.send_line(kWatchTensor);
  ASSERT_TRUE(wait(hasty, [&] { return hasty.closed; }));
  EXPECT_EQ(hasty.count("disconnected: more than 0.001 lines a second"), 1U);
  EXPECT_EQ(server_->stats().drops[static_cast<std::size_t>(DropReason::too_often)], 1U);
  EXPECT_THAT(server_->stats().last_drop, HasSubstr("more than 0.001 lines"));
  watch(calm, kWatchTensor);
  publish(0, 3);
  ASSERT_TRUE(wait(calm, [&] { return seqs(calm).size() == 4; }));
}

TEST_F(StreamServerTest, AClientThatAsksAndNeverReadsIsDropped) {
  start(/*ring_lines=*/8, 8, {.per_s = 1, .burst = 1e9});
  publish(0, 3);
  LinePeer peer = connect();
  const std::string ahead = R"({"watch":{"from_seq":999999}})"
                            "\n"
                            R"({"watch":{"rate_hz":0}})"
                            "\n";
  ASSERT_TRUE(wait([&] {
    peer.send(ahead);
    return server_->stats().clients == 0;
  }));
  EXPECT_EQ(server_->stats().dropped(), 1U);
}

TEST_F(StreamServerTest, ADeadClientIsDroppedAndTheOthersLoseNothing) {
  start(/*ring_lines=*/512);
  LinePeer dead = connect();
  watch(dead, kWatchTensor);
  LinePeer alive = connect();
  watch(alive, kWatchTensor);
  std::uint64_t next = 0;
  ASSERT_TRUE(wait(alive, [&] {
    if (seqs(alive).size() == next) {  // everything so far has come: go on
      publish(next, next + 99);
      next += 100;
      alive.lines.reserve(next);
    }
    return server_->stats().dropped() == 1;
  }));
  ASSERT_TRUE(wait(alive, [&] { return seqs(alive).size() == next; }));
  EXPECT_EQ(alive.count("GAP"), 0U);
  EXPECT_EQ(server_->stats().clients, 1U);
  ASSERT_TRUE(wait(dead, [&] { return dead.closed; }));
}

TEST_F(StreamServerTest, ASlowClientIsToldWhatItLostAndThenWhyItWasDisconnected) {
  start(/*ring_lines=*/2048);  // more than the kernel's buffer holds
  LinePeer slow = connect();
  watch(slow, kWatchTensor);
  std::uint64_t next = 0;
  ASSERT_TRUE(wait([&] {
    publish(next, next + 255);
    next += 256;
    slow.pump(16 * 1024);  // an eighth of what is published
    return slow.closed || server_->stats().dropped() == 1;
  }));
  ASSERT_TRUE(wait(slow, [&] { return slow.closed; }));
  EXPECT_GE(slow.count("client too slow"), 1U);
  EXPECT_EQ(slow.count("disconnected: the client stayed behind"), 1U);
  EXPECT_GE(server_->stats().gaps, 1U);
  std::uint64_t expected = 0;
  for (const std::string& line : slow.lines) {
    const Json object = Json::parse(line);
    if (object["class"] == "TENSOR") {
      EXPECT_EQ(object["seq"], expected);
      expected = object["seq"].get<std::uint64_t>() + 1;
    } else if (object["class"] == "GAP") {
      EXPECT_EQ(object["from_seq"], expected);
      expected = object["to_seq"].get<std::uint64_t>() + 1;
    }
  }
}

TEST_F(StreamServerTest, AClientThatHangsUpIsForgottenEvenInTheMiddleOfWriting) {
  start(/*ring_lines=*/20'000);
  publish(0, 9999);
  {
    LinePeer peer = connect_tcp();
    peer.send_line(R"({"watch":{"class":["TENSOR"],"from_seq":0}})");
    ASSERT_TRUE(wait(peer, [&] { return peer.lines.size() > 3; }));
    peer.close();  // unread data make this a reset: writing on would raise SIGPIPE
  }
  std::uint64_t next = 10'000;
  ASSERT_TRUE(wait([&] {
    publish(next, next);
    ++next;
    return server_->stats().clients == 0;
  }));
  EXPECT_EQ(server_->stats().dropped(), 0U);
}

TEST_F(StreamServerTest, AClientThatEndsItsSendingStillHearsTheStream) {
  start();
  std::vector<LinePeer> peers;
  peers.push_back(connect());
  peers.push_back(connect_tcp());
  for (LinePeer& peer : peers) {
    watch(peer, kWatchTensor);
    peer.end_sending();
    for (int turn = 0; turn < 100; ++turn) io_.poll();
    publish(0, 4);
    ASSERT_TRUE(wait(peer, [&] { return seqs(peer).size() == 5; }));
    peer.close();
    std::uint64_t next = 5;
    ASSERT_TRUE(wait([&] {
      publish(next, next);
      ++next;
      return server_->stats().clients == static_cast<std::size_t>(&peers.back() - &peer);
    }));
  }
}

TEST_F(StreamServerTest, WhoLeavesWithoutAWatchFreesItsPlaceAtOnce) {
  start();
  {
    LinePeer unix_peer = connect();
    LinePeer tcp_peer = connect_tcp();
    LinePeer watching = connect();
    watch(watching, R"({"watch":{"class":["RUN"]}})");
    EXPECT_EQ(server_->stats().clients, 3U);
  }
  ASSERT_TRUE(wait([&] { return server_->stats().clients == 0; }));
}

TEST_F(StreamServerTest, OneTooManyIsToldTheLimit) {
  start(1024, /*max_clients=*/2);
  LinePeer first = connect();
  LinePeer second = connect_tcp();
  LinePeer third = connect();
  ASSERT_TRUE(wait(third, [&] { return third.closed; }));
  ASSERT_EQ(third.lines.size(), 1U);
  EXPECT_THAT(third.lines[0], HasSubstr("2 clients are connected, which is the limit"));
  EXPECT_EQ(server_->stats().refused, 1U);
  EXPECT_EQ(server_->stats().clients, 2U);
}

TEST_F(StreamServerTest, AnOccupiedPortIsNamedWithWhatToDo) {
  start();
  StreamConfig config;
  config.tcp = "127.0.0.1:" + std::to_string(server_->tcp_port());
  config.unix_path = scratch_ / "other.sock";
  StreamServer other(io_, config, {});
  const auto started = other.start();
  ASSERT_FALSE(started);
  EXPECT_THAT(started.error().message, HasSubstr(config.tcp + " is occupied"));
  EXPECT_THAT(started.error().remedy, HasSubstr("ss -ltnp"));
  EXPECT_EQ(LinePeer::unix_socket(config.unix_path).connected(), false) << "nothing is left listening";
}

TEST_F(StreamServerTest, AnAddressThatIsNoneIsRefused) {
  for (const char* address : {"", "7450", "localhost", "rig.example.org:7450", "127.0.0.1:70000",
                              "127.0.0.1:x", "::1:7450", "192.0.2.1:0"}) {
    StreamConfig config;
    config.tcp = address;
    config.unix_path.clear();
    StreamServer server(io_, config, {});
    const auto started = server.start();
    EXPECT_EQ(started.has_value(), std::string_view(address).empty()) << address;
    if (!started) {
      EXPECT_NE(started.error().remedy, "");
    }
  }
}

TEST_F(StreamServerTest, StoppingSaysGoodbyeAndRemovesTheSocket) {
  start();
  LinePeer peer = connect();
  server_->stop();
  ASSERT_TRUE(wait(peer, [&] { return peer.closed; }));
  EXPECT_THAT(peer.lines.back(), HasSubstr("the daemon is stopping"));
  EXPECT_FALSE(std::filesystem::exists(scratch_ / "stream.sock"));
  publish(0, 3);  // after the end it does nothing
  server_.reset();
  io_.restart();
  io_.poll();
}

}  // namespace
}  // namespace mgtd::daemon
