// SPDX-License-Identifier: Apache-2.0
#include "drivers/gcs2_driver.h"

#include "drivers/registry.h"
#include "tests/unit/drivers/gcs2_bench.h"

namespace mgtd::drivers::gcs2 {
namespace {

TEST_F(Gcs2DriverTest, OpensWithAStopAndReadsTheTravel) {
  bench.open();
  EXPECT_EQ(bench.sent(), "\x18") << "a table left moving stops first";
  open();
  EXPECT_THAT(driver.health().identity, HasSubstr("C-867"));
  EXPECT_NEAR(to_deg(driver.limits().azimuth.max_rad), 170, 1e-9);
  EXPECT_EQ(driver.limits().pitch.max_rad, 0);
  EXPECT_FALSE(controller.axes["1"].servo);
  EXPECT_THAT(controller.commands, ::testing::Contains("VEL 1 10.000000"));
  EXPECT_FALSE(last().referenced);
  EXPECT_NEAR(to_deg(last().angles.azimuth_rad), 3, 1e-9);
  EXPECT_TRUE(faults().empty());
}

TEST_F(Gcs2DriverTest, ReferencesWithTheServoOnAndReleasesIt) {
  open();
  controller.commands.clear();
  driver.home();
  bench.exchange();
  EXPECT_TRUE(last().moving);
  ASSERT_TRUE(until([&] { return last().referenced && !last().moving; }));
  EXPECT_EQ(controller.commands, (std::vector<std::string>{"SVO 1 1", "FRF 1", "SVO 1 0"}));
  EXPECT_FALSE(last().on_target) << "referenced, but nobody asked for a position";
}

TEST_F(Gcs2DriverTest, AsksForTheErrorAfterEverySetCommand) {
  home();
  move(20);
  ASSERT_TRUE(until([&] { return last().on_target; }));
  const std::string& sent = bench.sent();
  for (const std::string set : {"SVO ", "FRF 1", "MOV ", "VEL "}) {
    for (std::size_t at = sent.find(set); at != std::string::npos; at = sent.find(set, at + 1))
      EXPECT_EQ(sent.substr(sent.find('\n', at) + 1, 5), "ERR?\n") << sent.substr(at, 12);
  }
}

TEST_F(Gcs2DriverTest, MovesArrivesAndDwellsWithoutServo) {
  home();
  move(45);
  EXPECT_TRUE(last().moving);
  EXPECT_FALSE(last().on_target);
  ASSERT_TRUE(until([&] { return last().on_target; }));
  EXPECT_NEAR(to_deg(last().angles.azimuth_rad), 45, 1e-9);
  EXPECT_FALSE(last().moving);
  EXPECT_FALSE(controller.axes["1"].servo) << "released before the arrival is told";
  EXPECT_EQ(controller.commands, (std::vector<std::string>{"SVO 1 1", "MOV 1 45.000000", "SVO 1 0"}));
  const auto before = bench.events<TableReading>().size();
  bench.pass(3.5);
  EXPECT_NEAR(static_cast<double>(bench.events<TableReading>().size() - before), 3.5, 1);
  EXPECT_TRUE(last().on_target);
}

TEST_F(Gcs2DriverTest, TellsItsPositionTenTimesASecondWhileMoving) {
  home();
  move(100);  // 10 s at 10 deg/s
  bench.forget_events();
  ASSERT_TRUE(until([&] { return last().on_target; }));
  const auto readings = bench.events<TableReading>();
  EXPECT_GT(readings.size(), 70U);
  EXPECT_LT(readings.size(), 120U);
  EXPECT_TRUE(std::is_sorted(readings.begin(), readings.end(), [](const auto& a, const auto& b) {
    return a.angles.azimuth_rad < b.angles.azimuth_rad;
  }));
}

TEST_F(Gcs2DriverTest, ATargetOutsideTheTravelIsRefusedUnsent) {
  home();
  bench.forget_sent();
  move(171);
  ASSERT_EQ(faults().size(), 1U);
  EXPECT_THAT(faults()[0].what, HasSubstr("azimuth = 171.000 deg lies outside -170.000 to 170.000"));
  EXPECT_EQ(bench.sent().find("MOV"), std::string::npos);
  driver.move_to({0, 0.1, 0});
  bench.exchange();
  ASSERT_EQ(faults().size(), 2U);
  EXPECT_THAT(faults()[1].what, HasSubstr("there is no such axis"));
}

TEST_F(Gcs2DriverTest, NoMoveBeforeTheReferenceMove) {
  open();
  move(10);
  ASSERT_EQ(faults().size(), 1U);
  EXPECT_THAT(faults()[0].remedy, HasSubstr("home"));
  EXPECT_EQ(bench.sent().find("MOV"), std::string::npos);
}

TEST_F(Gcs2DriverTest, RequestsMadeBeforeItIsReadyAreRemembered) {
  controller.axes["1"].referenced = true;
  driver.home();
  driver.move_to({to_rad(30.0), 0, 0});
  bench.open();
  ASSERT_TRUE(until([&] { return last().on_target; }));
  EXPECT_NEAR(to_deg(last().angles.azimuth_rad), 30, 1e-9);
  EXPECT_THAT(controller.commands, ::testing::Not(::testing::Contains("FRF 1"))) << "was referenced";
}

TEST_F(Gcs2DriverTest, ANewTargetReplacesTheOld) {
  home();
  move(90);
  bench.pass(1);
  move(-20);
  ASSERT_TRUE(until([&] { return last().on_target; }));
  EXPECT_NEAR(to_deg(last().angles.azimuth_rad), -20, 1e-9);
}

TEST_F(Gcs2DriverTest, StopsAtOnceInAnyState) {
  home();
  move(90);
  ASSERT_TRUE(until([&] { return to_deg(last().angles.azimuth_rad) > 20; }));
  bench.forget_sent();
  driver.stop();
  bench.exchange();
  EXPECT_TRUE(bench.sent().starts_with("\x18"));
  ASSERT_TRUE(until([&] { return !last().moving; }));
  bench.pass(2);
  EXPECT_FALSE(last().on_target);
  EXPECT_LT(controller.axes["1"].position, 30);
  EXPECT_FALSE(controller.axes["1"].servo);
  EXPECT_TRUE(faults().empty()) << "error 10 is what a stop leaves";
  EXPECT_EQ(controller.error, 0) << "and it was read";
}

TEST_F(Gcs2DriverTest, TheProgramsEndStopsTheTable) {
  home();
  move(90);
  bench.forget_sent();
  driver.on_shutdown(bench.now());
  bench.exchange();
  EXPECT_TRUE(bench.sent().starts_with("\x18"));
}

class Gcs2ThreeAxes : public Gcs2DriverTest {
 protected:
  Gcs2ThreeAxes()
      : Gcs2DriverTest({{"axes.azimuth", std::string("1")},
                        {"axes.pitch", std::string("2")},
                        {"axes.roll", std::string("3")},
                        {"limits.pitch", std::vector<double>{-30, 200}},
                        {"servo_off_in_dwell", false}}) {
    controller.axes = {{"1", {}}, {"2", {}}, {"3", {}}};
  }
};

TEST_F(Gcs2ThreeAxes, ReferencesOneAfterTheOtherAndMovesTogether) {
  home();
  driver.move_to({to_rad(10.0), to_rad(20.0), to_rad(-30.0)});
  bench.exchange();
  ASSERT_TRUE(until([&] { return last().on_target; }));
  EXPECT_NEAR(to_deg(last().angles.azimuth_rad), 10, 1e-9);
  EXPECT_NEAR(to_deg(last().angles.pitch_rad), 20, 1e-9);
  EXPECT_NEAR(to_deg(last().angles.roll_rad), -30, 1e-9);
  EXPECT_TRUE(controller.axes["1"].servo) << "the servo stays on when the configuration says so";
}

TEST_F(Gcs2ThreeAxes, LimitsAreTheNarrowerOfBoth) {
  open();
  EXPECT_NEAR(to_deg(driver.limits().pitch.min_rad), -30, 1e-9);
  EXPECT_NEAR(to_deg(driver.limits().pitch.max_rad), 170, 1e-9);
}

TEST(Gcs2Settings, MistakesAreNamed) {
  Settings s("[table]", 1);
  s.set("axes.azimuth", std::string("1"), 2);
  s.set("axes.pitch", std::string("1"), 3);
  s.set("axes.roll", std::string("A B"), 4);
  s.set("limits.azimuth", std::vector<double>{10, -10}, 5);
  s.set("velocity_deg_per_s", 0.0, 6);
  s.set("baud", std::int64_t{5}, 7);
  static_cast<void>(read_gcs2_settings(s));
  ASSERT_EQ(s.errors().size(), 5U);
  std::vector<int> lines;
  for (const auto& error : s.errors()) lines.push_back(error.line);
  EXPECT_THAT(lines, ::testing::UnorderedElementsAre(3, 4, 5, 6, 7));
}

TEST(Gcs2Settings, LimitsOfAnAxisThatIsNotThere) {
  Settings s("[table]", 1);
  s.set("limits.roll", std::vector<double>{-10, 10}, 2);
  static_cast<void>(read_gcs2_settings(s));
  ASSERT_EQ(s.errors().size(), 1U);
  EXPECT_THAT(s.errors()[0].message, HasSubstr("no axis axes.roll"));
}

TEST(Gcs2Registry, IsATurntable) {
  const DriverEntry* entry = find_driver("gcs2");
  ASSERT_NE(entry, nullptr);
  Settings s("[table]", 1);
  const auto device = entry->make(0, s);
  EXPECT_NE(dynamic_cast<Turntable*>(device.get()), nullptr);
  EXPECT_EQ(device->baud(), 115200);
}

}  // namespace
}  // namespace mgtd::drivers::gcs2
