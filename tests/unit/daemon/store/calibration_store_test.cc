// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/calibration_store.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

#include "tests/unit/daemon/full_disk.h"
#include "tests/unit/daemon/temp_dir.h"

namespace mgtd::daemon::store {
namespace {

using test::FullDisk;
using test::TempDir;

calib::calibration::Calibration calibration(int variant, bool good = true) {
  calib::calibration::Calibration c;
  c.method = "two-step";
  c.sensors[1].offset_nT.x() = 10.0 + variant / 3.0;
  c.poses = 157;
  c.accepted_by_checks = good;
  c.checks = {{"total field", good, "1.2 nT", "1.0 nT", ""}};
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

/// Who decided is in the log, and read again from it; lines of before name nobody.
TEST(CalibrationStore, KeepsWhoDecided) {
  TempDir dir;
  const auto a = calibration(1), b = calibration(2);
  {
    auto store = CalibrationStore::open(dir / "cal").value();
    ASSERT_TRUE(store.propose(a, "run 1", t(1)));
    ASSERT_TRUE(store.accept(a.id, t(2), false, "", "anna"));
    ASSERT_TRUE(store.import(b, "b.json", false, t(3), "bert"));
    ASSERT_TRUE(store.accept(b.id, t(4), false, "quieter", "the console, from 127.0.0.1"));
    ASSERT_TRUE(store.rollback(t(5), "anna"));
  }
  std::ofstream(dir / "cal" / "calibrations.log", std::ios::app)
      << R"({"t":"2026-11-21T10:00:06Z","event":"accepted","id":")" << b.id << R"(","origin":""})" << '\n';
  const auto store = CalibrationStore::open(dir / "cal").value();
  const auto& decisions = store.decisions();
  ASSERT_EQ(decisions.size(), 6U);
  const std::vector<std::pair<std::string, std::string>> expected{
      {"proposed", std::string(kAutomatic)},       {"accepted", "anna"},    {"proposed", "bert"},
      {"accepted", "the console, from 127.0.0.1"}, {"rolled-back", "anna"}, {"accepted", ""}};
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_EQ(decisions[i].what, expected[i].first) << i;
    EXPECT_EQ(decisions[i].by, expected[i].second) << i;
  }
  EXPECT_EQ(decisions[2].origin, "b.json");
  EXPECT_EQ(decisions[3].why, "quieter");
  EXPECT_EQ(decisions[4].id, a.id);
  EXPECT_EQ(store.list()[0].by, "anna");
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

TEST(CalibrationStore, ARejectedProposalKeepsItsReasonAndIsAcceptedByForceAlone) {
  TempDir dir;
  const auto a = calibration(1), b = calibration(2);
  {
    auto store = CalibrationStore::open(dir / "cal").value();
    ASSERT_TRUE(store.propose(a, "run 1", t(1)));
    ASSERT_TRUE(store.propose(b, "run 2", t(2)));
    EXPECT_EQ(store.reject("c000000000000", "?", t(3)).error().code, ErrorCode::refused);
    ASSERT_TRUE(store.reject(b.id, "a car stood beside the \"rig\"", t(3)));
    ASSERT_TRUE(store.accept(a.id, t(4)));
    EXPECT_EQ(store.reject(a.id, "in use", t(5)).error().code, ErrorCode::state);
  }
  auto store = CalibrationStore::open(dir / "cal").value();
  EXPECT_EQ(store.list().at(1).state, CalibrationState::rejected);
  EXPECT_EQ(store.list().at(1).since, t(3));
  EXPECT_EQ(store.list().at(1).why, "a car stood beside the \"rig\"");
  EXPECT_EQ(store.active_id(), a.id);
  EXPECT_TRUE(store.show(b.id)) << "its file stays";
  const auto refused = store.accept(b.id, t(6));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::refused);
  EXPECT_NE(refused.error().message.find("a car stood"), std::string::npos) << refused.error().message;
  ASSERT_TRUE(store.accept(b.id, t(7), true, "it was parked already in run 1"));
  EXPECT_EQ(store.active_id(), b.id);
  EXPECT_EQ(store.list().at(1).why, "it was parked already in run 1");
  EXPECT_FALSE(store.list().at(1).forced) << "it passed its checks";
  EXPECT_EQ(store.reject(a.id, "was in use", t(8)).error().code, ErrorCode::state);
}

TEST(CalibrationStore, ImportRefusesWhatCannotBeUsed) {
  TempDir dir;
  auto store = CalibrationStore::open(dir / "cal").value();
  const auto refused = [&](auto&& spoil, const std::string& why) {
    calib::calibration::Calibration c = calibration(1);
    spoil(c);
    c.seal();
    const auto done = store.import(c, "cal.json", true, t(1));
    ASSERT_FALSE(done) << why;
    EXPECT_NE(done.error().message.find(why), std::string::npos) << done.error().text();
  };
  refused([](auto& c) { c.method = "guess"; }, "no method 'guess'");
  refused([](auto& c) { c.sensors[2].scale.y() = 0; }, "s3 has a scale of 0");
  refused([](auto& c) { c.sensors[0].phi_rad = 1.5; }, "s1 has a non-orthogonality");
  refused([](auto& c) { c.sensors[3].mounting(0, 1) = 1; }, "mounting of s4");
  refused([](auto& c) { c.geometry = calib::sensor::Geometry(0); }, "baseline of 0 m");
  refused([](auto& c) { c.sample_noise_nT(0, 0) = -1; }, "noise is below zero");
  refused([](auto& c) { c.covariance(3, 4) = c.covariance(4, 3) = 1e-3; }, "covariance is none");
  refused([](auto& c) { c.effects = {{"axis.offset.temperature@s3.z", {}, {}}}; }, "has 0 coefficients");
  refused(
      [](auto& c) {
        c.effects = {{"axis.offset.temperature@s3.z", {{"s3.z", 1, 1, "nT/degC"}}, {}}};
      },
      "1 coefficients of effects, and a covariance of 0");
  refused([](auto& c) { c.reference.t_utc = "yesterday"; }, "is no time");
  EXPECT_TRUE(store.list().empty());
  const auto good = calibration(1);
  ASSERT_TRUE(store.import(good, "cal.json", false, t(2)));
  EXPECT_EQ(store.list().at(0).origin, "cal.json");
  EXPECT_FALSE(store.active_id());
}

TEST(CalibrationStore, WhatFailedItsChecksIsForcedAndStaysMarked) {
  TempDir dir;
  auto store = CalibrationStore::open(dir / "cal").value();
  const auto good = calibration(1), bad = calibration(2, false);
  const auto refused = store.import(bad, "cal.json", false, t(1));
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("total field 1.2 nT (limit 1.0 nT)"), std::string::npos);
  EXPECT_TRUE(store.list().empty());
  ASSERT_TRUE(store.import(bad, "cal.json", true, t(1)));
  EXPECT_FALSE(store.accept(bad.id, t(2)));
  ASSERT_TRUE(store.accept(bad.id, t(3), true));
  EXPECT_TRUE(store.list().at(0).forced);
  ASSERT_TRUE(store.import(good, "good.json", true, t(4)) && store.accept(good.id, t(5), true));
  EXPECT_EQ(store.rollback(t(6)).value(), bad.id);
  const auto list = CalibrationStore::open(dir / "cal").value().list();
  EXPECT_TRUE(list.at(0).forced);
  EXPECT_FALSE(list.at(1).forced);
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
}  // namespace mgtd::daemon::store
