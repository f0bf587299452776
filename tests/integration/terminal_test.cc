// SPDX-License-Identifier: Apache-2.0
// What an operator sees on a terminal, and what a pipe gets instead.
#include <gmock/gmock.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "calib/report/seen_width.h"
#include "tests/integration/bench.h"
#include "tests/support/on_terminal.h"

namespace mgtd::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kGreenLive = "\x1b[32mlive\x1b[0m";

std::vector<std::string> command(const Bench& bench, std::vector<std::string> words) {
  words.insert(words.begin(), {program("mgt"), "--socket", bench.dir() / "control.sock"});
  return words;
}

/// Without escape sequences, and without progress that was written over; a terminal ends its lines with CR
/// LF.
std::string plain(const std::string& text) {
  std::string out;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '\x1b') {
      i = text.find_first_of("mAJK", i);
      if (i == std::string::npos) break;
    } else if (text[i] != '\r') {
      out += text[i];
    } else if (text.substr(i + 1, 1) != "\n") {
      out.erase(out.rfind('\n') + 1);
    }
  }
  return out;
}

/// In characters as they are seen; commands to copy stay whole and do not count.
std::size_t longest_line(const std::string& text) {
  std::size_t out = 0;
  std::istringstream lines(plain(text));
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with("  mgt ")) out = std::max(out, calib::report::seen_width(line));
  return out;
}

TEST(Terminal, ReportsFitItAndAreColouredThereOnly) {
  Bench bench;
  bench.start_daemon();
  const auto status = command(bench, {"status"});
  const Finished seen = run_on_terminal(status, 80);
  EXPECT_EQ(seen.exit_code, 0) << seen.out;
  EXPECT_THAT(seen.out, HasSubstr(kGreenLive));
  EXPECT_LE(longest_line(seen.out), 80U) << seen.out;
  EXPECT_THAT(run_on_terminal(status, 80, {"NO_COLOR=1"}).out, Not(HasSubstr("\x1b")));
  EXPECT_THAT(bench.mgt({"status"}).out, Not(HasSubstr("\x1b")));
  EXPECT_THAT(bench.mgt({"--color", "always", "status"}).out, HasSubstr(kGreenLive));
}

TEST(Terminal, EveryReportOfPosesFitsItAndIsWholeInAPipe) {
  const TemporaryDirectory dir;
  const std::string clean = dir / "clean.csv", poses = dir / "poses.csv", cal = dir / "cal.json",
                    run = dir / "run.mgtrun";
  std::ofstream(dir / "rig.toml")
      << "[rig]\nname = \"g\"\nparameters = \"table6\"\nseed = 2\n"
         "[[effect]]\nname = \"site.gradient\"\nnT_per_m = [50, -20, 15, -25, 10]\n";
  ASSERT_EQ(run_program({program("mgt-rig"), "table", "-o", clean}, dir.path()).exit_code, 0);
  ASSERT_EQ(
      run_program({program("mgt-rig"), "table", "--scenario", dir / "rig.toml", "-o", poses}, dir.path())
          .exit_code,
      0);
  ASSERT_EQ(run_program({program("mgt"), "fit", clean, "-o", cal}, dir.path()).exit_code, 0);
  ASSERT_EQ(run_program({program("mgt"), "import", poses, "-o", run}, dir.path()).exit_code, 0);
  const std::string formula =
      "k1*(T_degC - 20)^2 + k2*(T_degC - 20)^3 + k3*(T_degC - 20)^4*sign(u)*abs(u)^0.5";
  for (std::vector<std::string> report :
       std::vector<std::vector<std::string>>{{"compare", poses},
                                             {"improve", poses},
                                             {"next", poses, "axis.offset.drift", "axis.gain.drift"},
                                             {"plan"},
                                             {"check", cal, poses},
                                             {"diff", clean, poses},
                                             {"define", run, "warm", formula}}) {
    report.insert(report.begin(), program("mgt"));
    for (const std::uint16_t columns : {std::uint16_t{60}, std::uint16_t{100}}) {
      const std::string seen = run_on_terminal(report, columns).out;
      EXPECT_LE(longest_line(seen), columns) << plain(seen);
    }
    const std::string piped = run_program(report, dir.path()).out;
    EXPECT_GT(longest_line(piped), 100U) << piped;
  }
}

TEST(Terminal, WatchChangesOnePanelInPlace) {
  Bench bench("1");  // a status comes every second
  bench.start_daemon();
  const Finished panel = run_on_terminal(command(bench, {"watch", "--count", "8"}), 80);
  EXPECT_EQ(panel.exit_code, 0) << panel.out;
  EXPECT_THAT(panel.out, HasSubstr("A\x1b[Jsample"));  // the cursor went back to the first line
  EXPECT_THAT(plain(panel.out), HasSubstr("devices   s1 live, s2 live, s3 live, s4 live"));
  const Finished lines = run_on_terminal(command(bench, {"watch", "--lines", "--count", "3"}), 200);
  EXPECT_THAT(lines.out, Not(HasSubstr("\x1b[J")));
  EXPECT_THAT(plain(lines.out), HasSubstr("cal none"));
}

TEST(Terminal, ARunThatWaitsNamesTheDeviceThatIsLost) {
  Bench bench;
  bench.start_daemon();
  ASSERT_EQ(bench.mgt({"run", "start", "--step", "20", "--random", "16", "--detach"}).exit_code, 0);
  ASSERT_TRUE(eventually([&] { return bench.ask({"run", "status"}).value("pose", 0) >= 1; }));
  ASSERT_EQ(bench.rig({"fault", bench.ports(), "unplug", "fluxgate2"}).exit_code, 0);
  ChildProcess follow(command(bench, {"run", "follow"}), bench.dir().path(), "follow");
  EXPECT_TRUE(eventually([&] { return follow.err().find("s2 is lost") != std::string::npos; }))
      << follow.err();
  ASSERT_EQ(bench.rig({"fault", bench.ports(), "restore", "fluxgate2"}).exit_code, 0);
  EXPECT_TRUE(eventually([&] { return follow.err().find("the run goes on\n") != std::string::npos; }))
      << follow.err();
  EXPECT_EQ(bench.mgt({"run", "abort"}).exit_code, 0);
}

TEST(Terminal, ACalibrationIsShownForPeopleAndNamedByItsBeginning) {
  Bench bench;
  bench.start_daemon();
  ASSERT_EQ(bench.mgt(kShortRun).exit_code, 0);
  const std::string id = bench.ask({"calibrations", "show", "latest"}).at("id");
  const Finished shown = bench.mgt({"calibrations", "show", id.substr(0, 4)});
  EXPECT_THAT(shown.out, HasSubstr("joint calibration " + id));
  EXPECT_THAT(shown.out, HasSubstr("alpha deg"));
  EXPECT_LE(longest_line(run_on_terminal(command(bench, {"calibrations", "show", id}), 100).out), 110U);
  const Finished unknown = bench.mgt({"calibrations", "show", "nonsense"});
  EXPECT_EQ(unknown.exit_code, 2);
  EXPECT_THAT(unknown.err, HasSubstr("mgt calibrations list"));
}

}  // namespace
}  // namespace mgtd::testing
