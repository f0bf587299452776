// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/report_wishes.h"

#include <gmock/gmock.h>

#include <fstream>
#include <regex>
#include <set>

#include "calib/poses/pose_table.h"
#include "calib/report/report_page.h"
#include "tests/blind/hidden_run.h"
#include "tests/unit/daemon/temp_dir.h"

namespace mgtd::daemon::cli {
namespace {

using calib::report::report_page;
using calib::report::ReportContent;
using ::testing::HasSubstr;
using ::testing::Not;

/// Of a run whose third sensor warms up, with a column of a hostile name.
ReportContent content(const std::filesystem::path& folder, ReportWishes wishes = {}) {
  PoseTable table = calib::testing::hidden_run(
      {.noise_nT = 0.05,
       .hidden = [](const Pose& p, int i, int a,
                    const Eigen::Vector3d&) { return i == 2 && a == 2 ? 0.5 * (*p.T_degC[2] - 20) : 0.0; }},
      5);
  for (Pose& pose : table.poses) pose.covariates["<script>"] = *pose.T_degC[2] * 0.1;
  wishes.run = (folder / "run.csv").string();
  wishes.output = "report.html";
  std::ofstream(wishes.run, std::ios::binary) << calib::poses::format_pose_table(table);
  auto out = report_content(wishes, FitFlags{});
  EXPECT_TRUE(out) << out.error().message;
  return std::move(*out);
}

TEST(ReportOfARun, LoadsNothingAndRunsNothing) {
  const test::TempDir folder;
  const std::string page = report_page(content(folder.path()));
  for (const char* loaded : {"<script", "src=", "href=", "url(", "@import", " style=", "onload", "nan\""})
    EXPECT_THAT(page, Not(HasSubstr(loaded)));
  EXPECT_LT(page.size(), 1'500'000U);
  std::set<std::string> ids;
  const std::regex id(" id=\"([^\"]*)\"");
  for (std::sregex_iterator it(page.begin(), page.end(), id), end; it != end; ++it)
    EXPECT_TRUE(ids.insert((*it)[1]).second) << (*it)[1] << " twice";
  EXPECT_TRUE(ids.contains("waterfall") && ids.contains("skies") && ids.contains("confusion") &&
              ids.contains("price"));
}

TEST(ReportOfARun, SaysWhoWhereAndHowToMakeItAgain) {
  const test::TempDir folder;
  const ReportContent c =
      content(folder.path(),
              {.run = {}, .output = {}, .operator_name = "A. O'Hara <ao@x>", .site = "lake", .earlier = {}});
  const std::string page = report_page(c);
  EXPECT_THAT(page, HasSubstr("A. O&#39;Hara &lt;ao@x&gt;"));
  EXPECT_THAT(page, HasSubstr("lake; field"));
  EXPECT_THAT(c.command, HasSubstr("--operator 'A. O'\\''Hara <ao@x>' --site lake -o report.html"));
  for (const char* part :
       {"What was measured", "Noise", "What this run cannot tell", "The search, round by round",
        "What each effect takes out", "What the model leaves", "What could be missing", "Parameters",
        "What remains", "How the model came to be", "Checks of the calibration"})
    EXPECT_THAT(page, HasSubstr(part));
}

TEST(ReportCommand, HoldsEveryOptionThatChangesTheResult) {
  FitFlags flags;
  flags.with = {"none"};
  flags.further = {"second run.csv"};
  flags.without = "3,7-9";
  flags.field_nT = 50000;
  flags.seed = 7;
  EXPECT_EQ(
      report_command(
          {.run = "a.mgtrun", .output = "r.html", .operator_name = {}, .site = {}, .earlier = {"old.json"}},
          flags),
      "mgt report a.mgtrun --and 'second run.csv' --without 3,7-9 --with none --field 50000 --seed 7 "
      "--earlier old.json -o "
      "r.html");
}

}  // namespace
}  // namespace mgtd::daemon::cli
