// SPDX-License-Identifier: Apache-2.0
// Clients that are slow, dead, flooding, malformed or too many.

#include "proto/watch_request.h"

#include <nlohmann/json.hpp>
#include "tests/unit/daemon/serve/stream_server_bench.h"

namespace mgtd::daemon::serve {
namespace {

using Json = nlohmann::json;

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

}  // namespace
}  // namespace mgtd::daemon::serve
