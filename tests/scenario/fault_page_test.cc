// SPDX-License-Identifier: Apache-2.0
// docs/faults.md says what happens, fault by fault: here it happens, and the page must say the same.
//
//   MGTD_WRITE_PAGE=1 build/bin/scenario_test --gtest_filter='FaultPage.*'     writes the table anew
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "tests/scenario/fault_story.h"
#include "tests/support/checkout.h"
#include "tests/support/child_process.h"
#include "tests/support/whole_file.h"

namespace mgtd {
namespace {

using mgtd::RunState;

const std::string kPage = mgtd::testing::source_path("docs/faults.md");
constexpr std::string_view kBegin = "<!-- seen by scenario_test -->\n", kEnd = "<!-- so far -->\n";

struct Fault {
  const char* words;
  RunState when;
  const char* said;
};
constexpr std::array<Fault, 38> kFaults{{
    {"unplug fluxgate2 for 5", RunState::dwelling, "sensor unplugged for 5 s"},
    {"unplug fluxgate1 for 5", RunState::moving, "the same, sensor 1, during a move"},
    {"unplug table for 5", RunState::moving, "table unplugged during a move"},
    {"unplug scalar for 15", RunState::dwelling, "scalar magnetometer unplugged for 15 s"},
    {"stall fluxgate2 for 5", RunState::dwelling, "sensor hangs for 5 s"},
    {"stall table for 15", RunState::moving, "table controller hangs for 15 s"},
    {"mute table for 15", RunState::moving, "table controller obeys and says nothing for 15 s"},
    {"late table for 60", RunState::moving, "table answers 0.4 to 2 s late for a minute"},
    {"late table for 60;unplug fluxgate2 for 5", RunState::moving,
     "the same, and a sensor is unplugged, so that the table is stopped meanwhile"},
    {"late scalar for 30", RunState::dwelling, "readings of the scalar magnetometer come 0.4 to 2 s late"},
    {"stall scalar for 30", RunState::dwelling, "scalar magnetometer hangs for 30 s"},
    {"power fluxgate2 for 3", RunState::dwelling,
     "digitiser without power for 3 s; it forgets range and rate"},
    {"power table for 3", RunState::settling,
     "table controller without power for 3 s; it forgets its reference"},
    {"power scalar for 3", RunState::dwelling, "scalar magnetometer without power for 3 s"},
    {"garbage fluxgate2", RunState::dwelling, "200 bytes of garbage from a sensor"},
    {"garbage table", RunState::moving, "200 bytes of garbage from the table"},
    {"torn fluxgate2 for 10", RunState::dwelling, "one byte in a hundred lost for 10 s"},
    {"half fluxgate2 for 10", RunState::dwelling, "every other line of a sensor cut in half for 10 s"},
    {"half table for 5", RunState::moving, "every other answer of the table cut in half for 5 s"},
    {"twice fluxgate2 for 10", RunState::dwelling, "every line of a sensor twice for 10 s"},
    {"swap fluxgate2 for 10", RunState::dwelling, "lines of a sensor in the wrong order for 10 s"},
    {"stranger fluxgate2 for 20", RunState::dwelling, "a satellite receiver on a sensor's port for 20 s"},
    {"exchange fluxgate2 fluxgate4 for 20", RunState::dwelling, "plugs of two sensors exchanged for 20 s"},
    {"stranger table for 20", RunState::settling, "a satellite receiver on the table's port for 20 s"},
    {"stranger scalar for 30", RunState::dwelling,
     "a satellite receiver on the port of the scalar magnetometer for 30 s"},
    {"freeze fluxgate2 for 6", RunState::dwelling, "sensor repeats its last reading for 6 s"},
    {"saturate fluxgate2 for 6", RunState::dwelling, "sensor at the end of its range for 6 s"},
    {"rate fluxgate2", RunState::dwelling, "digitiser sends half as often"},
    {"clock fluxgate2", RunState::dwelling, "clock of a time-stamper jumps by 3 s"},
    {"the host's clock", RunState::dwelling, "the host's clock is set back by an hour"},
    {"freeze table for 20", RunState::moving, "table jams for 20 s"},
    {"runaway table for 5", RunState::dwelling, "table turns by itself for 5 s during a dwell"},
    {"runaway table for 5", RunState::moving, "the same during a move"},
    {"backwards table for 5", RunState::dwelling, "table turns the wrong way at its next move"},
    {"limit table for 5", RunState::moving, "table meets a limit switch"},
    {"stand still", RunState::moving, "the whole program stands still for 1.3 s"},
    {"kill", RunState::dwelling, "the daemon is killed (SIGKILL, power failure of the host)"},
    {"terminate", RunState::moving, "the daemon is told to end (SIGTERM)"},
}};

std::string table() {
  std::string out =
      "| what happens | link of the device | the run | the stream | stored |\n|---|---|---|---|---|\n";
  for (const Fault& fault : kFaults) {
    SCOPED_TRACE(fault.said);
    out += test::FaultTeller(fault.words, fault.when).tell().row(fault.said) + "\n";
  }
  return out;
}

TEST(FaultPage, SaysWhatHappens) {
  std::string page = testing::whole_file(kPage);
  const std::size_t begin = page.find(kBegin), end = page.find(kEnd);
  ASSERT_NE(begin, std::string::npos) << kPage;
  ASSERT_NE(end, std::string::npos) << kPage;
  const std::size_t from = begin + kBegin.size();
  const std::string seen = table();
  if (std::getenv("MGTD_WRITE_PAGE") != nullptr) {
    page.replace(from, end - from, seen);
    std::ofstream(kPage) << page;
    return;
  }
  std::istringstream said(page.substr(from, end - from)), happened(seen);
  for (std::string a, b; std::getline(happened, b);) {
    std::getline(said, a);
    EXPECT_EQ(a, b) << "docs/faults.md and what happens differ";
  }
}

}  // namespace
}  // namespace mgtd
