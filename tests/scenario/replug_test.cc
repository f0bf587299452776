// SPDX-License-Identifier: Apache-2.0
// A sensor's cable is pulled and put in again: how long until the tensor streams.
#include <fmt/format.h>

#include "tests/scenario/virtual_stream.h"

namespace mgtd::test {
namespace {

constexpr double kGoal_s = 2;

std::string scenario_text(bool palmacq, bool autostart) {
  return fmt::format(
      "[rig]\nname = \"replug\"\nparameters = \"table6\"\nseed = 6\n[sensors]\npalmacq = {}\nautostart = "
      "{}\n",
      palmacq, autostart);
}

/// Seconds from the plug to the first epoch of the stream, for one cable that was out for `away_s`.
double replugged_after(VirtualStream& daemon, int sensor, double away_s) {
  double plugged_s = 1e300, first_s = 0;
  daemon.on_line = [&](const RingRecord& record) {
    if (record.kind == RingRecord::Kind::sample && first_s == 0 && daemon.t_s > plugged_s)
      first_s = daemon.t_s;
  };
  daemon.fault(fmt::format("unplug fluxgate{}", sensor));
  daemon.run(away_s);
  plugged_s = daemon.t_s;
  daemon.fault(fmt::format("restore fluxgate{}", sensor));
  daemon.run(6);
  return first_s - plugged_s;
}

class Replug : public ::testing::TestWithParam<std::tuple<bool, bool>> {};

/// In whatever moment of the look for the port the plug goes in: what counts is the longest.
TEST_P(Replug, TheTensorStreamsInUnderTwoSeconds) {
  const auto [palmacq, autostart] = GetParam();
  double longest_s = 0;
  for (const int sensor : {1, 3}) {
    VirtualStream daemon(scenario_of(scenario_text(palmacq, autostart)));
    daemon.start();
    daemon.run(10);
    for (const double away_s : {0.05, 0.3, 1.07, 2.9, 4.16, 7.33, 20.01, 20.21}) {
      const double took_s = replugged_after(daemon, sensor, away_s);
      EXPECT_GT(took_s, 0) << "none came";
      longest_s = std::max(longest_s, took_s);
    }
  }
  fmt::print("{}: the longest replug took {:.2f} s\n", palmacq ? "behind a PalmAcq" : "directly", longest_s);
  EXPECT_LT(longest_s, kGoal_s);
}

INSTANTIATE_TEST_SUITE_P(Kinds, Replug, ::testing::Combine(::testing::Bool(), ::testing::Bool()));

}  // namespace
}  // namespace mgtd::test
