// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/control_lease.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace mgtd::daemon::serve {
namespace {

using ::testing::HasSubstr;

const ControlPeer kAnna{.connection = 1, .pid = 4242, .uid = 1000};
const ControlPeer kBert{.connection = 2, .pid = 5353, .uid = 1001};

Stamp at(double s) {
  return {Instant{} + from_seconds(100 + s), WallTime{1'795'255'200'000'000'000 + from_seconds(s).count()}};
}

TEST(ControlLease, TheSecondOneWhoChangesSomethingIsToldWhoHasControlSinceWhenAndWhatToDo) {
  ControlLease lease;
  ASSERT_TRUE(lease.admit(kAnna, ControlCommand::run_start, at(0)));
  const auto refused = lease.admit(kBert, ControlCommand::calibrations_accept, at(3));
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::state);
  EXPECT_THAT(refused.error().message, HasSubstr("pid 4242 (uid 1000) since " + format_utc(at(0).wall)));
  EXPECT_THAT(refused.error().remedy, HasSubstr("another 7 s"));
  EXPECT_THAT(refused.error().remedy, HasSubstr("mgt control break"));
  EXPECT_TRUE(lease.admit(kAnna, ControlCommand::calibrations_accept, at(3))) << "the holder goes on";
}

TEST(ControlLease, LookingAndStoppingAreForEveryone) {
  ControlLease lease;
  ASSERT_TRUE(lease.take(kAnna, {}, at(0)));
  for (const ControlCommand command :
       {ControlCommand::version, ControlCommand::status, ControlCommand::run_status,
        ControlCommand::run_course, ControlCommand::run_events, ControlCommand::run_dry_run,
        ControlCommand::calibrations_list, ControlCommand::calibrations_show, ControlCommand::run_pause,
        ControlCommand::run_abort}) {
    EXPECT_TRUE(lease.admit(kBert, command, at(1))) << name(command);
  }
  EXPECT_EQ(lease.holder(at(1).mono)->pid, kAnna.pid);
}

TEST(ControlLease, WhoeverOnlyLooksTakesNothing) {
  ControlLease lease;
  ASSERT_TRUE(lease.admit(kAnna, ControlCommand::run_status, at(0)));
  EXPECT_FALSE(lease.holder(at(0).mono));
}

TEST(ControlLease, CommandsThatConnectAskAndGoNeverStandInEachOthersWay) {
  ControlLease lease;
  ASSERT_TRUE(lease.admit(kAnna, ControlCommand::run_start, at(0)));
  lease.ended(kAnna.connection);
  EXPECT_TRUE(lease.admit(kBert, ControlCommand::run_resume, at(0)));
}

TEST(ControlLease, AConnectionThatOnlyLooksOnLosesControlAfterItsLastChange) {
  ControlLease lease;
  ASSERT_TRUE(lease.admit(kAnna, ControlCommand::run_enter, at(0)));
  for (double t = 0; t < ControlLease::kKept_s; t += 0.2)
    ASSERT_TRUE(lease.admit(kAnna, ControlCommand::run_status, at(t)));
  EXPECT_FALSE(lease.admit(kBert, ControlCommand::run_enter, at(ControlLease::kKept_s - 0.1)));
  EXPECT_TRUE(lease.admit(kBert, ControlCommand::run_enter, at(ControlLease::kKept_s)));
  EXPECT_EQ(lease.holder(at(ControlLease::kKept_s).mono)->pid, kBert.pid);
}

TEST(ControlLease, TakenControlLastsAsLongAsItsHolderSpeaks) {
  ControlLease lease;
  ASSERT_TRUE(lease.take(kAnna, {.why = "at the table", .idle_s = 60}, at(0)));
  ASSERT_TRUE(lease.admit(kAnna, ControlCommand::status, at(59)));
  const auto refused = lease.admit(kBert, ControlCommand::run_start, at(118));
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("at the table"));
  EXPECT_TRUE(lease.admit(kBert, ControlCommand::run_start, at(119)));
}

TEST(ControlLease, OnlyItsOwnerGivesControlBack) {
  ControlLease lease;
  ASSERT_TRUE(lease.take(kAnna, {}, at(0)));
  EXPECT_FALSE(lease.release(kBert, at(1).mono));
  EXPECT_FALSE(lease.take(kBert, {}, at(1)));
  lease.ended(kBert.connection);
  EXPECT_TRUE(lease.holder(at(1).mono));
  EXPECT_TRUE(lease.release(kAnna, at(2).mono));
  EXPECT_FALSE(lease.holder(at(2).mono));
  EXPECT_TRUE(lease.take(kBert, {}, at(2)));
}

TEST(ControlLease, BreakingFreesAndSaysWhoseItWas) {
  ControlLease lease;
  ASSERT_TRUE(lease.take(kAnna, {}, at(0)));
  const auto was = lease.break_hold(at(5).mono);
  ASSERT_TRUE(was);
  EXPECT_EQ(was->pid, kAnna.pid);
  EXPECT_FALSE(lease.break_hold(at(5).mono));
  EXPECT_TRUE(lease.admit(kBert, ControlCommand::run_start, at(5)));
  EXPECT_FALSE(lease.admit(kAnna, ControlCommand::run_resume, at(6))) << "and it stays taken away";
}

}  // namespace
}  // namespace mgtd::daemon::serve
