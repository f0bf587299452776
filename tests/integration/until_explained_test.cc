// SPDX-License-Identifier: Apache-2.0
// A run that goes on until its residual is explained, by the real programs, with a daemon that is killed
// while it waits for a hand.
#include <gmock/gmock.h>

#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/integration/bench.h"
#include "tests/support/whole_file.h"

namespace mgtd::testing {
namespace {

using ::testing::AnyOf;
using ::testing::HasSubstr;

constexpr const char* kOwnSquare =
    "[rig]\nparameters = \"random\"\nseed = 17\n[[effect]]\nname = \"axis.quadratic\"\nwhere = \"s2.y\"\n"
    "nT_at_F0 = 3\n";
constexpr int kPlanned = 34, kFurther = 24;

std::string run_file(const Bench& bench) {
  for (const auto& entry : std::filesystem::recursive_directory_iterator(bench.dir().path()))
    if (entry.path().extension() == ".mgtrun") return entry.path();
  return {};
}

TEST(UntilExplained, AKilledDaemonGoesOnWithWhatItHadPlanned) {
  Bench bench("60", kOwnSquare);
  bench.start_daemon();
  std::vector<std::string> start = kShortRun;
  start.insert(start.end(), {"--until-explained", "--minutes", "40", "--detach"});
  ASSERT_EQ(bench.mgt(start).exit_code, 0) << bench.daemon().err();
  const auto asks = [&] { return bench.ask({"run", "status"}).value("state", "") == "asking"; };
  ASSERT_TRUE(eventually(asks)) << bench.daemon().err();
  EXPECT_EQ(bench.ask({"run", "status"}).at("poses"), kPlanned + kFurther);
  bench.daemon().signal(SIGKILL);
  ASSERT_TRUE(bench.daemon().wait());

  bench.start_daemon();
  const nlohmann::json found = bench.ask({"run", "status"});
  EXPECT_EQ(found.at("state"), "interrupted");
  EXPECT_EQ(found.at("pose"), kPlanned);
  EXPECT_EQ(found.at("poses"), kPlanned + kFurther);
  ASSERT_EQ(bench.mgt({"run", "resume", "--detach"}).exit_code, 0);
  const Finished hands =
      run_program({program("mgt-rig"), "operate", bench.ports(), "--control", bench.dir() / "control.sock"},
                  bench.dir().path(), std::chrono::seconds(300));
  EXPECT_EQ(hands.exit_code, 0) << hands.out << hands.err << bench.daemon().err();
  EXPECT_THAT(hands.out, HasSubstr("coil 0.8"));
  EXPECT_EQ(bench.ask({"run", "status"}).at("pose"), kPlanned + kFurther);

  const std::string run = run_file(bench), page = bench.dir() / "report.html";
  EXPECT_EQ(bench.ask({"explain", run}).at("verdict"), "EXPLAINED");
  ASSERT_EQ(bench.mgt({"report", run, "-o", page}).exit_code, 0);
  const std::string text = whole_file(page);
  EXPECT_THAT(text, HasSubstr("How the run went on until it was explained"));
  // Poses measured on a busy computer scatter more, and the first of them may leave a rest beside the name.
  EXPECT_THAT(text, AnyOf(HasSubstr("AMBIGUOUS: axis.quadratic or axis.transverse"),
                          HasSubstr("PARTIAL: axis.quadratic")));
  EXPECT_THAT(text, HasSubstr("EXPLAINED: axis.quadratic"));
}

TEST(UntilExplained, MinutesWithoutTheWishAreRefused) {
  const Finished refused = run_program({program("mgt"), "run", "start", "--minutes", "10"}, "/");
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.err, HasSubstr("--until-explained"));
}

}  // namespace
}  // namespace mgtd::testing
