// SPDX-License-Identifier: Apache-2.0
// The console of the real daemon: its address from mgt, its answers, and that it never stands in the way.
#include <gmock/gmock.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/integration/bench.h"
#include "tests/support/line_peer.h"
#include "tests/support/whole_file.h"

namespace mgtd::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// The body of an answer that holds `wanted`.
bool answers(const std::string& host, const std::string& target, const std::string& wanted) {
  const std::size_t port = host.find(':') + 1;
  LinePeer peer = LinePeer::tcp(static_cast<std::uint16_t>(std::stoi(host.substr(port))));
  peer.send("GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\nConnection: close\r\n\r\n");
  return eventually([&] {
           peer.pump();
           return peer.closed;
         }) &&
         (peer.count(wanted) > 0);
}

TEST(ConsoleOnTheBench, IsAtTheAddressThatMgtPrints) {
  Bench bench;
  bench.start_daemon();
  const json console = bench.ask({"console"});
  const std::string address = console.at("address"), token = console.at("token");
  EXPECT_EQ(console.at("url"), address + "#token=" + token);
  EXPECT_EQ(bench.mgt({"console"}).out, console.at("url").get<std::string>() + "\n");
  EXPECT_THAT(bench.mgt({"status"}).out, HasSubstr(address));
  EXPECT_EQ(bench.mgt({"status"}).out.find(token), std::string::npos);
  const std::string host = address.substr(7, address.size() - 8);
  EXPECT_TRUE(answers(host, "/metrics", "mgtd_device_live{device=\"s1\"} 1"));
  EXPECT_TRUE(answers(host, "/", "lanes"));
  EXPECT_TRUE(answers(host, "/api/hello", "\"closure_limit\":18.46")) << "that of four numbers";
  EXPECT_TRUE(eventually([&] { return bench.ask({"status"}).at("sampler").at("epochs") > 50; }));
}

TEST(ConsoleOnTheBench, ComputesOnTheRunsOfTheDaemonBesideTheAcquisition) {
  Bench bench;
  bench.start_daemon();
  const json console = bench.ask({"console"});
  const std::string address = console.at("address"), host = address.substr(7, address.size() - 8);
  const std::string bearer = "\r\nAuthorization: Bearer " + console.at("token").get<std::string>();
  EXPECT_TRUE(answers(host, "/runs", "\"runs\":["));
  EXPECT_TRUE(answers(host, "/jobs/1", "403 Forbidden")) << "without the token";
  EXPECT_TRUE(answers(host + bearer, "/jobs/1", "no such job"));
}

TEST(ConsoleOnTheBench, AnOccupiedAddressIsSaidAndTheRigIsMeasuredAllTheSame) {
  Bench first, second;
  first.start_daemon();
  const std::string address = first.ask({"console"}).at("address");
  std::string config = whole_file(second.config_path());
  const std::string mine = address.substr(7, address.size() - 8);
  const std::size_t at = config.find("[console]\nlisten = \"127.0.0.1:0\"");
  ASSERT_NE(at, std::string::npos);
  config.replace(at, 32, "[console]\nlisten = \"" + mine + "\"");
  std::ofstream(second.config_path()) << config;
  second.start_daemon();
  EXPECT_THAT(second.daemon().err() + second.daemon().out(), HasSubstr("no web console"));
  EXPECT_TRUE(second.ask({"status"}).at("console").is_null());
  const Finished asked = second.mgt({"console"});
  EXPECT_EQ(asked.exit_code, 3);
  EXPECT_THAT(asked.err, HasSubstr("the daemon has no console"));
}

}  // namespace
}  // namespace mgtd::testing
