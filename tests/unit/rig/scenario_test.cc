// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/scenario.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <sstream>

namespace mgtd::rig {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(Scenario, EveryFileOfTheRepositoryIsOne) {
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(MGTD_SOURCE_DIR "/tests/scenarios")) {
    std::ifstream in(entry.path());
    std::ostringstream text;
    text << in.rdbuf();
    const auto scenario = parse_scenario(text.str(), entry.path().filename().string());
    EXPECT_TRUE(scenario.has_value()) << (scenario ? "" : scenario.error().front());
    ++files;
  }
  EXPECT_GE(files, 8);
}

TEST(Scenario, TellsEveryMistakeWithItsLine) {
  const auto scenario = parse_scenario(
      "[site]\nrecord = 'usgs-bou-1816-01-01'\n[temperature]\nlaw = 'linear'\n[sensors]\nwiring = [1, 1, 3, "
      "4]\n[[effect]]\nname = 'platform.current'\nof = 'lamp_A'\nnT_per_A = [1, 2, 3]\n",
      "s.toml");
  ASSERT_FALSE(scenario.has_value());
  EXPECT_THAT(scenario.error(),
              ElementsAre(HasSubstr("s.toml:2: [site] record = 'usgs-bou-1816-01-01'"),
                          HasSubstr("s.toml:4: [temperature] law = 'linear'"),
                          HasSubstr("s.toml:6: [sensors] wiring must be 1 to 4"),
                          HasSubstr("s.toml:9: [effect] of = 'lamp_A': there is no [[covariate]]")));
}

}  // namespace
}  // namespace mgtd::rig
