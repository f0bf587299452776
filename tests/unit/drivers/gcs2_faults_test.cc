// SPDX-License-Identifier: Apache-2.0
#include <deque>
#include <functional>
#include <random>

#include "tests/unit/drivers/gcs2_bench.h"

namespace mgtd::drivers::gcs2 {
namespace {

TEST_F(Gcs2DriverTest, ARefusedMoveIsAFaultInWords) {
  home();
  controller.axes["1"].max = 50;  // the controller's own idea has changed
  move(60);
  ASSERT_TRUE(until([&] { return !faults().empty(); }));
  EXPECT_THAT(faults()[0].what, HasSubstr("'MOV 1 60.000000': a target lies outside the travel"));
  EXPECT_THAT(faults()[0].what, HasSubstr("GCS error 7"));
  EXPECT_EQ(controller.commands.back(), "stop");
}

/// Its power failed for so short a time that nobody noticed.
TEST_F(Gcs2DriverTest, AControllerThatForgotItsReferenceIsAskedAgainWhatItKnows) {
  home();
  controller.axes["1"].referenced = false;
  controller.commands.clear();
  move(60);
  ASSERT_TRUE(until([&] { return !faults().empty(); }));
  EXPECT_THAT(faults()[0].what, HasSubstr("GCS error 5"));
  ASSERT_TRUE(until([&] { return !last().referenced; }));
  EXPECT_THAT(controller.commands, ::testing::Contains(HasSubstr("VEL 1 "))) << "forgotten too";
  driver.home();
  ASSERT_TRUE(until([&] { return last().referenced && !last().moving; }));
  EXPECT_EQ(faults().size(), 1U);
}

TEST_F(Gcs2DriverTest, AStalledTableIsStoppedAfterItsDeadline) {
  home();
  controller.stalls = true;
  move(50);
  const double start = bench.t_s();
  ASSERT_TRUE(until([&] { return !faults().empty(); }));
  EXPECT_NEAR(bench.t_s() - start, 50 / 10.0 * 2 + 10, 0.2);
  EXPECT_THAT(faults()[0].what, HasSubstr("azimuth at 0.000 deg for 50.000"));
  ASSERT_TRUE(until([&] { return controller.commands.back() == "SVO 1 0"; }));
  EXPECT_THAT(controller.commands, ::testing::Contains("stop"));
}

TEST_F(Gcs2DriverTest, TheDeadlineOfAMoveBeginsWhenTheTableHasBeenTold) {
  home();
  controller.stalls = true;
  controller.mute = "ERR?";
  controller.mute_times = 2;  // asked again after two seconds each
  move(50);
  const double start = bench.t_s();
  ASSERT_TRUE(until([&] { return !faults().empty(); }));
  EXPECT_GT(bench.t_s() - start, 50 / 10.0 * 2 + 10 + 4);
}

TEST_F(Gcs2DriverTest, ATableThatIsPushedInItsDwellIsAFault) {
  home();
  move(50);
  ASSERT_TRUE(until([&] { return last().on_target; }));
  auto& axis = controller.axes["1"];
  axis.position = axis.target = 50.4;
  bench.pass(3);
  EXPECT_TRUE(faults().empty());
  EXPECT_NEAR(to_deg(last().angles.azimuth_rad), 50.4, 1e-9) << "what is measured is told";
  axis.position = axis.target = 52;
  ASSERT_TRUE(until([&] { return !faults().empty(); }));
  EXPECT_THAT(faults()[0].what,
              HasSubstr("azimuth turned to 52.000 deg while the table should stand at 50.000"));
  EXPECT_FALSE(last().on_target);
  bench.pass(5);
  EXPECT_EQ(faults().size(), 1U) << "said once";
}

/// Each answer takes a tick, so that a move can be asked for while a poll is under way.
TEST_F(Gcs2DriverTest, AnOldPollDoesNotAnswerForANewMove) {
  controller.axes["1"].referenced = true;
  std::string under_way;
  DeviceBench slow(driver, [&](std::string_view sent) {
    under_way += controller(sent);
    return std::string();
  });
  const auto step = [&] {
    slow.feed(std::exchange(under_way, {}));
    slow.tick();
    controller.advance(slow.t_s());
  };
  const auto arrived = [&] {
    const auto readings = slow.events<TableReading>();
    return !readings.empty() && readings.back().on_target;
  };
  slow.open();
  for (int i = 0; i < 100; ++i) step();
  ASSERT_EQ(driver.health().state, LinkState::live);
  for (int phase = 1; phase < 90; ++phase) {  // 10 deg take 50 ticks
    driver.move_to({to_rad(20.0), 0, 0});
    slow.exchange();
    for (int i = 0; i < 2000 && !arrived(); ++i) step();
    driver.move_to({to_rad(30.0), 0, 0});
    slow.exchange();
    for (int i = 0; i < phase; ++i) step();  // under way, or just there
    driver.move_to({to_rad(-10.0), 0, 0});
    slow.exchange();
    slow.forget_events();
    for (int i = 0; i < 2000 && !arrived(); ++i) step();
    ASSERT_TRUE(arrived()) << "after " << phase << " ticks";
    EXPECT_NEAR(controller.axes["1"].position, -10, 1e-9) << "after " << phase << " ticks";
  }
}

TEST_F(Gcs2DriverTest, AFailedReferenceIsAFault) {
  controller.reference_fails = true;
  open();
  driver.home();
  ASSERT_TRUE(until([&] { return !faults().empty(); }));
  EXPECT_THAT(faults()[0].what, HasSubstr("azimuth: the reference move failed"));
}

TEST_F(Gcs2DriverTest, AReferenceThatNeverEndsIsStopped) {
  open();
  driver.home();
  bench.exchange();
  controller.referencing_until = 1e9;
  ASSERT_TRUE(until([&] { return !faults().empty(); }, 200));
  EXPECT_THAT(faults()[0].what, HasSubstr("the reference move of azimuth did not end in time"));
}

TEST_F(Gcs2DriverTest, ALostReplyIsAskedForAgainAndALateOneIsNotMistaken) {
  home();
  move(45);
  controller.mute = "POS?";
  controller.mute_times = 1;
  ASSERT_TRUE(until([&] { return controller.mute_times == 0; }));
  bench.pass(2.6);           // the reply is overdue: the line is being proved
  bench.feed("1=12.345\n");  // ... and here it comes, late
  ASSERT_TRUE(until([&] { return last().on_target; }));
  for (const auto& reading : bench.events<TableReading>())
    EXPECT_NE(to_deg(reading.angles.azimuth_rad), 12.345);
  EXPECT_NEAR(to_deg(last().angles.azimuth_rad), 45, 1e-9);
  EXPECT_TRUE(faults().empty());
  EXPECT_TRUE(driver.health().balanced());
}

/// Answers 0.4 to 2 s late, stopped at every moment of a move: what comes late is not taken for the answer to
/// what is asked after the stop ("'SVO 1 0': ... (GCS error 10)").
TEST_F(Gcs2DriverTest, AStopWhileAnswersAreLateIsNoFault) {
  controller.axes["1"].referenced = true;
  std::deque<std::pair<double, std::string>> wire;
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> late_s(0.4, 2);
  double t_s = 1000, free_s = 0;  // where the bench begins
  Gcs2Driver device(settings());
  DeviceBench slow(device, [&](std::string_view sent) {
    const std::string reply = controller(sent);
    free_s = std::max(free_s, t_s + late_s(random));
    if (!reply.empty()) wire.emplace_back(free_s, reply);
    return std::string();
  });
  const auto step = [&](double seconds, const std::function<bool()>& done) {
    for (double end_s = t_s + seconds; t_s < end_s && !done();) {
      t_s = slow.t_s();
      controller.advance(t_s);
      for (; !wire.empty() && wire.front().first <= t_s; wire.pop_front()) slow.feed(wire.front().second);
      slow.tick();
    }
    return done();
  };
  const auto rests = [&] {
    const auto readings = slow.events<TableReading>();
    return !readings.empty() && !readings.back().moving;
  };
  slow.open();
  ASSERT_TRUE(step(100, [&] { return device.health().state == LinkState::live; }));
  for (int i = 0; i < 60; ++i) {
    device.move_to({to_rad(i % 2 == 0 ? 40.0 : -40.0), 0, 0});
    slow.exchange();
    step(0.17 * i, [] { return false; });
    device.stop();
    slow.exchange();
    slow.forget_events();
    ASSERT_TRUE(step(100, rests)) << i;
    ASSERT_TRUE(slow.events<DeviceFault>().empty()) << i << ": " << slow.events<DeviceFault>()[0].what;
    ASSERT_EQ(device.health().state, LinkState::live);
  }
}

TEST_F(Gcs2DriverTest, ACommandWhoseErrorWasNotHeardIsSentAgain) {
  home();
  controller.mute = "ERR?";
  controller.mute_times = 1;
  controller.axes["1"].max = 50;
  move(60);
  ASSERT_TRUE(until([&] { return !faults().empty(); }));
  EXPECT_THAT(faults()[0].what, HasSubstr("GCS error 7"));
}

TEST_F(Gcs2DriverTest, WhatTalksAndIsNoControllerIsTheWrongDevice) {
  DeviceBench stage(driver);
  stage.open();
  double next_s = 0;
  ASSERT_TRUE(stage.pass_until([&] {
    if (stage.t_s() > next_s) {
      next_s = stage.t_s() + 1;
      stage.feed("$GPGGA,100000.00,4717.11,N\r\n");
    }
    return driver.health().state == LinkState::failed;
  }));
  EXPECT_THAT(driver.health().detail,
              HasSubstr("wrong device on the port? It says '$GPGGA,100000.00,4717.11,N'"));
  EXPECT_TRUE(stage.events<DeviceFault>().empty());
}

TEST_F(Gcs2DriverTest, AControllerThatStopsAnsweringIsAFaultWhileMoving) {
  home();
  move(45);
  controller.mute = "";
  controller.mute_times = 1'000'000;
  ASSERT_TRUE(until([&] { return driver.health().state == LinkState::silent; }));
  ASSERT_EQ(faults().size(), 1U);
  EXPECT_THAT(faults()[0].what, HasSubstr("does not answer"));
  EXPECT_THAT(faults()[0].what, HasSubstr("cannot be reached and may still move"));
  EXPECT_TRUE(bench.sent().ends_with("\x18")) << "it may still listen";
  controller.mute_times = 0;
  ASSERT_TRUE(until([&] { return driver.health().state == LinkState::live; }));
}

TEST_F(Gcs2DriverTest, GarbageIsCountedAndTheQuestionAskedAgain) {
  home();
  move(45);
  bench.feed("garbage\n");
  ASSERT_TRUE(until([&] { return last().on_target; }));
  EXPECT_TRUE(driver.health().balanced());
}

TEST_F(Gcs2DriverTest, LosingThePortWhileMovingIsAFault) {
  home();
  move(90);
  bench.close();
  ASSERT_EQ(faults().size(), 1U);
  EXPECT_THAT(faults()[0].what, HasSubstr("cannot be reached and may still move"));
  bench.forget_sent();
  open();
  EXPECT_TRUE(bench.sent().starts_with("\x18"));
  bench.pass(2);
  EXPECT_FALSE(last().moving) << "the old target is forgotten";
}

TEST_F(Gcs2DriverTest, AMissingAxisFailsWithWhatIsThere) {
  controller.axes = {{"A", {}}, {"B", {}}};
  bench.open();
  ASSERT_TRUE(until([&] { return driver.health().state == LinkState::failed; }));
  EXPECT_THAT(driver.health().detail, HasSubstr("has no axis '1'; it answers 'A', 'B'"));
}

TEST_F(Gcs2DriverTest, AnotherControllerThanTheStatedOneIsRefused) {
  for (const LinkState state : {LinkState::live, LinkState::failed}) {
    const std::string stated = state == LinkState::live ? "1" : "2";
    Gcs2Settings wanted = settings();
    wanted.serial = stated;
    Gcs2Driver device(wanted);
    DeviceBench stage(device, std::ref(controller));
    stage.open();
    ASSERT_TRUE(stage.pass_until([&] { return device.health().state == state; })) << stated;
    if (state == LinkState::failed) {
      EXPECT_THAT(device.health().detail, HasSubstr("its serial number is 1, not 2"));
    }
  }
}

TEST_F(Gcs2DriverTest, ADeadPortIsSilent) {
  DeviceBench stage(driver);
  stage.open();
  ASSERT_TRUE(stage.pass_until([&] { return driver.health().state == LinkState::silent; }));
  EXPECT_TRUE(stage.events<DeviceFault>().empty());
  EXPECT_TRUE(stage.pass_until([&] { return driver.wants_reopen(); }));
}

}  // namespace
}  // namespace mgtd::drivers::gcs2
