// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/rotation_consistency.h"

#include <gtest/gtest.h>

#include <random>

#include "calib/sensor/sensor_equations.h"
#include "daemon/plan/mounting.h"
#include "proto/units.h"

namespace mgtd::daemon::run {
namespace {

/// Four sensors that are mounted differently and off by 1 % of the field.
class Site {
 public:
  explicit Site(std::uint64_t seed) : random_(seed) {}

  TableAngles attitude() { return {to_rad(draw(-180, 180)), to_rad(draw(-80, 80)), to_rad(draw(-180, 180))}; }

  Pose pose(const TableAngles& truth, const TableAngles& entered) {
    Pose out;
    out.number = ++number_;
    out.azimuth_rad = entered.azimuth_rad;
    out.pitch_rad = entered.pitch_rad;
    out.roll_rad = entered.roll_rad;
    const Eigen::Vector3d b =
        calib::sensor::table_rotation(truth.azimuth_rad, truth.pitch_rad, truth.roll_rad, 0.0, 0.0) *
        Eigen::Vector3d(25'000, -3'000, 43'000);
    out.y_nT = {Eigen::Vector3d(b.x() + 400, b.y(), b.z()), Eigen::Vector3d(-b.y(), b.x() - 500, b.z()),
                Eigen::Vector3d(b.z(), b.x(), b.y() + 300), Eigen::Vector3d(b.x(), -b.y(), -b.z() + 450)};
    return out;
  }
  double draw(double low, double high) {
    return low + (high - low) * static_cast<double>(random_() >> 11U) * 0x1p-53;
  }

 private:
  std::mt19937_64 random_;
  int number_{0};
};

TEST(RotationConsistency, BlundersOfTenDegreesAreSeenAndScalesReadToADegreeAreNot) {
  int seen = 0, doubted = 0;
  constexpr int kTrials = 60;
  for (int trial = 0; trial < kTrials; ++trial) {
    Site site(static_cast<std::uint64_t>(100 + trial));
    RotationConsistency turn;
    const auto rough = [&](TableAngles a) {
      a.azimuth_rad += to_rad(site.draw(-1, 1));
      a.pitch_rad += to_rad(site.draw(-1, 1));
      a.roll_rad += to_rad(site.draw(-1, 1));
      return a;
    };
    for (int k = 0; k < 6; ++k) {
      const TableAngles a = site.attitude();
      turn.add(site.pose(a, rough(a)));
    }
    const TableAngles a = site.attitude();
    doubted += turn.judge(site.pose(a, rough(a))).agrees ? 0 : 1;
    TableAngles wrong = a;
    wrong.roll_rad += to_rad(20);
    seen += turn.judge(site.pose(a, wrong)).agrees ? 0 : 1;
  }
  EXPECT_EQ(doubted, 0);
  // A turn about the field itself changes no reading: a few attitudes hide most of their 20 degrees.
  EXPECT_GE(seen, kTrials * 8 / 10);
}

TEST(RotationConsistency, SaysByHowMuchAndAgainstWhichPose) {
  Site site(5);
  RotationConsistency turn;
  for (int k = 0; k < 5; ++k) {
    const TableAngles a = site.attitude();
    turn.add(site.pose(a, a));
  }
  const TableAngles truth{0, 0, 0}, entered{0, to_rad(90), 0};
  const auto judged = turn.judge(site.pose(truth, entered));
  EXPECT_FALSE(judged.agrees);
  EXPECT_GE(judged.against, 1);
  EXPECT_LE(judged.against, 5);
  EXPECT_GT(std::abs(judged.measured_rad - judged.entered_rad), to_rad(10));
}

TEST(RotationConsistency, TheFirstPoseHasNothingToDisagreeWith) {
  Site site(6);
  EXPECT_TRUE(RotationConsistency{}.judge(site.pose({}, {1, 1, 1})).agrees);
}

TEST(Mounting, ComposesAsTheFieldDoes) {
  Site site(9);
  for (int k = 0; k < 200; ++k) {
    const TableAngles mount = k % 4 == 0 ? TableAngles{0, to_rad(90), 0} : site.attitude(),
                      table = site.attitude();
    const auto rotation = [](const TableAngles& a) {
      return calib::sensor::table_rotation(a.azimuth_rad, a.pitch_rad, a.roll_rad, 0.0, 0.0);
    };
    const double worst =
        (rotation(plan::platform_angles(mount, table)) - rotation(mount) * rotation(table)).norm();
    EXPECT_LT(worst, 3e-6);  // at a pitch of 90 deg the two axes are told apart to a millionth
  }
}

TEST(Mounting, LevelArrayKeepsTheTablesAngles) {
  const TableAngles table{to_rad(33), to_rad(-12), to_rad(70)}, both = plan::platform_angles({}, table);
  EXPECT_NEAR(both.azimuth_rad, table.azimuth_rad, 1e-12);
  EXPECT_NEAR(both.pitch_rad, table.pitch_rad, 1e-12);
  EXPECT_NEAR(both.roll_rad, table.roll_rad, 1e-12);
}

}  // namespace
}  // namespace mgtd::daemon::run
