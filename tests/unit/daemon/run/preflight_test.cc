// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/preflight.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace mgtd::daemon::run {
namespace {

using ::testing::HasSubstr;

constexpr double kRigRate_hz = 50;

Stamp at(double t_s) { return {Instant{from_seconds(500 + t_s)}, WallTime{from_seconds(t_s).count()}}; }

/// Five seconds of a healthy rig, with a hand on everything.
struct Rig {
  double rate_hz{kRigRate_hz};
  double noise_nT{1};
  PerSensor<double> scale{1, 1, 1, 1};
  int frozen_axis{-1};
  int saturated_from{1 << 30};
  double scatter_nT{0};
  double skew_s{1e-4};
  std::uint64_t lost{0};
  bool table{true}, moving{false}, table_referenced{true};
  double azimuth_rad{0};
  int scalar_bad{0};
  double f_nT{50'000}, f_sd_nT{0.05};
  LinkState s2{LinkState::live};
  PreflightConfig config{.scalar = true};
  drivers::TableLimits limits{{-3.2, 3.2}, {-1.6, 1.6}, {-3.2, 3.2}};

  [[nodiscard]] Preflight look() const {
    std::mt19937_64 engine(3);
    std::normal_distribution<double> normal;
    Preflight preflight(config, at(0).mono);
    const auto count = static_cast<int>(5 * rate_hz);
    Epoch epoch;
    for (int k = 0; k < count; ++k) {
      const double t_s = (k + 1) / rate_hz;
      epoch.seq = static_cast<std::uint64_t>(k) + (k > count / 2 ? lost : 0);
      if (lost > 0 && k == count / 2) {
        preflight.add(Gap{epoch.seq, epoch.seq + lost - 1, at(t_s), "s2 silent"});
        continue;
      }
      epoch.t = at(t_s);
      epoch.skew_bound_s = skew_s;
      if (k >= saturated_from) epoch.flags |= Flag::saturated;
      for (std::size_t i = 0; i < kSensors; ++i) {
        const Eigen::Vector3d before = epoch.y_nT[i];
        const Eigen::Vector3d b_nT = scale[i] * 50'000 * Eigen::Vector3d(0.6, 0, 0.8);
        epoch.y_nT[i] = b_nT + Eigen::Vector3d(normal(engine), normal(engine), normal(engine)) * noise_nT +
                        Eigen::Vector3d::Constant(scatter_nT * std::sin(t_s));
        if (frozen_axis / 3 == static_cast<int>(i) && frozen_axis >= 0 && k > 0)
          epoch.y_nT[i][frozen_axis % 3] = before[frozen_axis % 3];
      }
      preflight.add(epoch);
    }
    for (int k = 0; k < 5; ++k)
      preflight.add(ScalarReading{at(k + 0.5), f_nT + f_sd_nT * normal(engine), k < scalar_bad ? 30 : 99,
                                  k >= scalar_bad});
    if (table) preflight.add(TableReading{at(4), {azimuth_rad, 0, 0}, table_referenced, moving, !moving});
    LinkHealth health;
    health.state = LinkState::live;
    preflight.add("s1", health);
    health.state = s2;
    preflight.add("s2", health);
    return preflight;
  }
  [[nodiscard]] std::vector<Check> checks() const { return look().checks(limits); }
};

std::string failed(const std::vector<Check>& checks) {
  std::string names;
  for (const Check& c : checks) {
    if (c.passed) continue;
    names += (names.empty() ? "" : " ") + c.name;
    EXPECT_FALSE(c.measured.empty());
    EXPECT_FALSE(c.limit.empty());
    EXPECT_FALSE(c.remedy.empty()) << c.name;
  }
  return names;
}

TEST(Preflight, HealthyRigPassesEveryCheck) {
  const auto checks = Rig{}.checks();
  EXPECT_EQ(failed(checks), "");
  EXPECT_TRUE(all_passed(checks));
  EXPECT_EQ(checks.size(), 2u + 4 + 16 + 1 + 1 + 1);  // links, epochs, sensors, wiring, scalar, table
}

TEST(Preflight, NoiseIsThatOfASample) {
  Rig rig;
  rig.noise_nT = 2;
  rig.scatter_nT = 10;  // slow: not noise. Largest of 12 estimates from 249 differences: sd 5.5 %
  EXPECT_NEAR(rig.look().noise_nT(), 2, 0.4);
  EXPECT_EQ(failed(rig.checks()), "");
}

TEST(Preflight, EachTroubleFailsItsOwnCheck) {
  EXPECT_EQ(failed(Rig{.rate_hz = 45}.checks()), "rate");
  EXPECT_EQ(failed(Rig{.noise_nT = 60}.checks()), "noise.s1 noise.s2 noise.s3 noise.s4");
  EXPECT_EQ(failed(Rig{.scale = {1, 1, 0.5, 1}}.checks()), "field.s3");
  EXPECT_EQ(failed(Rig{.scale = {1, 1, 1, 1.5}}.checks()), "field.s4");
  EXPECT_EQ(failed(Rig{.frozen_axis = 7}.checks()), "alive.s3");
  EXPECT_EQ(failed(Rig{.saturated_from = 200}.checks()), "saturation");
  EXPECT_EQ(failed(Rig{.scatter_nT = 50}.checks()), "rest.s1 rest.s2 rest.s3 rest.s4");
  EXPECT_EQ(failed(Rig{.skew_s = 0.05}.checks()), "clock");
  EXPECT_EQ(failed(Rig{.lost = 40}.checks()), "rate gaps");
  EXPECT_EQ(failed(Rig{.table = false}.checks()), "table");
  EXPECT_EQ(failed(Rig{.moving = true}.checks()), "table");
  EXPECT_EQ(failed(Rig{.azimuth_rad = 4}.checks()), "table");
  EXPECT_EQ(failed(Rig{.scalar_bad = 3}.checks()), "scalar");
  EXPECT_EQ(failed(Rig{.f_sd_nT = 100}.checks()), "scalar");
  EXPECT_EQ(failed(Rig{.s2 = LinkState::silent}.checks()), "link.s2");
}

std::string remedy_of(const std::vector<Check>& checks, const std::string& name) {
  for (const Check& c : checks) {
    if (c.name == name) return c.remedy;
  }
  return "no such check";
}

TEST(Preflight, ABusyComputerIsBlamedBeforeTheCables) {
  Preflight preflight = Rig{.lost = 40, .s2 = LinkState::silent}.look();
  for (int k = 0; k < 100; ++k) preflight.passes(at(0.02 * k).mono);
  const std::string cable = "check cable, port and baud rate of the sensor named";
  EXPECT_EQ(remedy_of(preflight.checks({}), "gaps"), cable);
  preflight.passes(at(0.02 * 99 + 2.5).mono);
  const auto checks = preflight.checks({});
  for (const char* name : {"rate", "gaps", "link.s2"})
    EXPECT_THAT(remedy_of(checks, name),
                ::testing::StartsWith("this computer is too busy: the daemon stood still for 2.5 s"))
        << name;
  EXPECT_THAT(remedy_of(checks, "gaps"), ::testing::EndsWith(cable));
}

TEST(Preflight, ATableIsSilentOnlyWhileTheProgramListens) {
  Rig rig;
  Preflight preflight = rig.look();
  preflight.passes(at(5).mono);
  preflight.passes(at(25).mono);  // stood still: the table could not be asked
  EXPECT_EQ(failed(preflight.checks(rig.limits)), "");
  int silent = 0;
  for (; failed(preflight.checks(rig.limits)).empty() && silent < 1000; ++silent)
    preflight.passes(at(25 + 0.1 * (silent + 1)).mono);
  EXPECT_NEAR(0.1 * silent, 10, 0.2);
  EXPECT_EQ(failed(preflight.checks(rig.limits)), "table");
  EXPECT_THAT(remedy_of(preflight.checks(rig.limits), "table"),
              ::testing::StartsWith("this computer is too busy: the daemon stood still for 20.0 s"));
  preflight.add(TableReading{at(36), {0, 0, 0}, true, false, true});
  EXPECT_EQ(failed(preflight.checks(rig.limits)), "");
}

TEST(Preflight, TableThatIsNotReferencedYetMayReportAnything) {
  EXPECT_EQ(failed(Rig{.table_referenced = false, .azimuth_rad = 40}.checks()), "");
}

TEST(Preflight, TableOutsideItsLimitsIsToldHowItGetsBack) {
  const auto checks = Rig{.azimuth_rad = 4}.checks();
  const auto table =
      std::find_if(checks.begin(), checks.end(), [](const Check& c) { return c.name == "table"; });
  ASSERT_NE(table, checks.end());
  EXPECT_THAT(table->remedy, ::testing::StartsWith("azimuth 229.18 is outside -183.346 to 183.346 deg: "));
  EXPECT_THAT(table->remedy, ::testing::HasSubstr("switch the controller off and on"));
}

TEST(Preflight, WithoutScalarTheStatedFieldOrTheEarthsCounts) {
  Rig rig;
  rig.config.scalar = false;
  rig.scalar_bad = 5;
  rig.config.field_nT = 30'000;
  EXPECT_EQ(failed(rig.checks()), "field.s1 field.s2 field.s3 field.s4");
  rig.config.field_nT.reset();
  EXPECT_EQ(failed(rig.checks()), "");
  rig.scale = {0.1, 1, 1, 1};  // 5 uT: no place on Earth
  EXPECT_EQ(failed(rig.checks()), "field.s1");
}

TEST(Preflight, NothingAtAllFailsWithoutInventingNumbers) {
  const Preflight preflight({.scalar = true}, at(0).mono);
  EXPECT_FALSE(preflight.complete(at(19).mono));
  EXPECT_TRUE(preflight.complete(at(20).mono));
  EXPECT_EQ(preflight.noise_nT(), 0);
  const auto checks = preflight.checks({{-1, 1}, {}, {}});
  EXPECT_THAT(failed(checks), HasSubstr("rate"));
  for (const Check& c : checks) EXPECT_THAT(c.measured, ::testing::Not(HasSubstr("nan"))) << c.name;
}

TEST(Preflight, LooksForItsLengthFromTheFirstEpoch) {
  Preflight preflight({}, at(0).mono);
  preflight.add(TableReading{});
  Epoch epoch;
  epoch.t = at(3);
  preflight.add(epoch);
  EXPECT_FALSE(preflight.complete(at(20).mono));  // nothing has come since: the program may have slept
  EXPECT_TRUE(preflight.complete(at(28).mono));
  epoch.t = at(7.9);
  preflight.add(epoch);
  EXPECT_FALSE(preflight.complete(at(8).mono));
  epoch.t = at(8);
  preflight.add(epoch);
  EXPECT_TRUE(preflight.complete(at(8).mono));
}

TEST(Preflight, WaitsForTheFirstWordOfASlowInstrument) {
  Preflight preflight({.scalar = true}, at(0).mono);
  preflight.add(TableReading{});
  Epoch epoch;
  for (const double t_s : {1.0, 6.5}) {
    epoch.t = at(t_s);
    preflight.add(epoch);
  }
  EXPECT_FALSE(preflight.complete(at(9).mono));
  EXPECT_TRUE(preflight.complete(at(20).mono));  // but not for ever
  preflight.add(ScalarReading{at(9), 50'000, 99, true});
  EXPECT_TRUE(preflight.complete(at(9).mono));
}

TEST(Preflight, CoarseInstrumentsMayRepeatThemselves) {
  Rig rig{.noise_nT = 0};
  EXPECT_EQ(failed(rig.checks()), "alive.s1 alive.s2 alive.s3 alive.s4");
  rig.config.frozen_check = false;
  EXPECT_EQ(failed(rig.checks()), "");
}

}  // namespace
}  // namespace mgtd::daemon::run
