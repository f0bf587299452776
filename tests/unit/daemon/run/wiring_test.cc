// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/wiring.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <random>

#include "calib/sensor/sensor_equations.h"

namespace mgtd::daemon::run {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Four raw sensors, misaligned by up to three degrees and with offsets of a percent, on a table.
struct Array {
  PerSensor<Matrix3d> S{Matrix3d::Identity(), Matrix3d::Identity(), Matrix3d::Identity(),
                        Matrix3d::Identity()};
  Vector3d b_S_nT{26'000, -2'300, 46'000};
  std::mt19937_64 random{5};
  PerSensor<Matrix3d> tilt;
  PerSensor<Vector3d> offset_nT;

  Array() {
    std::uniform_real_distribution<double> about(-1, 1);
    for (std::size_t i = 0; i < kSensors; ++i) {
      const Vector3d axis(about(random), about(random), about(random));
      tilt[i] = Eigen::AngleAxisd(to_rad(3), axis.normalized()).toRotationMatrix();
      offset_nT[i] = 500 * Vector3d(about(random), about(random), about(random));
    }
  }
  [[nodiscard]] PerSensor<Vector3d> at(const TableAngles& a) const {
    const Matrix3d R = calib::sensor::table_rotation(a.azimuth_rad, a.pitch_rad, a.roll_rad, 0.0, 0.0);
    PerSensor<Vector3d> y;
    for (std::size_t i = 0; i < kSensors; ++i) y[i] = S[i] * (tilt[i] * (R * b_S_nT)) + offset_nT[i];
    return y;
  }
  /// Turned about the vertical only.
  [[nodiscard]] Wiring turned(int poses = 6, double sense = 1) const {
    Wiring wiring;
    for (int i = 0; i < poses; ++i) {
      const TableAngles angles{to_rad(40.0 * i), 0, 0};
      wiring.add(at(angles), TableAngles{sense * angles.azimuth_rad, 0, 0});
    }
    return wiring;
  }
};

Matrix3d diagonal(double x, double y, double z) { return Vector3d(x, y, z).asDiagonal(); }

TEST(WiringTest, FourAlikeAreFourAlike) {
  const Array array;
  EXPECT_THAT(array.turned().findings(), IsEmpty());
  EXPECT_THAT(array.turned(1).findings(), IsEmpty());
}

TEST(WiringTest, EachMirroredAndTurnedSensorIsNamedAfterAFewTurns) {
  Array array;
  array.S[2] = diagonal(1, -1, 1);
  // Its x axis points along Y: what it reads as x is the field's y.
  array.S[1] << 0, 1, 0, -1, 0, 0, 0, 0, 1;
  EXPECT_THAT(array.turned().findings(),
              ElementsAre("s2: turned by 90 deg about z", "s3: mirrored (left-handed axes: y reversed)"));
}

TEST(WiringTest, AllFortyEightWaysAreToldApartByTurnsAndTilts) {
  Array array;
  std::array<int, 3> p{0, 1, 2};
  int ways = 0;
  do {
    for (int signs = 0; signs < 8; ++signs, ++ways) {
      Matrix3d S = Matrix3d::Zero();
      for (int row = 0; row < 3; ++row)
        S(row, p[static_cast<std::size_t>(row)]) = (signs >> row) % 2 == 0 ? 1 : -1;
      array.S[3] = S;
      Wiring wiring = array.turned();
      wiring.add(array.at({0, to_rad(60), 0}), TableAngles{0, to_rad(60), 0});
      if (S.isIdentity()) {
        EXPECT_THAT(wiring.findings(), IsEmpty());
      } else {
        EXPECT_THAT(wiring.findings(), ElementsAre("s4: " + in_words(S)));
        EXPECT_THAT(in_words(S), HasSubstr(S.determinant() < 0 ? "mirrored" : "turned"));
      }
    }
  } while (std::next_permutation(p.begin(), p.end()));
  EXPECT_EQ(ways, 48);
}

TEST(WiringTest, OneAttitudeClaimsNoMoreThanItShows) {
  Array array;
  array.b_S_nT = {10'000, 10'500, 45'000};  // x and y look alike
  array.S[0] << 0, 1, 0, -1, 0, 0, 0, 0, 1;
  EXPECT_THAT(array.turned(1).findings(),
              ElementsAre("s1: turned or mirrored; which, further attitudes will tell"));
  array.S[0] << 0, 1, 0, 1, 0, 0, 0, 0, 1;  // x and y swapped: here it reads as the others
  EXPECT_THAT(array.turned(1).findings(), IsEmpty());
  EXPECT_THAT(array.turned().findings(), ElementsAre("s1: mirrored (left-handed axes: x and y swapped)"));
}

TEST(WiringTest, OneSensorIsComparedWithTheTableAlone) {
  const Array array;
  const auto turned = [&](double sense) {
    Wiring wiring;
    for (int i = 0; i < 6; ++i) {
      const TableAngles angles{to_rad(40.0 * i), 0, 0};
      wiring.add({array.at(angles)[0]}, TableAngles{sense * angles.azimuth_rad, 0, 0});
    }
    return wiring.findings();
  };
  EXPECT_THAT(turned(1), IsEmpty());
  EXPECT_THAT(turned(-1), ElementsAre(HasSubstr("against the table")));
  EXPECT_THAT(alike_in_words(1), HasSubstr("no other to compare it with"));
}

TEST(WiringTest, TheMirroredOneOfSixIsNamed) {
  Array array;
  array.S[2] = diagonal(1, -1, 1);
  Wiring wiring;
  for (int i = 0; i < 6; ++i) {
    const TableAngles angles{to_rad(40.0 * i), 0, 0};
    const PerSensor<Vector3d> y = array.at(angles);
    wiring.add({y[0], y[1], y[0], y[3], y[1], y[2]}, angles);
  }
  EXPECT_THAT(wiring.findings(), ElementsAre("s6: mirrored (left-handed axes: y reversed)"));
}

TEST(WiringTest, AnAzimuthThatCountsTheOtherWayIsSaidOfTheTable) {
  const Array array;
  EXPECT_THAT(array.turned(6, -1).findings(), ElementsAre(HasSubstr("against the table")));
}

TEST(WiringTest, ASensorThatReadsAnotherFieldIsNoMatterOfMounting) {
  Array array;
  array.S[1] = 0.3 * Matrix3d::Identity();
  EXPECT_THAT(array.turned().findings(), ElementsAre(HasSubstr("s2: reads another field")));
}

}  // namespace
}  // namespace mgtd::daemon::run
