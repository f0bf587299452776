// SPDX-License-Identifier: Apache-2.0
// A cable is pulled and put in again: another node, the same name, and the stream goes on.
#include <fcntl.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <stdlib.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <sstream>

#include "tests/integration/bench.h"
#include "tests/support/parameter_name.h"

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

/// Time of the first tensor in a stream's raw lines after `after_ns`, wall clock; 0 when there is none.
std::int64_t first_tensor_after(const std::string& lines, std::int64_t after_ns) {
  std::istringstream in(lines);
  for (std::string line; std::getline(in, line);) {
    const json object = json::parse(line, nullptr, false);
    if (!object.is_object() || object.value("class", "") != "TENSOR") continue;
    if (const std::int64_t t_ns = object.at("t_ns"); t_ns > after_ns) return t_ns;
  }
  return 0;
}

class Replug : public ::testing::TestWithParam<const char*> {};

/// In real time, so that the seconds it takes are seconds; they are printed, a slow machine fails nobody.
TEST_P(Replug, AnotherNodeUnderTheSameNameStreamsAgain) {
  namespace fs = std::filesystem;
  Bench bench("1", fmt::format("[rig]\nname = \"replug\"\nparameters = \"table6\"\n[sensors]\npalmacq = {}\n",
                               GetParam()));
  bench.start_daemon();
  const std::string link = bench.ports() + "/fluxgate2";
  const fs::path before = fs::read_symlink(link);
  ASSERT_EQ(bench.rig({"fault", bench.ports(), "unplug", "fluxgate2"}).exit_code, 0);
  ASSERT_TRUE(eventually([&] { return state_of(bench, "s2") == "gone"; })) << bench.daemon().err();
  EXPECT_FALSE(fs::exists(fs::symlink_status(link)));
  ChildProcess watch({program("mgt"), "--socket", bench.dir() / "control.sock", "watch", "--raw"},
                     bench.dir().path(), "watch");
  // Longer than any wait for the port grows.
  const auto away = std::chrono::steady_clock::now() + std::chrono::seconds(5);
  ASSERT_TRUE(eventually([&] { return std::chrono::steady_clock::now() > away; }));
  // Another terminal is opened meanwhile, so that the number is taken.
  const int taken = ::posix_openpt(O_RDWR | O_NOCTTY);
  ASSERT_EQ(bench.rig({"fault", bench.ports(), "restore", "fluxgate2"}).exit_code, 0);
  const std::int64_t plugged_ns =
      std::chrono::system_clock::now().time_since_epoch() / std::chrono::nanoseconds(1);
  std::int64_t first_ns = 0;
  ASSERT_TRUE(eventually([&] {
    first_ns = first_tensor_after(watch.out(), plugged_ns);
    return first_ns > 0;
  })) << bench.daemon().err();
  const double took_s = static_cast<double>(first_ns - plugged_ns) * 1e-9;
  fmt::print("the first tensor {:.2f} s after the replug\n", took_s);
  RecordProperty("tensor_after_ms", static_cast<int>(took_s * 1000));
  EXPECT_NE(fs::read_symlink(link), before);
  const json devices = bench.ask({"status"}).at("devices");
  for (const json& device : devices) EXPECT_TRUE(device.at("balanced")) << device.dump();
  if (taken >= 0) ::close(taken);
}

INSTANTIATE_TEST_SUITE_P(PalmAcq, Replug, ::testing::Values("false", "true"),
                         [](const auto& info) { return parameter_name(info.param); });

}  // namespace
}  // namespace mgtd::testing
