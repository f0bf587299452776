// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/help_format.h"

#include <gmock/gmock.h>

#include <memory>
#include <vector>

namespace mgtd::daemon::cli {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(HelpFormat, HasNoTwoEmptyLinesAndNoCountOfZero) {
  CLI::App app{"a tool"};
  app.formatter(std::make_shared<HelpFormat>());
  CLI::App* const command = app.add_subcommand("next", "a command");
  std::string run, hidden;
  std::vector<std::string> pair, poses;
  command->add_option("RUN", run)->required();
  command->add_option("EFFECT", pair)->expected(0, 2);
  command->add_option("POSE", poses);
  command->add_option("--who", hidden)->group("");
  command->footer("Exit code 0.");
  const std::string help = command->help();
  EXPECT_THAT(help, HasSubstr("RUN [EFFECT [EFFECT]] [POSE...]"));
  EXPECT_THAT(help, HasSubstr("\n\nExit code 0."));
  EXPECT_THAT(help, Not(HasSubstr("\n\n\n")));
}

}  // namespace
}  // namespace mgtd::daemon::cli
