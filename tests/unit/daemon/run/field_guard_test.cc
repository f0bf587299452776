// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/field_guard.h"

#include <gtest/gtest.h>

#include <random>

namespace mgtd::daemon::run {
namespace {

constexpr double kRate_hz = 50, kNoise_nT = 0.3;
Instant at(double t_s) { return Instant{from_seconds(t_s)}; }

/// A field at rest, disturbed by `wave_nT` as a car does, for so many seconds.
class Field {
 public:
  explicit Field(FieldGuard& guard) : guard_(guard) {}
  void pass(double seconds, double wave_nT = 0) {
    for (const double end_s = t_s + seconds; t_s < end_s - 1e-9; t_s += 1 / kRate_hz) {
      Epoch epoch;
      epoch.seq = seq_++;
      epoch.t = {at(t_s), WallTime{}};
      for (auto& y_nT : epoch.y_nT) {
        for (int axis = 0; axis < 3; ++axis)
          y_nT[axis] = 20'000 + kNoise_nT * normal_(random_) + wave_nT * std::sin(2 * t_s);
      }
      guard_.add(EpochOrGap{epoch});
    }
  }
  double t_s{0};

 private:
  FieldGuard& guard_;
  std::mt19937_64 random_{11};
  std::normal_distribution<double> normal_;
  std::uint64_t seq_{0};
};

FieldGuard guard() { return FieldGuard({.limits = {}, .rate_hz = kRate_hz, .scalar_sd_nT = 0.1}, at(0)); }

TEST(FieldGuard, GoesOnWhenTheFieldWasCalmForLongEnough) {
  FieldGuard g = guard();
  Field field(g);
  field.pass(5);
  g.begin_noise();
  g.watch(at(field.t_s));
  EXPECT_FALSE(g.change());
  field.pass(1.1);
  EXPECT_FALSE(g.disturbed(5));
  ASSERT_TRUE(g.change()) << "it is told before it is a disturbance";
  EXPECT_LT(g.change()->change_nT, 0.5);
  EXPECT_EQ(g.change()->limit_nT, DisturbanceLimits{}.limit_nT);
  field.pass(3, 20);
  EXPECT_TRUE(g.disturbed(5));
  EXPECT_GT(g.change()->change_nT, 5);
  g.given_up(at(field.t_s));
  const double given_up_s = field.t_s;
  field.pass(2);
  EXPECT_EQ(g.calm(), FieldGuard::Calm::not_yet);
  field.pass(3, 20);
  EXPECT_EQ(g.calm(), FieldGuard::Calm::disturbed);
  g.watch(at(field.t_s));
  field.pass(5.1);
  EXPECT_EQ(g.calm(), FieldGuard::Calm::yes);
  g.given_up(at(field.t_s));  // once more, of the same pose
  EXPECT_NEAR(g.waited_s(at(field.t_s)), field.t_s - given_up_s, 1e-9);
  g.stored(50'000.0);
  EXPECT_EQ(g.waited_s(at(field.t_s)), 0);
}

TEST(FieldGuard, JudgesEachBlockOnce) {
  FieldGuard g = guard();
  Field field(g);
  field.pass(5);
  g.begin_noise();
  g.watch(at(field.t_s));
  field.pass(3, 20);
  EXPECT_TRUE(g.disturbed(5));
  EXPECT_FALSE(g.disturbed(5)) << "nothing new was measured";
}

TEST(FieldGuard, ALevelIsHeldAgainstThatOfThePoseBefore) {
  FieldGuard g = guard();
  EXPECT_FALSE(g.at_another_level(50'000.0)) << "there is no pose before";
  g.stored(50'000.0);
  EXPECT_FALSE(g.at_another_level(50'004.9));
  const auto seen = g.at_another_level(50'005.5);
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->seen_by, FieldDisturbance::SeenBy::level);
  EXPECT_NEAR(seen->change_nT, 5.5, 1e-9);
  EXPECT_EQ(seen->in_words(),
            "the scalar reference reads 50005.5 nT, +5.5 nT against the pose before (limit 5.0 nT)");
  EXPECT_FALSE(g.at_another_level(std::nullopt));
  g.paused();
  EXPECT_FALSE(g.at_another_level(60'000.0)) << "whoever resumes takes the field as it is";
}

}  // namespace
}  // namespace mgtd::daemon::run
