// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/run_file.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "daemon/store/database.h"
#include "daemon/store/pose_source.h"
#include "tests/unit/daemon/full_disk.h"
#include "tests/unit/daemon/poses.h"
#include "tests/unit/daemon/temp_dir.h"

namespace mgtd::daemon::store {
namespace {

using test::full_pose;
using test::FullDisk;
using test::same;
using test::TempDir;

RunHeader header() {
  RunHeader h;
  h.run_id = "r20261121T100000";
  h.rig = "Änderung \"x\"";
  h.started_utc = {1'795'255'200'123'456'789};
  h.software = "mgtd 0.1.0";
  h.config = "[rig]\nname = 'x'\n";
  h.plan = R"({"poses":157})";
  h.seed = 0xfedcba9876543210U;
  h.source = "measured";
  h.options.field_nT = 50'000.1;
  h.options.inclination_rad = 1.1;
  h.options.sensor_names[2] = "Mag-03 #1234";
  return h;
}

TEST(RunFile, IsNotReadableByEverybody) {
  TempDir dir;
  const auto file = RunFile::create(dir / "a.mgtrun", header()).value();
  for (const char* suffix : {"", "-wal", "-shm"}) {
    const auto mode =
        std::filesystem::status(std::filesystem::path(dir / "a.mgtrun") += suffix).permissions();
    EXPECT_EQ(mode & std::filesystem::perms::others_all, std::filesystem::perms::none) << suffix;
  }
}

TEST(RunFile, KeepsEverythingBitForBit) {
  TempDir dir;
  {
    auto file = RunFile::create(dir / "a.mgtrun", header()).value();
    for (int i = 5; i > 0; --i) ASSERT_TRUE(file.append_pose(full_pose(i)));
    Pose sparse;
    sparse.number = 9;
    sparse.set = "check";
    EXPECT_FALSE(file.append_pose(sparse));  // nobody has measured it
    sparse.y_nT.fill(Eigen::Vector3d{1, 2, 3});
    ASSERT_TRUE(file.append_pose(sparse));
    const TableReading r{{Instant{Duration{5}}, {6}}, {0.1, 0.2, 0.3}, true, false, true};
    ASSERT_TRUE(file.append_path(std::vector<TableReading>(3, r)));
    ASSERT_TRUE(file.append_event({{Instant{Duration{7}}, {8}}, "s3: frame lost"}));
    ASSERT_TRUE(file.set_checks("preflight", std::vector<Check>{{"old", false, "1", "2", "3"}}));
    ASSERT_TRUE(file.set_checks("preflight", std::vector<Check>{{"noise", true, "1 nT", "2 nT", ""}}));
    ASSERT_TRUE(file.set_document("proposed", "{1}"));
    ASSERT_TRUE(file.set_document("proposed", "{2}"));
    ASSERT_TRUE(file.set_state(RunState::dwelling, "pose 6 of 157"));
  }
  const auto file = RunFile::open(dir / "a.mgtrun", Access::read_only).value();
  const RunHeader h = file.header(), expected = header();
  EXPECT_EQ(h.run_id, expected.run_id);
  EXPECT_EQ(h.rig, expected.rig);
  EXPECT_EQ(h.started_utc, expected.started_utc);
  EXPECT_EQ(h.config, expected.config);
  EXPECT_EQ(h.plan, expected.plan);
  EXPECT_EQ(h.seed, expected.seed);
  EXPECT_EQ(h.options.field_nT, expected.options.field_nT);
  EXPECT_EQ(h.options.inclination_rad, expected.options.inclination_rad);
  EXPECT_FALSE(h.options.declination_rad);
  EXPECT_EQ(h.options.sensor_names, expected.options.sensor_names);
  const auto poses = file.poses().value().poses;
  ASSERT_EQ(poses.size(), 6U);
  for (int i = 5; i > 0; --i) EXPECT_TRUE(same(poses[static_cast<std::size_t>(5 - i)], full_pose(i))) << i;
  EXPECT_FALSE(poses[5].t_s || poses[5].sd_nT[0][0] || poses[5].t_utc || poses[5].mount);
  EXPECT_EQ(file.path_readings().value().size(), 3U);
  EXPECT_EQ(file.path_readings().value()[2].angles, (TableAngles{0.1, 0.2, 0.3}));
  EXPECT_EQ(file.events().value().at(0).what, "s3: frame lost");
  ASSERT_EQ(file.checks("preflight").value().size(), 1U);
  EXPECT_EQ(file.checks("preflight").value()[0].name, "noise");
  EXPECT_EQ(file.document("proposed").value(), "{2}");
  EXPECT_EQ(file.document("other").value(), std::nullopt);
  EXPECT_EQ(file.state().value().state, RunState::dwelling);
}

TEST(RunFile, APoseIsThereAfterSigkill) {
  TempDir dir;
  const auto path = dir / "a.mgtrun";
  int acknowledged[2];
  ASSERT_EQ(pipe(acknowledged), 0);
  const pid_t child = fork();
  if (child == 0) {
    auto file = RunFile::create(path, header());
    for (int i = 1; file && file->append_pose(full_pose(i)); ++i) {
      if (write(acknowledged[1], &i, sizeof i) != sizeof i) break;
    }
    _exit(1);
  }
  int last = 0;
  while (last < 25 && read(acknowledged[0], &last, sizeof last) == sizeof last) {
  }
  ASSERT_EQ(kill(child, SIGKILL), 0);
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  close(acknowledged[1]);
  for (int more = 0; read(acknowledged[0], &more, sizeof more) == sizeof more;) last = more;
  close(acknowledged[0]);
  auto file = RunFile::open(path, Access::resume).value();
  const auto poses = file.poses().value().poses;
  ASSERT_GE(poses.size(), static_cast<std::size_t>(last));
  for (std::size_t i = 0; i < poses.size(); ++i)
    EXPECT_TRUE(same(poses[i], full_pose(static_cast<int>(i) + 1)));
  EXPECT_TRUE(file.append_pose(full_pose(static_cast<int>(poses.size()) + 1)));
}

TEST(RunFile, FullDiskIsAnErrorAndLeavesNothingHalfWritten) {
  TempDir dir;
  auto file = RunFile::create(dir / "a.mgtrun", header()).value();
  ASSERT_TRUE(file.append_pose(full_pose(1)));
  std::vector<Pose> many;
  for (int i = 2; i < 500; ++i) many.push_back(full_pose(i));
  {
    const FullDisk full(100'000);
    const auto refused = file.append_poses(many);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().code, ErrorCode::io) << refused.error().text();
    EXPECT_FALSE(refused.error().remedy.empty());
    const auto none = RunFile::create(dir / "b.mgtrun", [] {
      RunHeader large = header();
      large.config.assign(200'000, 'x');
      return large;
    }());
    EXPECT_FALSE(none);
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}),
            3);  // a.mgtrun with its -wal and -shm
  EXPECT_EQ(file.poses().value().poses.size(), 1U);
  EXPECT_TRUE(file.append_poses(many));
  EXPECT_EQ(file.poses().value().poses.size(), many.size() + 1);
}

TEST(RunFile, IsReadableWhileItIsWritten) {
  TempDir dir;
  auto writer = RunFile::create(dir / "a.mgtrun", header()).value();
  ASSERT_TRUE(writer.append_pose(full_pose(1)));
  const auto reader = RunFile::open(dir / "a.mgtrun", Access::read_only).value();
  EXPECT_EQ(reader.pose_count().value(), 1U);
  ASSERT_TRUE(writer.append_pose(full_pose(2)));
  EXPECT_EQ(reader.pose_count().value(), 2U);
  EXPECT_FALSE(RunFile::open(dir / "a.mgtrun", Access::read_only).value().append_pose(full_pose(3)));
  EXPECT_EQ(read_poses(dir / "a.mgtrun").value().poses.size(), 2U);
}

TEST(RunFile, AFinishedRunIsOneFile) {
  TempDir dir;
  auto file = RunFile::create(dir / "a.mgtrun", header()).value();
  ASSERT_TRUE(file.append_pose(full_pose(1)));
  ASSERT_TRUE(file.set_state(RunState::done, "proposed c012345678901"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}), 1);
  ASSERT_TRUE(file.set_document("model", "[]"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}), 1);
}

/// Reads as a user who may read but not write, in a directory that nobody may write: with a WAL left by a
/// killed daemon and without.
TEST(RunFile, IsReadableWhereNothingMayBeWritten) {
  TempDir dir;
  const auto sealed = dir / "sealed";
  std::filesystem::create_directory(sealed);
  const pid_t writer = fork();
  if (writer == 0) {
    auto plain = RunFile::create(sealed / "plain.mgtrun", header()).value();
    auto killed = RunFile::create(sealed / "killed.mgtrun", header()).value();
    const bool ok = plain.append_pose(full_pose(1)) && killed.append_pose(full_pose(1)) &&
                    killed.append_pose(full_pose(2));
    { const RunFile closed = std::move(plain); }
    raise(ok ? SIGKILL : SIGABRT);
  }
  int status = 0;
  waitpid(writer, &status, 0);
  ASSERT_EQ(WTERMSIG(status), SIGKILL);
  std::filesystem::remove(sealed / "killed.mgtrun-shm");
  using std::filesystem::perms;
  for (const auto& entry : std::filesystem::directory_iterator(sealed)) {
    std::filesystem::permissions(entry, perms::owner_read | perms::others_read);
  }
  std::filesystem::permissions(
      sealed, perms::owner_read | perms::owner_exec | perms::others_read | perms::others_exec);
  std::filesystem::permissions(dir.path(), perms::owner_all | perms::others_exec);
  const pid_t reader = fork();
  if (reader == 0) {
    if (geteuid() == 0 && (setgid(65534) != 0 || setuid(65534) != 0)) _exit(9);
    const auto plain = read_poses(sealed / "plain.mgtrun"), killed = read_poses(sealed / "killed.mgtrun");
    if (!plain) std::fprintf(stderr, "%s\n", plain.error().text().c_str());
    if (!killed) std::fprintf(stderr, "%s\n", killed.error().text().c_str());
    _exit(plain && plain->poses.size() == 1 && killed && killed->poses.size() == 2 ? 0 : 1);
  }
  waitpid(reader, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 0);
  std::filesystem::permissions(sealed, perms::owner_all);
}

TEST(RunFile, RefusesWhatItIsNot) {
  TempDir dir;
  const auto refusal = [](const std::filesystem::path& path) {
    const auto file = RunFile::open(path, Access::read_only);
    return file ? std::string("opened") : file.error().text();
  };
  EXPECT_NE(refusal(dir / "absent.mgtrun").find("there is no file"), std::string::npos);
  std::ofstream(dir / "text.mgtrun") << std::string(5000, 'x');
  EXPECT_NE(refusal(dir / "text.mgtrun").find("is not a run file"), std::string::npos);
  std::ofstream(dir / "empty.mgtrun").close();
  EXPECT_NE(refusal(dir / "empty.mgtrun").find("not a run file"), std::string::npos);
  EXPECT_TRUE(
      Database::open(dir / "other.mgtrun", Database::Mode::create).value()->execute("CREATE TABLE t(x)"));
  EXPECT_NE(refusal(dir / "other.mgtrun").find("not a run file"), std::string::npos);

  { ASSERT_TRUE(RunFile::create(dir / "newer.mgtrun", header())); }
  EXPECT_TRUE(Database::open(dir / "newer.mgtrun", Database::Mode::read_write)
                  .value()
                  ->execute("PRAGMA user_version=7"));
  EXPECT_NE(refusal(dir / "newer.mgtrun").find("schema 7, this program knows up to 2"), std::string::npos);

  {
    auto file = RunFile::create(dir / "damaged.mgtrun", header()).value();
    for (int i = 1; i < 200; ++i) ASSERT_TRUE(file.append_pose(full_pose(i)));
    ASSERT_TRUE(file.set_state(RunState::done, ""));
  }
  std::fstream damaged(dir / "damaged.mgtrun", std::ios::in | std::ios::out | std::ios::binary);
  damaged.seekp(4096 * 12);
  damaged << std::string(4096 * 8, '\x7f');
  damaged.close();
  EXPECT_NE(refusal(dir / "damaged.mgtrun").find("is damaged"), std::string::npos);
  { ASSERT_TRUE(RunFile::create(dir / "renamed.mgtrun", header())); }
  EXPECT_TRUE(Database::open(dir / "renamed.mgtrun", Database::Mode::read_write)
                  .value()
                  ->execute("ALTER TABLE meta RENAME COLUMN value TO other"));
  const auto renamed = RunFile::open(dir / "renamed.mgtrun", Access::read_only);
  ASSERT_FALSE(renamed);
  EXPECT_NE(renamed.error().message.find("is damaged, or another program wrote it"), std::string::npos);
  EXPECT_FALSE(renamed.error().remedy.empty());
  std::filesystem::resize_file(dir / "newer.mgtrun", 600);
  EXPECT_NE(refusal(dir / "newer.mgtrun"), "opened");
}

TEST(RunFile, RefusesAPoseNumberTwiceAndAnExistingFile) {
  TempDir dir;
  auto file = RunFile::create(dir / "a.mgtrun", header()).value();
  ASSERT_TRUE(file.append_pose(full_pose(1)));
  EXPECT_EQ(file.append_pose(full_pose(1)).error().code, ErrorCode::refused);
  Pose unmeasured = full_pose(2);
  unmeasured.y_nT[1].x() = std::nan("");
  EXPECT_FALSE(file.append_pose(unmeasured));
  EXPECT_EQ(file.pose_count().value(), 1U);
  EXPECT_FALSE(RunFile::create(dir / "a.mgtrun", header()));
  EXPECT_EQ(file.pose_count().value(), 1U);
}

TEST(RunFile, ImportIsAllOrNothing) {
  TempDir dir;
  PoseTable table{{full_pose(3), full_pose(1)}, "poses.csv"};
  ASSERT_TRUE(import_poses(table, dir / "a.mgtrun", {}));
  const PoseSource read = read_run(dir / "a.mgtrun").value();
  EXPECT_TRUE(same(read.table.poses[0], full_pose(3)));
  EXPECT_EQ(read.header->source, "poses.csv");
  EXPECT_FALSE(import_poses(table, dir / "a.mgtrun", {}));
  table.poses.push_back(full_pose(1));
  EXPECT_FALSE(import_poses(table, dir / "b.mgtrun", {}));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(dir.path()), {}), 1);
}

/// What the operator called the file, not what it is called until it is whole.
TEST(RunFile, ARefusedImportNamesTheFileThatWasWanted) {
  TempDir dir;
  const auto refused = import_poses({{full_pose(1)}, "poses.csv"}, dir / "none/x.mgtrun", {});
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message,
            "cannot create " + (dir / "none/x.mgtrun").string() + ": No such file or directory");
}

TEST(RunFile, ADirectoryIsNamedAsOne) {
  TempDir dir;
  const auto refused = RunFile::open(dir.path(), Access::read_only);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, dir.path().string() + " is a directory");
}

TEST(RunFile, AnImportKeepsTheWayOfTheTable) {
  TempDir dir;
  const PoseTable table{
      {full_pose(1), full_pose(2)}, "poses.csv", {{0.5, {0.1, 0, 0}}, {0.75, {0.2, 0.3, 0}}}};
  ASSERT_TRUE(import_poses(table, dir / "a.mgtrun", {}));
  const PoseTable read = read_run(dir / "a.mgtrun").value().table;
  ASSERT_EQ(read.path.size(), 2U);
  EXPECT_NEAR(read.path[1].t_s, 0.75, 1e-9);
  EXPECT_EQ(read.path[1].angles, table.path[1].angles);
}

TEST(PoseSource, TellsCsvFromRunFileByContent) {
  TempDir dir;
  std::ofstream(dir / "bad.csv") << "pose,set\n1,standard\n";
  const auto refused = read_poses(dir / "bad.csv");
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("bad.csv"), std::string::npos);
  EXPECT_FALSE(read_poses(dir / "absent.csv"));
  EXPECT_FALSE(read_poses(dir.path()));
  ASSERT_TRUE(import_poses({{full_pose(1)}, "x"}, dir / "odd-name.csv", {}));
  EXPECT_EQ(read_poses(dir / "odd-name.csv").value().poses.size(), 1U);
}

}  // namespace
}  // namespace mgtd::daemon::store
