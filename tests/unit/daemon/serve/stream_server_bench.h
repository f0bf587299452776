// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "daemon/serve/stream_server.h"
#include "tests/support/event_loop.h"
#include "tests/support/line_peer.h"

/// A stream server and clients of it on one loop.
namespace mgtd::daemon::serve {

using mgtd::testing::LinePeer;
using ::testing::HasSubstr;

inline constexpr const char* kWatchTensor = R"({"watch":{"class":["TENSOR"]}})";

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
      const nlohmann::json object = nlohmann::json::parse(line);
      if (object["class"] == "TENSOR") out.push_back(object["seq"].get<std::uint64_t>());
    }
    return out;
  }

  boost::asio::io_context io_;
  mgtd::testing::ScratchDirectory scratch_;
  std::optional<store::DiskRing> disk_;
  std::unique_ptr<StreamServer> server_;
};

/// Every epoch from `next` on, once, as a sample or in a gap; gives the one after the last.
inline std::uint64_t expect_whole(const LinePeer& peer, std::uint64_t next) {
  for (const std::string& line : peer.lines) {
    const nlohmann::json object = nlohmann::json::parse(line);
    const bool is_gap = object["class"] == "GAP";
    if (!is_gap && object["class"] != "TENSOR") continue;
    EXPECT_EQ(object[is_gap ? "from_seq" : "seq"], next) << line;
    next = object[is_gap ? "to_seq" : "seq"].get<std::uint64_t>() + 1;
  }
  return next;
}

}  // namespace mgtd::daemon::serve
