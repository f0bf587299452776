// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/wiring_probe.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

namespace mgtd::daemon::run {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// An operator with a magnet, and four sensors some of whose cables are swapped.
class Hands {
 public:
  explicit Hands(PerSensor<std::size_t> sensor_on_arm = {0, 1, 2, 3}) : sensor_on_arm_(sensor_on_arm) {}

  double strength_nT{5000};  ///< at the near sensor
  double beside{0.05};       ///< of it at the others

  /// The magnet at an arm (from 0), or away, for so long.
  void hold(std::optional<std::size_t> arm, double for_s) {
    for (const double end_s = t_s_ + for_s; t_s_ < end_s; t_s_ += 0.02) {
      Epoch epoch;
      epoch.seq = seq_++;
      epoch.t.mono = now();
      for (std::size_t a = 0; a < kSensors; ++a) {
        const double near_nT = !arm ? 0 : *arm == a ? strength_nT : beside * strength_nT;
        epoch.y_nT[sensor_on_arm_[a]] =
            Eigen::Vector3d(20'000 + gauss_(random_), 3'000 + near_nT, 45'000 + gauss_(random_));
      }
      test.add(epoch);
      test.advance(now());
    }
  }
  void through(std::initializer_list<std::size_t> arms) {
    for (const std::size_t arm : arms) {
      hold(std::nullopt, 3);
      hold(arm, 1);
    }
  }
  [[nodiscard]] Instant now() const { return Instant{} + from_seconds(50 + t_s_); }

  WiringProbe test{Instant{} + from_seconds(50)};

 private:
  PerSensor<std::size_t> sensor_on_arm_;
  std::mt19937_64 random_{4};
  std::normal_distribution<double> gauss_{0, 5};
  double t_s_{0};
  std::uint64_t seq_{0};
};

TEST(WiringProbe, RightCablesAreRight) {
  Hands hands;
  hands.through({0, 1, 2, 3});
  ASSERT_TRUE(hands.test.ended());
  const MagnetStatus status = hands.test.status();
  EXPECT_EQ(all_right(status), true);
  EXPECT_THAT(findings(status), IsEmpty());
  EXPECT_EQ(status.text, "every cable is on its arm; put the magnet away");
}

TEST(WiringProbe, SwappedCablesAreNamed) {
  Hands hands({0, 3, 2, 1});
  hands.through({0, 1, 2, 3});
  const MagnetStatus status = hands.test.status();
  EXPECT_EQ(all_right(status), false);
  EXPECT_THAT(findings(status),
              ElementsAre("the cable labelled s4 is on arm 2", "the cable labelled s2 is on arm 4"));
  EXPECT_EQ(to_json(status)["right"], false);
}

TEST(WiringProbe, TheOperatorIsToldWhatToDoNext) {
  Hands hands;
  EXPECT_THAT(hands.test.status().text, HasSubstr("keep the magnet away"));
  hands.hold(std::nullopt, 3);
  EXPECT_THAT(hands.test.status().text, HasSubstr("hold the magnet to the end of arm 1 (+X)"));
  hands.hold(0, 1);
  EXPECT_THAT(hands.test.status().text, HasSubstr("take the magnet away"));
  hands.hold(0, 20);
  EXPECT_EQ(hands.test.status().arm, 1) << "it does not go on while the magnet is there";
  hands.hold(std::nullopt, 3);
  EXPECT_THAT(hands.test.status().text, HasSubstr("arm 2 (+Y)"));
}

TEST(WiringProbe, AMagnetBetweenTwoArmsIsNoAnswer) {
  Hands hands;
  hands.beside = 0.5;
  hands.through({0});
  EXPECT_FALSE(hands.test.status().sensor_on_arm[0]);
  EXPECT_THAT(hands.test.status().text, HasSubstr("more than one sensor moves"));
}

TEST(WiringProbe, ATouchIsNoAnswer) {
  Hands hands;
  hands.hold(std::nullopt, 3);
  for (int i = 0; i < 5; ++i) {
    hands.hold(0, 0.3);
    hands.hold(std::nullopt, 0.3);
  }
  EXPECT_FALSE(hands.test.status().sensor_on_arm[0]);
}

TEST(WiringProbe, WithoutAnAnswerItEndsAndGuessesNothing) {
  Hands hands;
  hands.through({0, 1});
  hands.hold(std::nullopt, WiringProbe::kAnswer_s + 5);
  ASSERT_TRUE(hands.test.ended());
  const MagnetStatus status = hands.test.status();
  EXPECT_EQ(status.state, "timed out");
  EXPECT_EQ(all_right(status), std::nullopt);
  EXPECT_THAT(findings(status),
              ElementsAre(HasSubstr("arm 3 was not answered for"), HasSubstr("arm 4 was not asked for")));
}

TEST(WiringProbe, TheLimitIsToldInRealTime) {
  WiringProbe test(Instant{}, 30);
  test.advance(Instant{} + from_seconds(29 * WiringProbe::kAnswer_s));
  EXPECT_FALSE(test.ended());
  test.advance(Instant{} + from_seconds(31 * WiringProbe::kAnswer_s));
  EXPECT_THAT(test.status().text, HasSubstr("within 120 s"));
}

TEST(WiringProbe, StoppedItNamesTheArmsThatWereNotAskedForAndTheMagnet) {
  Hands hands;
  hands.hold(std::nullopt, 3);
  hands.test.stop();
  const MagnetStatus status = hands.test.status();
  EXPECT_THAT(status.text, HasSubstr("put the magnet away"));
  EXPECT_THAT(findings(status),
              ElementsAre(HasSubstr("arm 1 was not answered for"), HasSubstr("arm 2 was not asked for"),
                          HasSubstr("arm 3 was not asked for"), HasSubstr("arm 4 was not asked for")));
}

TEST(WiringProbe, ASensorThatIsNotLiveIsNamedWithItsState) {
  std::vector<std::pair<Slot, LinkHealth>> links;
  for (int i = 0; i < kSensors; ++i) links.emplace_back(Slot::sensor(i), LinkHealth{});
  for (auto& [slot, health] : links) health.state = LinkState::live;
  links.emplace_back(Slot::table(), LinkHealth{});
  EXPECT_TRUE(ready_for_magnet(links)) << "the table is not needed";
  links[2].second.state = LinkState::silent;
  links[2].second.detail = "no frame for 3 s";
  const auto refused = ready_for_magnet(links);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("s3 is silent (no frame for 3 s)"));
}

TEST(WiringProbe, OneSensorForTwoArmsIsOpen) {
  Hands hands;
  hands.through({0, 0, 2, 3});
  const MagnetStatus status = hands.test.status();
  EXPECT_EQ(all_right(status), std::nullopt);
  EXPECT_THAT(findings(status)[0], HasSubstr("s1 answered for arm 1 and for another one"));
}

TEST(WiringProbe, AnArrayThatIsNoCrossHasPlaces) {
  const PerSensor<Eigen::Vector3d> places{{0, 0, 0.25}, {0, 0, -0.25}, {0.1, 0.2, 0}};
  WiringProbe test(Instant{}, 1, calib::sensor::Geometry(places));
  double t_s = 0;
  const auto hold = [&](std::optional<std::size_t> sensor, double for_s) {
    for (const double end_s = t_s + for_s; t_s < end_s; t_s += 0.02) {
      Epoch epoch;
      epoch.t.mono = Instant{} + from_seconds(t_s);
      epoch.y_nT = no_readings(places.size());
      epoch.y_nT.fill(Eigen::Vector3d(20'000, 3'000, 45'000));
      if (sensor) epoch.y_nT[*sensor].x() += 5'000;
      test.add(epoch);
    }
  };
  hold(std::nullopt, 3);
  EXPECT_EQ(test.status().text, "hold the magnet to place 1 (0, 0, 0.25 m)");
  EXPECT_EQ(to_json(test.status())["sensor_on_arm"].size(), 3U);
  hold(1, 1);
  EXPECT_EQ(test.status().text, "place 1 is seen; take the magnet away");
  for (const std::size_t sensor : {0U, 2U}) {
    hold(std::nullopt, 3);
    hold(sensor, 1);
  }
  EXPECT_THAT(findings(test.status()),
              ElementsAre("the cable labelled s2 is at place 1", "the cable labelled s1 is at place 2"));
  EXPECT_EQ(test.status().text, "cables are at other places than their labels say; put the magnet away");
}

TEST(WiringProbe, OneSensorHasNothingToBeExchangedWith) {
  std::vector<std::pair<Slot, LinkHealth>> links{{Slot::sensor(0), LinkHealth{}},
                                                 {Slot::table(), LinkHealth{}}};
  links[0].second.state = LinkState::live;
  const auto refused = ready_for_magnet(links);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("this rig has one sensor"));
}

TEST(WiringProbe, SilentSensorsEndItToo) {
  WiringProbe test(Instant{});
  test.advance(Instant{} + from_seconds(WiringProbe::kAnswer_s + 1));
  EXPECT_EQ(test.status().end, MagnetEnd::timed_out);
}

}  // namespace
}  // namespace mgtd::daemon::run
