// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration/live_tensor.h"

#include <gmock/gmock.h>

#include <cmath>

#include "calib/effects/laws/axis_hysteresis.h"
#include "calib/effects/laws/axis_settling.h"
#include "calib/effects/library/library.h"

namespace mgtd::calib::calibration {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr WallTime kStart{1'795'255'200'000'000'000};

/// Four ideal sensors and effects of known coefficients.
std::shared_ptr<const Calibration> with(const std::vector<std::pair<std::string, double>>& effects,
                                        const std::string& start = format_utc(kStart)) {
  Calibration c;
  c.sample_noise_nT.setConstant(0.3);
  c.reference.t_utc = start;
  for (const auto& [spec, value] : effects) {
    CalibratedEffect e{spec, {}, {}};
    e.size_nT = sensor::FieldVector::Constant(sensor::kChannels, 4);
    const effects::EffectPtr effect = *effects::library::make_effect(spec);
    for (const effects::Coefficient& k : effect->coefficients())
      e.coefficients.push_back({k.name, value, 0, k.unit});
    c.effects.push_back(std::move(e));
  }
  Eigen::Index m = 0;
  for (const CalibratedEffect& e : c.effects) m += static_cast<Eigen::Index>(e.coefficients.size());
  c.effect_covariance.setZero(m, kArrayParameters + m);
  c.seal();
  return std::make_shared<const Calibration>(std::move(c));
}

Epoch epoch(double t_s, const Eigen::Vector3d& y_nT, double T_degC = std::nan("")) {
  Epoch out;
  out.t = {Instant{} + from_seconds(t_s), WallTime{kStart.ns + static_cast<std::int64_t>(t_s * 1e9)}};
  out.y_nT.fill(y_nT);
  out.T_degC.fill(T_degC);
  return out;
}

const Eigen::Vector3d kField(20'000, 3'000, 40'000);

TEST(LiveTensor, RemovesWhatTheLiveThermometerAndTheClockSay) {
  LiveTensor live(with({{"axis.offset.temperature@s3.z", 2.0}, {"axis.offset.drift@s1.x", 10.0}}));
  Epoch e = epoch(1800, kField, 23);
  e.y_nT[2].z() += 2.0 * (23 - effects::kReferenceT_degC);
  e.y_nT[0].x() += 10.0 * 0.5;
  const TensorSample s = live.apply(e);
  EXPECT_NEAR(s.g_nT_per_m.xx, 0, 1e-9);
  EXPECT_NEAR(s.g_nT_per_m.xz, 0, 1e-9);
  EXPECT_FALSE(s.flags.has(Flag::incomplete));
  EXPECT_THAT(live.left_out(), IsEmpty());
}

/// Their mean is the field at the centre of the cross, which the sample holds.
TEST(LiveTensor, ShowsTheFieldsAtTheSensors) {
  LiveTensor raw{sensor::Geometry()}, plain(with({})),
      corrected(with({{"axis.offset.temperature@s3.z", 2.0}}));
  for (LiveTensor* live : {&raw, &plain, &corrected}) {
    Epoch e = epoch(1, kField, 23);
    e.y_nT[0].x() += 8;
    const TensorSample s = live->apply(e);
    const sensor::FieldVector& b = live->fields_P_nT();
    ASSERT_EQ(b.size(), sensor::kChannels);
    EXPECT_NEAR(b[0], kField.x() + 8, 1e-9);
    EXPECT_LT((s.b_P_nT - (b.segment<3>(0) + b.segment<3>(3) + b.segment<3>(6) + b.segment<3>(9)) / 4).norm(),
              1e-9);
  }
  EXPECT_NEAR(plain.fields_P_nT()[8], kField.z(), 1e-9);
  EXPECT_NEAR(corrected.fields_P_nT()[8], kField.z() - 2.0 * (23 - effects::kReferenceT_degC), 1e-9);
}

TEST(LiveTensor, WhatIsNotMeasuredIsLeftOutAndSaysSo) {
  LiveTensor live(with({{"axis.offset.temperature@s3.z", 2.0}, {"axis.offset.drift@s1.x", 10.0}}, ""));
  EXPECT_EQ(live.left_out().size(), 2U) << "before the first sample nothing is measured";
  const TensorSample cold = live.apply(epoch(1800, kField));
  EXPECT_THAT(live.left_out(), ElementsAre(LeftOutEffect{"axis.offset.temperature", "s3_T_degC"},
                                           LeftOutEffect{"axis.offset.drift", "t_s"}));
  EXPECT_TRUE(cold.flags.has(Flag::incomplete));
  // Two effects of 4 nT in each component beside 0.3 nT of noise, at both ends of 0.4 m.
  EXPECT_NEAR(cold.g_sd_nT_per_m.xz, std::sqrt(2 * (2 * 16 + 0.09)) / 0.4, 1e-6);
  const TensorSample warm = live.apply(epoch(1800.02, kField, 23));
  EXPECT_THAT(live.left_out(), ElementsAre(LeftOutEffect{"axis.offset.drift", "t_s"}));
  EXPECT_NEAR(warm.g_sd_nT_per_m.xz, std::sqrt(2 * (16 + 0.09)) / 0.4, 1e-6);
  EXPECT_GT(cold.g_sd_nT_per_m.xz, warm.g_sd_nT_per_m.xz);
}

TEST(LiveTensor, AGradientOfTheSiteStaysIn) {
  LiveTensor live(with({{"site.gradient", 50.0}, {"axis.offset.temperature@s3.z", 2.0}}));
  Epoch e = epoch(1, kField, effects::kReferenceT_degC);
  e.y_nT[0].x() += 10;
  EXPECT_NEAR(live.apply(e).g_nT_per_m.xx, 25, 1e-9);
}

/// x along one axis of all sensors; the loop itself, and not the code under test, says what the core
/// remembers.
TEST(LiveTensor, HysteresisFollowsThePathOnceItIsKnown) {
  const double h = 3, w = 0.1;
  LiveTensor live(with({{"axis.hysteresis@s3.x,w=0.1", h}}));
  double p = 0.37, t = 0;  // where it began is unknown to the daemon
  const auto at = [&](double x) {
    p = std::max(x - w, std::min(x + w, p));
    Eigen::Vector3d v = x * effects::kReferenceField_nT * Eigen::Vector3d::Ones();
    Epoch e = epoch(t += 0.02, v);
    e.y_nT[2].x() += h * (p - x) / w;
    return live.apply(e);
  };
  bool known_before = true;
  for (double x = 0.4; x > 0.25; x -= 0.001)
    known_before = known_before && !at(x).flags.has(Flag::incomplete);
  EXPECT_FALSE(known_before);
  for (double x = 0.25; x > -0.4; x -= 0.001) static_cast<void>(at(x));
  // Known now: down, a little up (inside the loop), and far up again.
  for (double x = -0.4; x < 0.5; x += 0.001) {
    const TensorSample s = at(x);
    ASSERT_FALSE(s.flags.has(Flag::incomplete));
    ASSERT_NEAR(s.g_nT_per_m.xx, 0, 0.05 * h / 0.4) << x;
  }
  // Ten seconds without samples: anything may have happened.
  t += 10;
  EXPECT_TRUE(at(0.5).flags.has(Flag::incomplete));
}

TEST(LiveTensor, SettlingFollowsAfterFiveTimeConstants) {
  const double eta = 8, tau = 4;
  LiveTensor live(with({{"axis.settling@s3.x,tau=4", eta}}));
  double z = 0.1, t = 0;
  const auto at = [&](double x) {
    z = x + (z - x) * std::exp(-0.02 / tau);
    Eigen::Vector3d v = x * effects::kReferenceField_nT * Eigen::Vector3d::Ones();
    Epoch e = epoch(t += 0.02, v);
    e.y_nT[2].x() += eta * (z - x);
    return live.apply(e);
  };
  EXPECT_TRUE(at(0.4).flags.has(Flag::incomplete));
  for (int k = 0; k < 1100; ++k) static_cast<void>(at(0.4));
  for (int k = 0; k < 500; ++k) {
    const TensorSample s = at(-0.3);
    ASSERT_FALSE(s.flags.has(Flag::incomplete));
    ASSERT_NEAR(s.g_nT_per_m.xx, 0, 0.02 * eta / 0.4) << k;
  }
}

/// The part of g_sd that is kept between samples is that of the field as it is.
TEST(LiveTensor, StandardDeviationsFollowATurn) {
  const auto sensitive = [] {
    Calibration c = *with({{"axis.offset.temperature@s3.z", 2.0}});
    c.covariance(sensor::alpha, sensor::alpha) = 1e-6;  // 50 nT at right angles to the field, none along it
    c.seal();
    return std::make_shared<const Calibration>(c);
  }();
  LiveTensor kept(sensitive);
  const Eigen::Vector3d along(50'000, 0, 0), across(0, 50'000, 0);
  const double before = kept.apply(epoch(0, along, 20)).g_sd_nT_per_m.xz;
  const double turned = kept.apply(epoch(0.02, across, 20)).g_sd_nT_per_m.xz;
  EXPECT_GT(turned, 20 * before);
  LiveTensor fresh(sensitive);
  EXPECT_DOUBLE_EQ(turned, fresh.apply(epoch(0.02, across, 20)).g_sd_nT_per_m.xz);
}

}  // namespace
}  // namespace mgtd::calib::calibration
