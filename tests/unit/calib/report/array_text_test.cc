// SPDX-License-Identifier: Apache-2.0
#include "calib/report/array_text.h"

#include <gmock/gmock.h>

#include "tests/unit/calib/calibration/arrays.h"

namespace mgtd::calib::report {
namespace {

using calibration::test::cross;
using calibration::test::cube;
using calibration::test::expansion_of;
using calibration::test::Places;
using calibration::test::tetrahedron;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

std::string told_by(const Places& places) { return what_it_tells(expansion_of(places)); }

TEST(ArrayText, OneSensor) {
  EXPECT_EQ(told_by({{0, 0, 0}}),
            "field only: one sensor sees no gradient; 0 closure numbers: nothing checks a sample");
  EXPECT_THAT(told_by({{0.1, 0, -0.25}}),
              StartsWith("field at s1, (0.1, 0, -0.25) m, only: one sensor sees no gradient"));
}

TEST(ArrayText, SensorsAtOnePlace) {
  EXPECT_EQ(
      told_by(Places(3, {0, 0, 0})),
      "field only: sensors at one place (s1 to s3) see no gradient; 6 closure numbers check every sample "
      "(6 for sensors that disagree)");
}

TEST(ArrayText, TwoSensorsOnAnAxis) {
  EXPECT_EQ(
      told_by({{0.2, 0, 0}, {-0.2, 0, 0}}),
      "field and the derivative along the line through s1 and s2 (x axis): Gxx, Gxy, Gxz; the rest of the "
      "gradient cannot be told by sensors on one line; 0 closure numbers: nothing checks a sample");
  EXPECT_THAT(told_by({{0, 0, 0.2}, {0, 0, -0.2}}), HasSubstr("(z axis): Gzz, Gxz, Gyz;"));
}

TEST(ArrayText, TwoSensorsOnAnObliqueLineBesideTheOrigin) {
  EXPECT_EQ(
      told_by({{0.6, 0.9, 0}, {0, 0.1, 0}}),
      "field at the centroid of the sensors, (0.3, 0.5, 0) m, and the derivative along the line through "
      "s1 and s2 (direction (0.6, 0.8, 0)): three combinations of the gradient's components, and no "
      "component by itself; the rest of the gradient cannot be told by sensors on one line; 0 closure "
      "numbers: nothing checks a sample");
}

TEST(ArrayText, ThreeSensorsNearlyOnALine) {
  const std::string text = told_by({{0, 0.3, 0}, {0, 0, 0.0003}, {0, -0.3, 0}});
  EXPECT_THAT(text, HasSubstr("through s1 to s3 (y axis): Gyy, Gxy, Gyz;"));
  EXPECT_THAT(text, HasSubstr("sensors stand up to 0.2 mm off that line, which is neglected"));
  EXPECT_THAT(text, EndsWith("3 closure numbers check every sample (3 for a change that is not linear)"));
  EXPECT_THAT(told_by({{0, 0.3, 0}, {0, 0, 0}, {0, -0.3, 0}}), Not(HasSubstr("neglected")));
}

TEST(ArrayText, ATriangle) {
  EXPECT_THAT(told_by({{0.3, 0, 0}, {0, 0.3, 0}, {0, 0, 0}}),
              EndsWith("1 closure number checks every sample (1 for a curl)"));
}

TEST(ArrayText, TheCross) {
  EXPECT_EQ(
      told_by(cross(0.2)),
      "field and all five independent components of the gradient; the sensors do not stand apart in z, so "
      "Gzz is not measured and follows from the vanishing divergence; Gxy is measured twice and checks "
      "itself; 4 closure numbers check every sample (1 for a curl, 3 for a change that is not linear)");
}

/// What the sentence says of a planar array, in its rows.
TEST(ArrayText, IsTrueOfTheRowsOfTheCross) {
  const auto array = expansion_of(cross(0.2));
  const auto weight = [&](Eigen::Index component, Eigen::Index axis) {
    double sum = 0;
    for (Eigen::Index i = 0; i < array.sensors(); ++i)
      sum += std::abs(array.gradient_rows()(component, 3 * i + axis));
    return sum;
  };
  EXPECT_LT(weight(2, 2), 1e-13);  // no z channel in Gzz
  EXPECT_GT(weight(3, 0), 1);      // Gxy by dBx/dy ...
  EXPECT_GT(weight(3, 1), 1);      // ... and by dBy/dx
  EXPECT_LT(weight(4, 0), 1e-13);  // Gxz by dBz/dx alone
}

TEST(ArrayText, AnUprightAndAnObliquePlane) {
  Places upright, oblique;
  for (const Eigen::Vector3d& r : cross(0.2)) {
    upright.emplace_back(r.x(), 0, r.y());
    oblique.emplace_back(r.x(), 0.6 * r.y(), 0.8 * r.y());
  }
  EXPECT_THAT(told_by(upright), HasSubstr("do not stand apart in y, so Gyy is not measured"));
  EXPECT_THAT(told_by(upright), HasSubstr("Gxz is measured twice and checks itself"));
  EXPECT_THAT(told_by(oblique),
              HasSubstr("the sensors lie in one plane, so the derivative along its normal"));
  EXPECT_THAT(told_by(oblique), Not(HasSubstr("twice")));
}

TEST(ArrayText, ArraysInSpace) {
  EXPECT_EQ(
      told_by(tetrahedron(0.2)),
      "field and all five independent components of the gradient; Gxy, Gxz and Gyz are measured twice and "
      "check themselves; 4 closure numbers check every sample (3 for a curl, 1 for a divergence)");
  EXPECT_THAT(told_by(cube(0.2)), EndsWith("16 closure numbers check every sample (3 for a curl, 1 for a "
                                           "divergence, 12 for a change that is not linear)"));
}

}  // namespace
}  // namespace mgtd::calib::report
