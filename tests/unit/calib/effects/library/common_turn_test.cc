// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/library/common_turn.h"

#include <gtest/gtest.h>

#include "calib/effects/library/library.h"

namespace mgtd::calib::effects::library {
namespace {

Eigen::MatrixXd turn_of(const std::string& spec, int sensors) {
  return turn_of_first_sensor(**make_effect(spec, sensors), sensors);
}

TEST(CommonTurn, IsTheAntisymmetricPartOfTheAngles) {
  const Eigen::MatrixXd turn = turn_of("axis.orthogonality.temperature@each-axis", 1);
  // xy, xz, yx, yz, zx, zy
  const Eigen::MatrixXd expected{{0, 0, 0, -0.5, 0, 0.5}, {0, 0.5, 0, 0, -0.5, 0}, {-0.5, 0, 0.5, 0, 0, 0}};
  EXPECT_EQ(turn, expected);
}

TEST(CommonTurn, OfSeveralSensorsIsThatOfTheFirst) {
  const Eigen::MatrixXd turn = turn_of("axis.orthogonality.temperature2@each-axis", 4);
  EXPECT_EQ(turn.cols(), 24);
  EXPECT_EQ(turn.leftCols(6), turn_of("axis.orthogonality.temperature2@each-axis", 1));
  EXPECT_TRUE(turn.rightCols(18).isZero(0));
  const Eigen::MatrixXd bending = turn_of("platform.thermal-bending", 4);
  EXPECT_EQ(bending.leftCols(3), Eigen::MatrixXd::Identity(3, 3));
  EXPECT_TRUE(bending.rightCols(9).isZero(0));
}

TEST(CommonTurn, IsNoneOfWhatCannotTurnAllSensors) {
  for (const char* spec : {"axis.orthogonality.temperature@s2", "axis.orthogonality.temperature@s1.x",
                           "axis.orthogonality.temperature@all", "axis.gain.temperature@each-axis",
                           "platform.thermal-bending@s3"})
    EXPECT_EQ(turn_of(spec, 4).size(), 0) << spec;
  EXPECT_EQ(turn_of("platform.thermal-bending", 1).size(), 0);
}

}  // namespace
}  // namespace mgtd::calib::effects::library
