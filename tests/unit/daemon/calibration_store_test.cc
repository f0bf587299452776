// SPDX-License-Identifier: Apache-2.0
#include "daemon/calibration_store.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "tests/unit/daemon/full_disk.h"
#include "tests/unit/daemon/temp_dir.h"

namespace mgtd::daemon {
namespace {

using test::FullDisk;
using test::TempDir;

calib::Calibration calibration(int variant, bool good = true) {
  calib::Calibration c;
  c.method = "two-step";
  c.sensors[1].offset_nT.x() = 10.0 + variant / 3.0;
  c.poses = 157;
  c.accepted_by_checks = good;
  c.verdict = {{"total field", good, "1.2 nT", "1.0 nT", ""}};
  c.software = "mgtd test";
  c.seal();
  return c;
}

WallTime t(int s) { return {1'795'255'200'000'000'000 + s * 1'000'000'000LL}; }

TEST(CalibrationStore, ProposeAcceptRollBackAndRemember) {
  TempDir dir;
  const auto a = calibration(1), b = calibration(2), c = calibration(3);
  {
    auto store = CalibrationStore::open(dir / "cal").value();
    EXPECT_FALSE(store.active_id());
    EXPECT_EQ(store.active().value(), std::nullopt);
    ASSERT_TRUE(store.propose(a, "run 1", t(1)));
    ASSERT_TRUE(store.propose(a, "run 1", t(2)));  // known: nothing changes
    EXPECT_FALSE(store.active_id());
    ASSERT_TRUE(store.accept(a.id, t(3)));
    ASSERT_TRUE(store.propose(b, "run 2", t(4)));
    EXPECT_EQ(store.active_id(), a.id);
    ASSERT_TRUE(store.accept(b.id, t(5)));
    ASSERT_TRUE(store.propose(c, "run 3", t(6)));
  }
  auto store = CalibrationStore::open(dir / "cal").value();
  EXPECT_EQ(store.active_id(), b.id);
  EXPECT_EQ(store.active().value()->sensors[1].offset_nT, b.sensors[1].offset_nT);
  const auto list = store.list();
  ASSERT_EQ(list.size(), 3U);
  EXPECT_EQ(list[0].state, CalibrationState::accepted);
  EXPECT_EQ(list[1].state, CalibrationState::active);
  EXPECT_EQ(list[1].since, t(5));
  EXPECT_EQ(list[1].origin, "run 2");
  EXPECT_EQ(list[2].state, CalibrationState::proposed);
  EXPECT_EQ(store.rollback(t(7)).value(), a.id);
  EXPECT_EQ(store.rollback(t(8)).error().code, ErrorCode::state);
  EXPECT_EQ(CalibrationStore::open(dir / "cal").value().active_id(), a.id);
  ASSERT_TRUE(store.accept(c.id, t(9)));
  EXPECT_EQ(store.rollback(t(10)).value(), a.id);
}

TEST(CalibrationStore, RefusesWhatIsNotProposedOrFailed) {
  TempDir dir;
  auto store = CalibrationStore::open(dir / "cal").value();
  EXPECT_EQ(store.accept("c000000000000", t(1)).error().code, ErrorCode::refused);
  EXPECT_FALSE(store.accept("../../etc/passwd", t(1)));
  const auto bad = calibration(1, false);
  ASSERT_TRUE(store.propose(bad, "run", t(1)));
  const auto refused = store.accept(bad.id, t(2));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("1.2 nT"), std::string::npos);
  auto unsealed = calibration(2);
  unsealed.poses = 3;
  EXPECT_FALSE(store.propose(unsealed, "run", t(1)));
  EXPECT_FALSE(store.show("c000000000000"));
  EXPECT_FALSE(store.active_id());
}

TEST(CalibrationStore, ImportChecksTheFile) {
  TempDir dir;
  auto store = CalibrationStore::open(dir / "cal").value();
  const auto a = calibration(1);
  std::string text = calib::to_json_text(a);
  std::ofstream(dir / "good.json") << text;
  EXPECT_EQ(store.import(dir / "good.json", t(1)).value(), a.id);
  text.replace(text.find("157"), 3, "158");
  std::ofstream(dir / "edited.json") << text;
  const auto refused = store.import(dir / "edited.json", t(2));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("edited.json"), std::string::npos);
  EXPECT_FALSE(store.import(dir / "absent.json", t(2)));
  EXPECT_EQ(store.list().size(), 1U);
}

TEST(CalibrationStore, DamageIsNamedNotUsed) {
  TempDir dir;
  const auto a = calibration(1), b = calibration(2);
  {
    auto store = CalibrationStore::open(dir / "cal").value();
    ASSERT_TRUE(store.propose(a, "run", t(1)) && store.accept(a.id, t(2)) && store.propose(b, "run", t(3)));
  }
  const auto log = dir / "cal" / "calibrations.log";
  std::ofstream(log, std::ios::app) << R"({"t":"2026-11-21T10:00:05.000000Z","event":"accepted","id":")"
                                    << b.id;  // torn
  auto store = CalibrationStore::open(dir / "cal").value();
  EXPECT_EQ(store.active_id(), a.id);
  ASSERT_TRUE(store.accept(b.id, t(4)));
  EXPECT_EQ(CalibrationStore::open(dir / "cal").value().active_id(), b.id);
  std::ofstream(dir / "cal" / (b.id + ".json")) << "{}";
  EXPECT_NE(store.active().error().message.find("damaged"), std::string::npos);
  EXPECT_TRUE(store.rollback(t(5)));
  std::ofstream(log, std::ios::app) << "nonsense\n";
  EXPECT_NE(CalibrationStore::open(dir / "cal").error().message.find("calibrations.log:6"),
            std::string::npos);
}

TEST(CalibrationStore, FullDiskChangesNothing) {
  TempDir dir;
  auto store = CalibrationStore::open(dir / "cal").value();
  const auto a = calibration(1), b = calibration(2);
  ASSERT_TRUE(store.propose(a, "run", t(1)) && store.accept(a.id, t(2)) && store.propose(b, "run", t(3)));
  {
    const FullDisk full(100);
    EXPECT_FALSE(store.accept(b.id, t(4)));
    EXPECT_FALSE(store.propose(calibration(3), "run", t(4)));
  }
  EXPECT_EQ(store.active_id(), a.id);
  EXPECT_EQ(CalibrationStore::open(dir / "cal").value().active_id(), a.id);
  EXPECT_TRUE(store.accept(b.id, t(5)));
}

/// Killed at any moment, the store opens and names a calibration that is whole.
TEST(CalibrationStore, SurvivesSigkillAtAnyMoment) {
  TempDir dir;
  for (int round = 0; round < 8; ++round) {
    int tick[2];
    ASSERT_EQ(pipe(tick), 0);
    const pid_t child = fork();
    if (child == 0) {
      auto store = CalibrationStore::open(dir / "cal");
      for (int i = 0; store; ++i) {
        const auto c = calibration(1000 * round + i);
        if (!store->propose(c, "run", t(i)) || write(tick[1], "p", 1) != 1 || !store->accept(c.id, t(i)) ||
            write(tick[1], "a", 1) != 1) {
          break;
        }
      }
      _exit(1);
    }
    char which = 0;
    for (int i = 0; i < 3 + round; ++i) ASSERT_EQ(read(tick[0], &which, 1), 1);
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    close(tick[0]);
    close(tick[1]);
    const auto store = CalibrationStore::open(dir / "cal");
    ASSERT_TRUE(store) << store.error().text();
    EXPECT_TRUE(store->active().value());
    for (const auto& entry : store->list()) EXPECT_TRUE(store->show(entry.id));
  }
}

}  // namespace
}  // namespace mgtd::daemon
