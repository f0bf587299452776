// SPDX-License-Identifier: Apache-2.0
// A cable is pulled and put in again: another node, the same name, and the stream goes on.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <stdlib.h>
#include <unistd.h>

#include <chrono>
#include <filesystem>

#include "tests/integration/bench.h"

namespace mgtd::testing {
namespace {

using nlohmann::json;

std::string state_of(Bench& bench, const std::string& device) {
  const json status = bench.ask({"status"});
  if (!status.is_object() || !status.contains("devices")) return "";
  for (const json& d : status.at("devices")) {
    if (d.value("name", "") == device) return d.value("state", "");
  }
  return "";
}

/// In real time, so that the seconds it takes are seconds; they are printed, a slow machine fails nobody.
TEST(Replug, AnotherNodeUnderTheSameNameStreamsAgain) {
  namespace fs = std::filesystem;
  Bench bench("1", "[rig]\nname = \"replug\"\nparameters = \"table6\"\n[sensors]\npalmacq = false\n");
  bench.start_daemon();
  const std::string link = bench.ports() + "/fluxgate2";
  const fs::path before = fs::read_symlink(link);
  // Another terminal is opened meanwhile, so that the number is taken.
  ASSERT_EQ(bench.rig({"fault", bench.ports(), "unplug", "fluxgate2"}).exit_code, 0);
  ASSERT_TRUE(eventually([&] { return state_of(bench, "s2") == "gone"; })) << bench.daemon().err();
  EXPECT_FALSE(fs::exists(fs::symlink_status(link)));
  const int taken = ::posix_openpt(O_RDWR | O_NOCTTY);
  ASSERT_EQ(bench.rig({"fault", bench.ports(), "restore", "fluxgate2"}).exit_code, 0);
  const auto plugged = std::chrono::steady_clock::now();
  ASSERT_TRUE(eventually([&] { return state_of(bench, "s2") == "live"; })) << bench.daemon().err();
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - plugged;
  fmt::print("live {:.2f} s after the replug\n", took.count());
  RecordProperty("live_after_ms", static_cast<int>(took.count() * 1000));
  EXPECT_NE(fs::read_symlink(link), before);
  const Finished watch = bench.mgt({"watch", "--raw", "--count", "5"});
  EXPECT_THAT(watch.out, ::testing::HasSubstr("TENSOR"));
  for (const json& device : bench.ask({"status"}).at("devices"))
    EXPECT_TRUE(device.at("balanced")) << device.dump();
  if (taken >= 0) ::close(taken);
}

}  // namespace
}  // namespace mgtd::testing
