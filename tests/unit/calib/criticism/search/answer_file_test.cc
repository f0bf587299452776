// SPDX-License-Identifier: Apache-2.0
#include "tests/blind/answer_file.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "tests/blind/real_answer.h"

namespace mgtd::calib::testing {
namespace {

using ::testing::HasSubstr;
using File = AnswerFile<RealAnswer>;

class AnswerFiles : public ::testing::Test {
 protected:
  void TearDown() override { std::filesystem::remove(path_); }
  const std::string path_ = ::testing::TempDir() + "mgtd-answers.jsonl";
};

RealAnswer some_answer() {
  RealAnswer a;
  a.accepted = true;
  a.finding = criticism::search::Finding::ambiguous;
  a.named = {"site.dipole"};
  a.declared = {"site.dipole", "site.gradient"};
  a.error_nT_per_m = 0.1;  // has no finite binary expansion
  a.nees_scales = 35.25;
  return a;
}

TEST_F(AnswerFiles, GoOnWhereTheyWereCut) {
  { File(path_).add("walk-1", 101, some_answer()); }
  std::ofstream(path_, std::ios::app) << R"({"kind":"walk-1","se)";
  { File(path_).add("walk-1", 102, some_answer()); }
  const File file(path_);
  EXPECT_EQ(file.find("walk-1", 103), nullptr);
  EXPECT_EQ(file.find("walk", 101), nullptr);
  ASSERT_NE(file.find("walk-1", 102), nullptr);
  const RealAnswer* found = file.find("walk-1", 101);
  ASSERT_NE(found, nullptr);
  EXPECT_TRUE(found->accepted);
  EXPECT_EQ(found->finding, criticism::search::Finding::ambiguous);
  EXPECT_EQ(found->declared, some_answer().declared);
  EXPECT_EQ(found->error_nT_per_m, 0.1);
  EXPECT_EQ(found->nees_scales, 35.25);
  EXPECT_EQ(found->nees_offsets, std::nullopt);
}

TEST_F(AnswerFiles, SayWhichLineIsNoAnswer) {
  { File(path_).add("walk-1", 101, some_answer()); }
  std::ofstream(path_, std::ios::app) << "{\"kind\":3}\n";
  try {
    const File file(path_);
    FAIL() << "a line that is no answer was read";
  } catch (const std::runtime_error& e) {
    EXPECT_THAT(e.what(), HasSubstr("mgtd-answers.jsonl:2: "));
  }
}

TEST_F(AnswerFiles, KeepNothingWithoutAPath) {
  File file("");
  file.add("walk-1", 101, some_answer());
  EXPECT_NE(file.find("walk-1", 101), nullptr);
}

}  // namespace
}  // namespace mgtd::calib::testing
