// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/dwell.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/unit/daemon/serve/streams.h"

namespace mgtd::daemon::run {
namespace {

using test::stamp_at;

constexpr double kRate_hz = 50;

/// White noise of sd 1 nT about (100, 200, 300) nT on every sensor, first-order autoregressive with
/// coefficient `ar`.
struct Source {
  explicit Source(double ar_coefficient = 0, std::uint64_t seed = 3) : ar(ar_coefficient), random(seed) {}
  Epoch next() {
    Epoch e;
    e.seq = seq;
    e.t = stamp_at(static_cast<double>(seq) / kRate_hz);
    ++seq;
    for (std::size_t i = 0; i < kSensors; ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        double& x = state[i][axis];
        x = ar * x + std::sqrt(1 - ar * ar) * normal(random);
        e.y_nT[i][axis] = 100.0 * (axis + 1) + x;
      }
      e.T_degC[i] = 20 + static_cast<double>(i);
    }
    return e;
  }
  double ar;
  std::mt19937_64 random;
  std::normal_distribution<double> normal;
  PerSensor<Eigen::Vector3d> state{};
  std::uint64_t seq{0};
};

DwellPlace place() {
  DwellPlace p;
  p.number = 7;
  p.set = "random";
  p.angles = TableAngles{0.1, 0.2, 0.3};
  p.run_start = stamp_at(-100);
  p.stopped = stamp_at(0.5).mono;
  p.sense = -1;
  return p;
}

Dwell filled(Source& source, DwellConfig config, double until_s) {
  Dwell dwell(config, stamp_at(1).mono);
  while (static_cast<double>(source.seq) / kRate_hz < until_s) dwell.add(EpochOrGap{source.next()});
  return dwell;
}

TEST(Dwell, MakesARowOfThePoseTable) {
  Source source;
  DwellConfig config;
  config.length_s = 20;
  Dwell dwell = filled(source, config, 22);
  for (int i = 0; i < 30; ++i) {
    dwell.add(ScalarReading{stamp_at(i), 50'000.0 + (i % 2 == 0 ? 0.1 : -0.1), 99, true});
    dwell.add(ScalarReading{stamp_at(i), 1.0, 0, false});
  }
  EXPECT_TRUE(dwell.complete(stamp_at(0).mono));
  const Pose pose = dwell.pose(place()).value();
  EXPECT_EQ(pose.number, 7);
  EXPECT_EQ(pose.n, 1000);
  EXPECT_DOUBLE_EQ(*pose.t_s, 111);
  EXPECT_DOUBLE_EQ(*pose.since_stop_s, 10.5);
  EXPECT_EQ(pose.t_utc->ns, stamp_at(11).wall.ns);
  EXPECT_EQ(pose.dwell_s, 20);
  EXPECT_EQ(pose.sense, -1);
  EXPECT_DOUBLE_EQ(*pose.T_degC[2], 22);
  EXPECT_NEAR(*pose.f_nT, 50'000, 1e-6);
  EXPECT_NEAR(*pose.f_sd_nT, 0.1 / std::sqrt(20), 0.004);
  for (const auto& y : pose.y_nT) EXPECT_NEAR(y.y(), 200, 5 / std::sqrt(1000));  // five standard errors
  for (const auto& sd : pose.sd_nT) EXPECT_NEAR(*sd[1], 1, 5 / std::sqrt(2000));
  EXPECT_NEAR(*pose.n_eff, 1000, 60);
}

TEST(Dwell, EffectiveNumberOfCorrelatedSamples) {
  Source source(0.5);
  DwellConfig config;
  config.length_s = 80;
  const Pose pose = filled(source, config, 82).pose(place()).value();
  // 1 + 2 (0.5 + 0.25 + ...) = 3; the sum ends at 1.5/sqrt(12000) = 0.014: low by 0.03, and each of ~6 lags
  // is known to 0.01
  EXPECT_NEAR(4000 / *pose.n_eff, 3, 0.15);
}

/// A sensor half-way between two samples: sd is 0.71 of the raw one and neighbours correlate by one half.
TEST(Dwell, InterpolationIsNotMistakenForQuiet) {
  Source source;
  DwellConfig config;
  config.length_s = 80;
  Dwell dwell(config, stamp_at(1).mono);
  Epoch before = source.next();
  for (int i = 0; i < 4100; ++i) {
    const Epoch now = source.next();
    Epoch e = now;
    e.y_nT[1] = 0.5 * (before.y_nT[1] + now.y_nT[1]);
    before = now;
    dwell.add(EpochOrGap{e});
  }
  const Pose pose = dwell.pose(place()).value();
  EXPECT_NEAR(*pose.n_eff / 4000, 1, 0.04);
  EXPECT_NEAR(*pose.sd_nT[0][0], 1, 0.06);
  EXPECT_NEAR(*pose.sd_nT[1][0], 1, 0.06);
}

TEST(Dwell, RefusesWhatIsNoMeasurement) {
  DwellConfig config;
  Source thin;
  Dwell gappy(config, stamp_at(1).mono);
  for (int i = 0; i < 320; ++i) {
    const Epoch e = thin.next();
    if (i % 3 == 0) gappy.add(EpochOrGap{e});
  }
  auto refused = gappy.pose(place());
  ASSERT_FALSE(refused);
  EXPECT_NE(refused.error().message.find("missing"), std::string::npos);

  Source stuck;
  Dwell frozen(config, stamp_at(1).mono), coarse({5, 50, 0.2, 0, false, 0.05}, stamp_at(1).mono);
  for (int i = 0; i < 320; ++i) {
    Epoch e = stuck.next();
    e.y_nT[2] = {1, 2, 3};
    frozen.add(EpochOrGap{e});
    coarse.add(EpochOrGap{e});
  }
  refused = frozen.pose(place());
  ASSERT_FALSE(refused);
  EXPECT_TRUE(refused.error().message.starts_with("s3 gave exactly the same"));
  EXPECT_TRUE(coarse.pose(place()));

  Source full;
  Dwell saturated(config, stamp_at(1).mono);
  for (int i = 0; i < 320; ++i) {
    Epoch e = full.next();
    if (i == 100) e.flags |= Flag::saturated;
    saturated.add(EpochOrGap{e});
  }
  EXPECT_FALSE(saturated.pose(place()));
}

TEST(Dwell, SevenSamplesAreTooFew) {
  Source source;
  DwellConfig config;
  config.length_s = 0.13;
  const auto refused = filled(source, config, 2).pose(place());
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().message, "7 epochs in the dwell of 0.13 s, at least 8 are needed");
}

/// A sensor that repeats one reading for a sixth of the dwell, in a field that has moved on since.
TEST(Dwell, RepeatedReadingsAreNoMeasurement) {
  DwellConfig config;
  const auto dwell_with = [&](int stuck) {
    Source source;
    Dwell dwell(config, stamp_at(1).mono);
    for (int i = 0; i < 320; ++i) {
      Epoch e = source.next();
      const bool frozen = i >= 60 && i < 60 + stuck;
      if (frozen) {
        e.y_nT[1] = {1, 2, 3};
        if (i > 60) e.flags |= Flag::frozen;
      }
      dwell.add(EpochOrGap{e});
    }
    return dwell.pose(place());
  };
  const Pose clean = dwell_with(0).value(), pose = dwell_with(40).value();
  EXPECT_EQ(*pose.n, *clean.n - 39);
  // One of 211 readings is off by the distance to the field, the others are as they would have been.
  const double off_nT = (pose.y_nT[1] - clean.y_nT[1]).norm();
  EXPECT_LT(off_nT, 1.5 * (clean.y_nT[1] - Eigen::Vector3d(1, 2, 3)).norm() / *pose.n + 0.5);
  const auto refused = dwell_with(100);
  ASSERT_FALSE(refused);
  EXPECT_TRUE(refused.error().message.starts_with("s2 gave exactly the same"));
}

TEST(Dwell, EndsByDataOrAtLastByTime) {
  Dwell dwell({}, stamp_at(1).mono);
  EXPECT_FALSE(dwell.complete(stamp_at(8.9).mono));
  EXPECT_TRUE(dwell.complete(stamp_at(9.1).mono));
  dwell.add(EpochOrGap{Gap{0, 9, stamp_at(6.1), "s1: silent"}});
  EXPECT_TRUE(dwell.complete(stamp_at(6.1).mono));
  EXPECT_FALSE(dwell.pose(place()));
}

}  // namespace
}  // namespace mgtd::daemon::run
