// SPDX-License-Identifier: Apache-2.0
#include "daemon/stream_server.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "tests/support/event_loop.h"
#include "tests/support/line_peer.h"

namespace mgtd::daemon {
namespace {

using Json = nlohmann::json;
using mgtd::testing::LinePeer;

constexpr const char* kWatchTensor = R"({"watch":{"class":["TENSOR"]}})";

class StreamServerTest : public ::testing::Test {
 protected:
  void start(std::size_t ring_lines = 1024, std::size_t max_clients = 8) {
    StreamConfig config;
    config.tcp = "127.0.0.1:0";
    config.unix_path = scratch_ / "stream.sock";
    config.max_clients = max_clients;
    config.ring_lines = ring_lines;
    server_ = std::make_unique<StreamServer>(io_, config, Greeting{"bench rig", "mgtd test"});
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
  std::unique_ptr<StreamServer> server_;
};

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

}  // namespace
}  // namespace mgtd::daemon
