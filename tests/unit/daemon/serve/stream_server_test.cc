// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/stream_server.h"

#include <fmt/format.h>

#include "tests/unit/daemon/serve/stream_server_bench.h"

namespace mgtd::daemon::serve {
namespace {

TEST_F(StreamServerTest, AClientThatComesBackAfterARestartGetsWhatItMissed) {
  const auto at = [](double s) { return Stamp{Instant{from_seconds(s)}, WallTime{from_seconds(s).count()}}; };
  const store::DiskRingConfig config{.directory = scratch_ / "ring", .rig = "bench", .bytes = 8U << 20U};
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
    EXPECT_EQ(peer.lines[0], encode(Greeting{"bench rig", "mgtd test"}));
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
}  // namespace mgtd::daemon::serve
