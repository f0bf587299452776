// SPDX-License-Identifier: Apache-2.0
#include "drivers/gcs2_driver.h"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "drivers/registry.h"
#include "proto/units.h"
#include "tests/support/device_bench.h"

namespace mgtd::drivers::gcs2 {
namespace {

using mgtd::testing::DeviceBench;
using ::testing::HasSubstr;

/// A controller as documented: silent on set commands, error register, servo and reference needed to move.
struct Controller {
  struct Axis {
    double position{3}, target{3}, min{-170}, max{170};
    bool servo{false}, referenced{false};
  };
  std::map<std::string, Axis> axes{{"1", {}}};
  double velocity{10};
  int error{0};
  double referencing_until{-1};
  double now{0}, last{0};
  bool stalls{false};  ///< does not move
  bool reference_fails{false};
  std::string mute;   ///< messages that start so get no answer ...
  int mute_times{0};  ///< ... this often
  std::string command;
  std::vector<std::string> commands;  ///< that set something

  std::string operator()(std::string_view sent) {
    std::string out;
    for (const char c : sent) {
      if (c == '\x18') {
        for (auto& [name, axis] : axes) axis.target = axis.position;
        error = 10;
        commands.emplace_back("stop");
        command.clear();
      } else if (c == '\x05') {
        out += fmt::format("{:X}\n", moving());
      } else if (c == '\x07') {
        out += now < referencing_until ? "\xB0\n" : "\xB1\n";
      } else if (c == '\n') {
        out += answer(std::exchange(command, {}));
      } else {
        command += c;
      }
    }
    return out;
  }
  void advance(double t) {
    for (auto& [name, axis] : axes) {
      const double step = velocity * (t - last);
      if (!stalls) axis.position += std::clamp(axis.target - axis.position, -step, step);
    }
    now = last = t;
  }
  [[nodiscard]] unsigned moving() const {
    unsigned mask = 0, bit = 1;
    for (const auto& [name, axis] : axes) {
      if (!stalls && axis.position != axis.target) mask |= bit;
      bit *= 2;
    }
    return mask;
  }
  std::string answer(const std::string& line) {
    if (mute_times > 0 && line.starts_with(mute)) {
      --mute_times;
      return "";
    }
    const std::string head = line.substr(0, line.find(' '));
    if (head == "ERR?") return fmt::format("{}\n", std::exchange(error, 0));
    if (head == "*IDN?") return "(c)2015 Physik Instrumente, C-867, 1, 1.2\n";
    if (head == "SAI?") {
      std::string out;
      for (const auto& [name, axis] : axes) out += (out.empty() ? "" : " \n") + name;
      return out + "\n";
    }
    const std::string name = line.substr(head.size() + 1, 1);
    const auto found = axes.find(name);
    if (found == axes.end()) {
      error = 15;
      return "";
    }
    return answer(line, head, name, found->second);
  }
  std::string answer(const std::string& line, const std::string& head, const std::string& name, Axis& axis) {
    const auto reply = [&](auto value) { return fmt::format("{}={}\n", name, value); };
    if (head == "POS?") return reply(axis.position);
    if (head == "ONT?") return reply(axis.servo && axis.position == axis.target ? 1 : 0);
    if (head == "TMN?") return reply(axis.min);
    if (head == "TMX?") return reply(axis.max);
    if (head == "FRF?") return reply(axis.referenced ? 1 : 0);
    commands.push_back(line);
    const std::string value = line.size() > 6 ? line.substr(6) : "";
    if (head == "SVO") axis.servo = value == "1";
    if (head == "VEL") velocity = std::stod(value);
    if (head == "FRF") {
      referencing_until = now + 2;
      axis.referenced = !reference_fails;
      axis.position = axis.target = 0;
    }
    if (head == "MOV") {
      const double target = std::stod(value);
      if (!axis.servo || !axis.referenced) {
        error = 5;
      } else if (target < axis.min || target > axis.max) {
        error = 7;
      } else {
        axis.target = target;
      }
    }
    return "";
  }
};

Gcs2Settings settings(std::map<std::string, Settings::Value> more = {}) {
  Settings s("[table]", 1);
  int line = 2;
  for (auto& [key, value] : more) s.set(key, value, line++);
  Gcs2Settings out = read_gcs2_settings(s);
  EXPECT_TRUE(s.errors().empty());
  return out;
}

class Gcs2DriverTest : public ::testing::Test {
 protected:
  explicit Gcs2DriverTest(std::map<std::string, Settings::Value> more = {})
      : driver(settings(std::move(more))) {}

  void open() {
    bench.open();
    ASSERT_TRUE(until([&] { return driver.health().state == LinkState::live; }));
  }
  void home() {
    open();
    driver.home();
    bench.exchange();
    ASSERT_TRUE(until([&] { return last().referenced && !last().moving; }));
    controller.commands.clear();
    bench.forget_events();
  }
  bool until(const std::function<bool()>& condition, double limit_s = 120) {
    return bench.pass_until(
        [&] {
          controller.advance(bench.t_s());
          return condition();
        },
        limit_s);
  }
  [[nodiscard]] TableReading last() const {
    const auto readings = bench.events<TableReading>();
    return readings.empty() ? TableReading{} : readings.back();
  }
  [[nodiscard]] std::vector<DeviceFault> faults() const { return bench.events<DeviceFault>(); }
  void move(double azimuth_deg) {
    driver.move_to({to_rad(azimuth_deg), 0, 0});
    bench.exchange();
  }

  Controller controller;
  Gcs2Driver driver;
  DeviceBench bench{driver, std::ref(controller)};
};

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

TEST_F(Gcs2DriverTest, ARefusedMoveIsAFaultInWords) {
  home();
  controller.axes["1"].max = 50;  // the controller's own idea has changed
  move(60);
  ASSERT_TRUE(until([&] { return !faults().empty(); }));
  EXPECT_THAT(faults()[0].what, HasSubstr("'MOV 1 60.000000': a target lies outside the travel"));
  EXPECT_THAT(faults()[0].what, HasSubstr("GCS error 7"));
  EXPECT_EQ(controller.commands.back(), "stop");
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
  bench.pass(2.1);           // the reply is overdue: the line must fall quiet now
  bench.feed("1=12.345\n");  // ... and here it comes, late
  ASSERT_TRUE(until([&] { return last().on_target; }));
  for (const auto& reading : bench.events<TableReading>())
    EXPECT_NE(to_deg(reading.angles.azimuth_rad), 12.345);
  EXPECT_NEAR(to_deg(last().angles.azimuth_rad), 45, 1e-9);
  EXPECT_TRUE(faults().empty());
  EXPECT_TRUE(driver.health().balanced());
}

TEST_F(Gcs2DriverTest, AControllerThatStopsAnsweringIsAFaultWhileMoving) {
  home();
  move(45);
  controller.mute = "";
  controller.mute_times = 1'000'000;
  ASSERT_TRUE(until([&] { return driver.health().state == LinkState::silent; }));
  ASSERT_EQ(faults().size(), 1U);
  EXPECT_THAT(faults()[0].what, HasSubstr("does not answer"));
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

TEST_F(Gcs2DriverTest, ADeadPortIsSilent) {
  DeviceBench stage(driver);
  stage.open();
  ASSERT_TRUE(stage.pass_until([&] { return driver.health().state == LinkState::silent; }));
  EXPECT_TRUE(stage.events<DeviceFault>().empty());
  EXPECT_TRUE(stage.pass_until([&] { return driver.wants_reopen(); }));
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
