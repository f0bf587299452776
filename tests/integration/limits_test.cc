// SPDX-License-Identifier: Apache-2.0
// What the limits of a table cost, as an operator is told before a run.
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "tests/integration/bench.h"

namespace mgtd::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

/// A table that tilts by 90 degrees either way: roll reaches half of its turn, pitch all that counts.
TEST(Limits, ThePlanAndTheDryRunSayWhatTheyCost) {
  Bench bench("30", "[rig]\nname = \"narrow\"\nparameters = \"table6\"\n[table]\ntilt_limit_deg = 90\n");
  bench.start_daemon();
  const char* const said = "limits of the table: roll -90 to 90 deg; 50 % of all attitudes are left out";
  const Finished plan = bench.mgt({"plan", "--config", bench.config_path()});
  EXPECT_THAT(plan.out, HasSubstr(said));
  EXPECT_THAT(plan.out, HasSubstr("what to do: widen limits.roll"));
  EXPECT_THAT(bench.mgt({"run", "dry-run"}).out, HasSubstr(said));
  const json planned = bench.ask({"plan", "--config", bench.config_path()}).at("limits");
  const json rehearsed = bench.ask({"run", "dry-run"}).at("limits");
  EXPECT_EQ(rehearsed, planned) << "the same run, the same table";
  EXPECT_GT(planned.at("groups").at(0).at("times").get<double>(), 1);
  const json shorter = bench.ask({"run", "dry-run", "--random", "40"});
  EXPECT_NE(shorter.at("limits"), planned);
  EXPECT_FALSE(shorter.contains("config"));
}

}  // namespace
}  // namespace mgtd::testing
