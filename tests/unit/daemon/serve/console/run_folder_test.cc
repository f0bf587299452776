// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/run_folder.h"

#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "daemon/store/run_file.h"
#include "tests/support/event_loop.h"

namespace mgtd::daemon::serve::console {
namespace {

using mgtd::testing::ScratchDirectory;
using ::testing::UnorderedElementsAre;

constexpr const char* kTable = "pose,s1_x_nT\n1,2\n\n2,3\n";

std::vector<std::string> names(RunFolder& folder) {
  std::vector<std::string> out;
  for (const RunEntry& entry : folder.list()) out.push_back(entry.name);
  return out;
}

TEST(RunFolder, ListsRunFilesAndPoseTables) {
  const ScratchDirectory dir;
  std::ofstream(dir / "a.csv") << kTable;
  std::ofstream(dir / "b.csv") << "name,age\nx,1\n";
  std::ofstream(dir / "notes.txt") << "x";
  std::filesystem::create_directory(dir / "d.csv");
  store::RunHeader header;
  header.run_id = "r";
  header.rig = "rig 7";
  ASSERT_TRUE(store::import_poses({}, dir / "r.mgtrun", header));
  RunFolder folder(dir / "");
  EXPECT_THAT(names(folder), UnorderedElementsAre("a.csv", "b.csv", "r.mgtrun"));
  std::map<std::string, RunEntry> seen;
  for (const RunEntry& entry : folder.list()) seen[entry.name] = entry;
  EXPECT_EQ(seen["a.csv"].poses, 2U);
  EXPECT_FALSE(seen["b.csv"].poses) << "no pose table";
  EXPECT_EQ(seen["r.mgtrun"].rig, "rig 7");
  EXPECT_EQ(seen["r.mgtrun"].poses, 0U);
  EXPECT_EQ(seen["r.mgtrun"].state, "done");
  EXPECT_EQ(nlohmann::json::parse(to_json(folder.list())).at("runs").size(), 3U);
}

TEST(RunFolder, ANameOfTheListIsFoundAndNothingElse) {
  const ScratchDirectory dir;
  std::filesystem::create_directory(dir / "in");
  std::ofstream(dir / "in/a.csv") << kTable;
  std::ofstream(dir / "out.csv") << kTable;
  const RunFolder folder(dir / "in");
  ASSERT_TRUE(folder.find("a.csv"));
  EXPECT_EQ(folder.find("a.csv")->string(), dir / "in/a.csv");
  for (const char* name : {"../out.csv", "", ".", "..", "a", "./a.csv", "a.csv/", "A.csv"})
    EXPECT_FALSE(folder.find(name)) << name;
  EXPECT_FALSE(folder.find(dir / "in/a.csv"));
}

TEST(RunFolder, OfOneFileOnlyThoseOfItsStem) {
  const ScratchDirectory dir;
  for (const char* name : {"a.csv", "a.mgtrun", "b.csv"}) std::ofstream(dir / name) << kTable;
  RunFolder folder(dir / "a.csv");
  EXPECT_THAT(names(folder), UnorderedElementsAre("a.csv", "a.mgtrun"));
}

TEST(RunFolder, AChangedFileIsLookedAtAgain) {
  const ScratchDirectory dir;
  std::ofstream(dir / "a.csv") << kTable;
  RunFolder folder(dir / "");
  EXPECT_EQ(folder.list().front().poses, 2U);
  const std::string before = folder.stamp("a.csv");
  EXPECT_EQ(before, folder.stamp("a.csv"));
  std::ofstream(dir / "a.csv", std::ios::app) << "3,4\n";
  EXPECT_EQ(folder.list().front().poses, 3U);
  EXPECT_NE(before, folder.stamp("a.csv"));
}

/// A folder of thousands is told at once; what stands in the files comes with the next lists.
TEST(RunFolder, OpensAFewNewFilesAtOnce) {
  const ScratchDirectory dir;
  constexpr int kFiles = RunFolder::kNewAtOnce + 3;
  for (int i = 0; i < kFiles; ++i) std::ofstream(dir / (std::to_string(i) + ".csv")) << kTable;
  RunFolder folder(dir / "");
  const auto known = [&] {
    int out = 0;
    for (const RunEntry& entry : folder.list()) out += entry.poses ? 1 : 0;
    return out;
  };
  EXPECT_EQ(known(), RunFolder::kNewAtOnce);
  EXPECT_EQ(known(), kFiles);
}

}  // namespace
}  // namespace mgtd::daemon::serve::console
