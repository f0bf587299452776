// SPDX-License-Identifier: Apache-2.0
#include "daemon/cli/journal_files.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>

#include "proto/raw_log.h"
#include "tests/support/child_process.h"

namespace mgtd::daemon::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class JournalFiles : public ::testing::Test {
 protected:
  std::string file(const std::string& life, int number) {
    const std::string name = fmt::format("{}.{:06}", life, number), path = scratch_ / (name + ".raw");
    std::ofstream(path) << encode_header({"rig", name});
    return path;
  }

  const std::string first_{"raw-01795255200"}, second_{"raw-01795341600"};
  mgtd::testing::TemporaryDirectory scratch_;
};

TEST_F(JournalFiles, AreInTheOrderTheyWereWrittenEachOnce) {
  const auto a0 = file(first_, 0), a1 = file(first_, 1), b0 = file(second_, 0);
  const auto found = journals_of({b0, a1, a0, a1});
  ASSERT_TRUE(found) << found.error().text();
  EXPECT_THAT(found->play, ElementsAre(a0, a1, b0));
  EXPECT_TRUE(found->left_out.empty());
}

/// The limit on the journal's space takes the oldest files first.
TEST_F(JournalFiles, ALifeWhoseFirstFileIsGoneIsLeftOutAndTheNextIsPlayed) {
  const auto a0 = file(first_, 0), a1 = file(first_, 1), a2 = file(first_, 2), b0 = file(second_, 0);
  std::filesystem::remove(a0);
  const auto found = journals_of({a1, a2, b0});
  ASSERT_TRUE(found) << found.error().text();
  EXPECT_THAT(found->play, ElementsAre(b0));
  ASSERT_EQ(found->left_out.size(), 1U);
  EXPECT_THAT(found->left_out[0].message, HasSubstr(a1 + " to " + a2 + " (2 files): not played"));
  EXPECT_THAT(found->left_out[0].message, HasSubstr(first_ + ".000000.raw, which comes before, is gone"));
  EXPECT_THAT(found->left_out[0].remedy, HasSubstr("raise journal_mb"));
}

TEST_F(JournalFiles, WhereNoneCanBePlayedThatIsRefusedWithWhatToDo) {
  const auto a0 = file(first_, 0), a1 = file(first_, 1);
  std::filesystem::remove(a0);
  const auto found = journals_of({a1});
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().message, HasSubstr(a1 + ": not played"));
  EXPECT_THAT(found.error().remedy, HasSubstr("start the daemon anew"));
}

TEST_F(JournalFiles, OneThatStandsBesideIsToBeNamed) {
  const auto a0 = file(first_, 0), a1 = file(first_, 1), a2 = file(first_, 2);
  const auto found = journals_of({a0, a2});
  ASSERT_TRUE(found) << found.error().text();
  EXPECT_THAT(found->play, ElementsAre(a0));
  ASSERT_EQ(found->left_out.size(), 1U);
  EXPECT_THAT(found->left_out[0].message, HasSubstr(a2 + ": not played: " + a1));
  EXPECT_THAT(found->left_out[0].message, HasSubstr("is not named"));
}

TEST_F(JournalFiles, WhatIsNoJournalIsRefused) {
  const std::string path = scratch_ / "poses.csv";
  std::ofstream(path) << "pose,azimuth_deg\n1,0\n";
  const auto found = journals_of({path});
  ASSERT_FALSE(found);
  EXPECT_THAT(found.error().message, HasSubstr("no journal of mgtd"));
}

TEST_F(JournalFiles, WhatCannotBeReadIsNotTakenForAnEmptyJournal) {
  const std::filesystem::path folder = scratch_ / "folder";
  std::filesystem::create_directory(folder);
  const auto found = journals_of({folder.string()});
  ASSERT_FALSE(found);
  EXPECT_EQ(found.error().code, ErrorCode::io);
  EXPECT_THAT(found.error().message, HasSubstr("folder: cannot be read"));
}

}  // namespace
}  // namespace mgtd::daemon::cli
