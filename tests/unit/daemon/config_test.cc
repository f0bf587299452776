// SPDX-License-Identifier: Apache-2.0
#include "daemon/config.h"

#include <gmock/gmock.h>

namespace mgtd::daemon {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

TEST(Config, EveryMistakeIsReportedAtOnceWithItsLine) {
  const auto config = parse_config(
      "[rig]\n"
      "basline_m = 0.4\n"  // line 2
      "[site]\n"
      "field_nT = \"strong\"\n"  // line 4
      "[run]\n"
      "step_deg = 15\n"  // line 6
      "[cellar]\n"       // line 7
      "wine = 1\n",
      "rig.toml");
  ASSERT_FALSE(config);
  const auto& lines = config.error().lines;
  EXPECT_THAT(lines,
              Contains(HasSubstr("rig.toml:2: [rig]: unknown key 'basline_m', did you mean 'baseline_m'?")));
  EXPECT_THAT(lines, Contains(HasSubstr("rig.toml:4: [site]: 'field_nT' must be a number")));
  EXPECT_THAT(lines, Contains(HasSubstr("rig.toml:6: [run]: 'step_deg': must be 10 or 20 deg")));
  EXPECT_THAT(lines, Contains(StartsWith("rig.toml:7: unknown section 'cellar'")));
  EXPECT_THAT(lines, Contains(HasSubstr("four [[sensor]] sections are needed")));
  EXPECT_THAT(lines, Contains(HasSubstr("the [table] section is missing")));
}

TEST(Config, BrokenTomlIsNamedWithLineAndColumn) {
  const auto config = parse_config("[rig\nname = 1\n", "rig.toml");
  ASSERT_FALSE(config);
  ASSERT_EQ(config.error().lines.size(), 1U);
  EXPECT_THAT(config.error().lines[0], StartsWith("rig.toml:1:"));
}

TEST(Config, AFileThatIsNotThereSaysWhatToDo) {
  const auto config = load_config("/nonexistent/mgtd.toml");
  ASSERT_FALSE(config);
  EXPECT_THAT(config.error().lines.at(0), HasSubstr("--config"));
}

TEST(Config, AnUnknownDriverIsRefused) {
  const auto config = parse_config("[table]\ndriver = \"bartington\"\nport = \"/dev/x\"\n", "rig.toml");
  ASSERT_FALSE(config);
  EXPECT_THAT(config.error().lines,
              Contains(HasSubstr("rig.toml:2: [table]: 'driver': no such driver here")));
}

}  // namespace
}  // namespace mgtd::daemon
