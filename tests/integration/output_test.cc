// SPDX-License-Identifier: Apache-2.0
// What the programs write: never over what they read, and never into nothing without a word.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/checkout.h"
#include "tests/support/child_process.h"
#include "tests/support/whole_file.h"

namespace mgtd::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

/// A pose table, a run file and a calibration of it, as an operator has them in a folder.
class Outputs : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_EQ(
        run_program({program("mgt-rig"), "table", "--rig", "table6", "-o", poses()}, dir_.path()).exit_code,
        0);
    ASSERT_EQ(mgt({"import", poses(), "-o", run()}).exit_code, 0);
    ASSERT_EQ(mgt({"fit", poses(), "-o", calibration()}).exit_code, 0);
  }
  [[nodiscard]] Finished mgt(std::vector<std::string> words) const {
    words.insert(words.begin(), program("mgt"));
    return run_program(std::move(words), dir_.path());
  }
  /// A command line with redirections.
  [[nodiscard]] Finished shell(const std::string& line) const {
    return run_program({"/bin/sh", "-c", "cd " + dir_.path() + " && exec " + line, program("mgt"),
                        program("mgt-rig"), poses()},
                       dir_.path());
  }
  [[nodiscard]] std::string poses() const { return dir_ / "poses.csv"; }
  [[nodiscard]] std::string run() const { return dir_ / "run.mgtrun"; }
  [[nodiscard]] std::string calibration() const { return dir_ / "cal.json"; }

  TemporaryDirectory dir_;
};

/// The measurement is there once: a slip of the file name must not cost it.
TEST_F(Outputs, NoCommandWritesOverWhatItReads) {
  const std::string link = dir_ / "link.csv", hard = dir_ / "hard.csv";
  std::filesystem::create_symlink("poses.csv", link);
  std::filesystem::create_hard_link(poses(), hard);
  const std::vector<std::vector<std::string>> slips{
      {"fit", poses(), "-o", poses()},
      {"fit", poses(), "-o", link},
      {"fit", link, "-o", hard},
      {"fit", run(), "--and", poses(), "-o", poses()},
      {"fit", run(), "-o", run()},
      {"improve", poses(), "-o", poses()},
      {"next", poses(), "-o", poses()},
      {"compare", poses(), "-o", poses()},
      {"report", poses(), "-o", poses()},
      {"report", run(), "--earlier", calibration(), "-o", calibration()},
      {"export", run(), "-o", run()},
      {"apply", calibration(), poses(), "-o", poses()},
      {"apply", calibration(), poses(), "-o", calibration()},
      {"history", calibration(), poses(), "--figure", poses()}};
  const std::string table = whole_file(poses()), kept = whole_file(run()), result = whole_file(calibration());
  for (const std::vector<std::string>& slip : slips) {
    const Finished refused = mgt(slip);
    EXPECT_EQ(refused.exit_code, 2) << ::testing::PrintToString(slip);
    EXPECT_THAT(refused.err, HasSubstr(slip.back()));
    EXPECT_THAT(refused.err, HasSubstr("it would be overwritten: give another name")) << refused.err;
    ASSERT_EQ(whole_file(poses()), table);
    ASSERT_EQ(whole_file(run()), kept);
    ASSERT_EQ(whole_file(calibration()), result);
  }
  EXPECT_THAT(mgt({"fit", link, "-o", hard}).err, HasSubstr(hard + " and " + link));
}

TEST_F(Outputs, TheRigWritesOverNoListOfPoses) {
  const std::string list = dir_ / "list.csv", text = "azimuth_deg,pitch_deg,roll_deg\n10,0,0\n";
  std::ofstream(list) << text;
  const Finished slip = run_program({program("mgt-rig"), "table", "--poses", list, "-o", list}, dir_.path());
  EXPECT_EQ(slip.exit_code, 2);
  EXPECT_THAT(slip.err, HasSubstr("would be overwritten"));
  EXPECT_EQ(shell("\"$1\" table --seal x -o x").exit_code, 2);
  EXPECT_EQ(whole_file(list), text);
}

/// Also a run file that the command does not read holds a measurement.
TEST_F(Outputs, NoCommandWritesOverARunFile) {
  const std::string other = dir_ / "other.mgtrun", called = dir_ / "called.json";
  std::filesystem::copy_file(run(), other);
  std::filesystem::create_hard_link(other, called);
  const std::string kept = whole_file(other);
  for (const std::string& target : {other, called}) {
    const Finished refused = mgt({"fit", poses(), "-o", target});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err, HasSubstr(target + " is a run file"));
    EXPECT_EQ(whole_file(target), kept);
  }
  const Finished named = mgt({"export", run(), "-o", dir_ / "new.mgtrun"});
  EXPECT_EQ(named.exit_code, 2);
  EXPECT_THAT(named.err, HasSubstr("has the name of a run file"));
  EXPECT_FALSE(std::filesystem::exists(dir_ / "new.mgtrun"));
}

/// Standard output may be the file itself: what is said about it is not part of it.
TEST_F(Outputs, WhatIsSaidOfAFileIsNotInIt) {
  const std::string table = mgt({"export", run()}).out;
  const Finished exported = mgt({"export", run(), "-o", "/dev/stdout"});
  EXPECT_EQ(exported.out, table);
  EXPECT_EQ(exported.err, "157 poses written to /dev/stdout\n");
  const Finished page = mgt({"report", poses(), "-o", "/dev/stdout"});
  EXPECT_THAT(page.out, ::testing::EndsWith("</html>\n"));
  EXPECT_THAT(page.err, HasSubstr("report written to /dev/stdout\n"));
  const Finished applied = mgt({"apply", calibration(), poses(), "-o", dir_ / "applied.csv"});
  EXPECT_EQ(applied.out, "");
  EXPECT_THAT(applied.err, HasSubstr("157 rows written to "));
}

/// Also where a command has something to print beside the file.
TEST_F(Outputs, StandardOutputAsAFileHoldsNothingElse) {
  const std::string result = whole_file(calibration());
  const Finished piped = mgt({"fit", poses(), "-o", "/dev/stdout"});
  EXPECT_EQ(piped.exit_code, 0);
  EXPECT_EQ(piped.out, result);
  EXPECT_THAT(piped.err, HasSubstr("accepted by its checks"));
  EXPECT_EQ(shell("\"$0\" fit \"$2\" --json -o /dev/stdout > one.json").exit_code, 0);
  EXPECT_EQ(whole_file(dir_ / "one.json"), result);
  EXPECT_EQ(shell("\"$0\" fit \"$2\" -o both.json > both.json").exit_code, 0);
  EXPECT_EQ(whole_file(dir_ / "both.json"), result);
  std::ofstream(dir_ / "more.csv") << "# a line before\n";
  EXPECT_EQ(shell("\"$0\" export run.mgtrun -o /dev/stdout >> more.csv").exit_code, 0);
  EXPECT_EQ(whole_file(dir_ / "more.csv"), "# a line before\n" + mgt({"export", run()}).out);
  const Finished nowhere = shell("\"$0\" fit \"$2\" -o /dev/null > /dev/null");
  EXPECT_THAT(nowhere.err, Not(HasSubstr("accepted by its checks")));
}

/// Whoever searches a file for words finds them in one line.
TEST_F(Outputs, LinesStayWholeInAPipe) {
  const std::string found = mgt({"discover", poses(), "--quick"}).out;
  EXPECT_THAT(found, ::testing::ContainsRegex("residual [^\n]* questions with their places\n"));
  const std::string evidence = mgt({"why", "axis.cubic", poses()}).out;
  EXPECT_THAT(evidence, ::testing::ContainsRegex("carry half of the evidence[^\n]* of it\n"));
}

/// A full disk behind standard output, as a redirection meets it.
TEST_F(Outputs, AProgramThatCannotPrintSaysSo) {
  for (const std::string& command :
       {std::string("\"$0\" fit \"$2\""), std::string("\"$0\" apply cal.json \"$2\""),
        std::string("\"$0\" export run.mgtrun"), std::string("\"$0\" plan"), std::string("\"$0\" effects"),
        std::string("\"$0\" --help"), std::string("\"$0\" --version"),
        std::string("\"$0\" fit \"$2\" --json"), std::string("\"$1\" table"), std::string("\"$1\" --help")}) {
    const Finished full = shell(command + " > /dev/full");
    EXPECT_EQ(full.exit_code, 2) << command << full.signal;
    EXPECT_THAT(full.err, HasSubstr("cannot write to standard output: No space left on device")) << command;
    const Finished both = shell(command + " > /dev/full 2>&1");
    EXPECT_EQ(both.exit_code, 2) << command << both.signal;
    const Finished closed = shell(command + " >&-");
    EXPECT_EQ(closed.exit_code, 2) << command << closed.signal;
    EXPECT_THAT(closed.err, HasSubstr("cannot write to standard output: Bad file descriptor")) << command;
  }
}

/// What needs no standard output goes on without it, and no file that it opens is taken for it.
TEST_F(Outputs, AFileIsWrittenWholeWithoutStandardOutput) {
  const Finished exported = shell("\"$0\" export run.mgtrun -o copy.csv >&- 2>&-");
  EXPECT_EQ(exported.exit_code, 0);
  EXPECT_EQ(whole_file(dir_ / "copy.csv"), mgt({"export", run()}).out);
}

}  // namespace
}  // namespace mgtd::testing
