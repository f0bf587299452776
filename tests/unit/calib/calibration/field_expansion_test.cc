// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration/field_expansion.h"

#include <gmock/gmock.h>

#include <Eigen/LU>

#include "calib/calibration/tensor.h"
#include "tests/unit/calib/calibration/arrays.h"

namespace mgtd::calib::calibration {
namespace {

using test::cross;
using test::cube;
using test::expansion_of;
using test::Places;
using test::tetrahedron;
using ::testing::HasSubstr;

using Flags6 = std::array<bool, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

constexpr Flags6 kNone{}, kAll{true, true, true, true, true, true};

/// Source-free, and no two components alike.
const Eigen::Matrix3d kG{{120, -35, 60}, {-35, -80, 15}, {60, 15, -40}};
const Vector6 kComponents{120, -80, -40, -35, 60, 15};
const Eigen::Vector3d kB{20'000, -3'000, 45'000};

Eigen::VectorXd readings(const Places& places, const Eigen::Matrix3d& G = kG) {
  Eigen::VectorXd b(3 * static_cast<Eigen::Index>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i)
    b.segment<3>(3 * static_cast<Eigen::Index>(i)) = kB + G * places[i];
  return b;
}

Eigen::MatrixXd projector(const Eigen::MatrixXd& orthonormal_rows) {
  return orthonormal_rows.transpose() * orthonormal_rows;
}

/// Orthonormal, perpendicular to every field of the model, in echelon form.
void expect_closure(const FieldExpansion& array, Eigen::Index dof) {
  const Eigen::MatrixXd& C = array.closure_rows();
  ASSERT_EQ(array.closure_dof(), dof);
  ASSERT_EQ(C.cols(), array.channels());
  EXPECT_EQ(array.rank() + dof, array.channels());
  EXPECT_TRUE((C * C.transpose()).isIdentity(1e-13));
  EXPECT_LT((C * array.field_rows().transpose()).norm(), 1e-13);
  Eigen::Index zeros = -1;
  for (const auto& row : C.rowwise()) {
    Eigen::Index first = 0;
    while (first < row.size() && std::abs(row[first]) < 1e-12) ++first;
    EXPECT_GT(first, zeros);
    EXPECT_GT(row[first], 0);
    zeros = first;
  }
}

/// Field, components and closure of a linear field, whose components are all determined.
void expect_whole(const Places& places, Eigen::Index dof) {
  const FieldExpansion array = expansion_of(places);
  const Eigen::VectorXd b = readings(places);
  EXPECT_EQ(array.rank(), 8);
  EXPECT_EQ(array.determined(), kAll);
  ASSERT_TRUE(array.field_at_origin());
  EXPECT_LT((array.field_rows() * b - kB).norm(), 1e-9);
  EXPECT_LT((array.gradient_rows() * b - kComponents).norm(), 1e-9);
  ASSERT_EQ(array.derivatives_along().size(), 3U);
  for (const DirectionalDerivative& along : array.derivatives_along())
    EXPECT_LT((along.rows * b - kG * along.direction_P).norm(), 1e-9);
  EXPECT_LT((array.closure_rows() * b).norm(), 1e-9);
  expect_closure(array, dof);
}

TEST(FieldExpansion, OneSensorTellsTheFieldWhereItIs) {
  for (const Eigen::Vector3d& r : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0.1, 0.2, -0.3)}) {
    const FieldExpansion array = expansion_of({r});
    EXPECT_EQ(array.rank(), 3);
    EXPECT_EQ(array.field_at_origin(), r.isZero());
    EXPECT_EQ(array.field_place_P_m(), r);
    EXPECT_TRUE(array.field_rows().isIdentity(1e-15));
    EXPECT_EQ(array.determined(), kNone);
    EXPECT_TRUE(array.gradient_rows().isZero(0));
    EXPECT_TRUE(array.derivatives_along().empty());
    expect_closure(array, 0);
  }
}

TEST(FieldExpansion, SensorsAtOnePlaceTellTheFieldAndCheckEachOther) {
  const FieldExpansion array = expansion_of(Places(3, {0.1, 0.2, 0.3}));
  EXPECT_EQ(array.rank(), 3);
  EXPECT_EQ(array.determined(), kNone);
  EXPECT_FALSE(array.field_at_origin());
  EXPECT_LT((array.field_rows() - Eigen::Matrix3d::Identity().replicate(1, 3) / 3).norm(), 1e-15);
  expect_closure(array, 6);
}

TEST(FieldExpansion, TwoSensorsAlongXTellTheDerivativeAlongX) {
  const FieldExpansion array = expansion_of({{0.25, 0, 0}, {-0.25, 0, 0}});
  EXPECT_EQ(array.rank(), 6);
  EXPECT_EQ(array.determined(), (Flags6{true, false, false, true, true, false}));
  Eigen::Matrix<double, 6, 6> expected;
  expected << 2, 0, 0, -2, 0, 0,  // Gxx = (b1x - b2x) / 0.5 m
      0, 0, 0, 0, 0, 0,           //
      0, 0, 0, 0, 0, 0,           //
      0, 2, 0, 0, -2, 0,          //
      0, 0, 2, 0, 0, -2,          //
      0, 0, 0, 0, 0, 0;
  EXPECT_LT((array.gradient_rows() - expected).norm(), 1e-14);
  ASSERT_EQ(array.derivatives_along().size(), 1U);
  EXPECT_EQ(array.derivatives_along()[0].direction_P, Eigen::Vector3d::UnitX());
  EXPECT_LT((array.derivatives_along()[0].rows - expected({0, 3, 4}, Eigen::all)).norm(), 1e-14);
  EXPECT_TRUE(array.field_at_origin());
  expect_closure(array, 0);
}

TEST(FieldExpansion, OnAnotherAxisOtherComponentsAreDetermined) {
  EXPECT_EQ(expansion_of({{0, 0.2, 0}, {0, -0.3, 0}}).determined(),
            (Flags6{false, true, false, true, false, true}));
  EXPECT_EQ(expansion_of({{0, 0, -0.2}, {0, 0, 0.2}}).determined(),
            (Flags6{false, false, true, false, true, true}));
}

/// The mean of three times 0.1 is not 0.1, which turns the principal axis by some 1e-17.
TEST(FieldExpansion, ALineAlongAnAxisBesideTheOriginHasExactlyThatDirection) {
  const FieldExpansion array = expansion_of({{0.1, 0.1, 0.7}, {0.1, 0.1, 0.2}, {0.1, 0.1, 0.3}});
  ASSERT_EQ(array.derivatives_along().size(), 1U);
  EXPECT_EQ(array.derivatives_along()[0].direction_P, Eigen::Vector3d::UnitZ());
}

TEST(FieldExpansion, TwoSensorsOnAnObliqueLineDetermineNoComponentButTheDerivativeAlongIt) {
  const Places places{{-0.3, -0.4, 0}, {0.3, 0.4, 0}};
  const FieldExpansion array = expansion_of(places);
  EXPECT_EQ(array.rank(), 6);
  EXPECT_EQ(array.determined(), kNone);
  EXPECT_TRUE(array.gradient_rows().isZero(0));
  ASSERT_EQ(array.derivatives_along().size(), 1U);
  const DirectionalDerivative& along = array.derivatives_along()[0];
  EXPECT_LT((along.direction_P - Eigen::Vector3d(0.6, 0.8, 0)).norm(), 1e-15);
  Eigen::Matrix<double, 3, 6> difference;
  difference << -Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity();  // over 1 m
  EXPECT_LT((along.rows - difference).norm(), 1e-14);
  EXPECT_LT((along.rows * readings(places) - kG * along.direction_P).norm(), 1e-9);
}

TEST(FieldExpansion, ALineThatMissesTheOriginGivesTheFieldAtItsCentroid) {
  const Places places{{-0.1, 0.2, 0}, {0.5, 0.2, 0}};
  const FieldExpansion array = expansion_of(places);
  EXPECT_FALSE(array.field_at_origin());
  const Eigen::Vector3d centroid(0.2, 0.2, 0);
  EXPECT_LT((array.field_place_P_m() - centroid).norm(), 1e-15);
  EXPECT_LT((array.field_rows() * readings(places) - (kB + kG * centroid)).norm(), 1e-9);
}

TEST(FieldExpansion, ALineThroughTheOriginGivesTheFieldThere) {
  const Places places{{0.1, 0, 0}, {0.5, 0, 0}};
  const FieldExpansion array = expansion_of(places);
  ASSERT_TRUE(array.field_at_origin());
  EXPECT_LT((array.field_rows() * readings(places) - kB).norm(), 1e-9);
  EXPECT_NEAR(array.field_rows()(0, 0), 1.25, 1e-13);  // extrapolated
}

TEST(FieldExpansion, ThreeSensorsOnALineCloseInTheSecondDifference) {
  const Places places{{0, 0, 0.2}, {0, 0, 0}, {0, 0, -0.2}};
  const FieldExpansion array = expansion_of(places);
  EXPECT_EQ(array.rank(), 6);
  EXPECT_EQ(array.determined(), (Flags6{false, false, true, false, true, true}));
  expect_closure(array, 3);
  const Eigen::RowVector3d second = Eigen::RowVector3d(1, -2, 1) / std::sqrt(6);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (Eigen::Index i = 0; i < 3; ++i)
      EXPECT_NEAR(array.closure_rows()(axis, 3 * i + axis), second[i], 1e-14);
  }
}

TEST(FieldExpansion, ATriangleTellsAllAndClosesInTheCurl) {
  const Places places{{0.3, 0, 0}, {0, 0.3, 0}, {0, 0, 0}};
  expect_whole(places, 1);
  // Along x s1 - s3, along y s2 - s3: dBy/dx - dBx/dy.
  Eigen::RowVectorXd curl(9);
  curl << 0, 1, 0, -1, 0, 0, 1, -1, 0;
  const Eigen::MatrixXd closure = expansion_of(places).closure_rows();
  EXPECT_LT((closure - curl / 2).norm(), 1e-14) << closure;
}

TEST(FieldExpansion, OfTheCrossIsTheClosedForm) {
  const sensor::Geometry geometry(0.5);
  const Places places = cross(0.25);
  const FieldExpansion array = expansion_of(places);
  EXPECT_LT((array.gradient_rows() - gradient_rows(geometry)).norm(), 1e-13) << array.gradient_rows();
  EXPECT_LT((array.field_rows() - Eigen::Matrix3d::Identity().replicate(1, 4) / 4).norm(), 1e-14);
  expect_whole(places, 4);
  const Eigen::MatrixXd closed_form = closure_rows(geometry).rowwise().normalized();  // orthogonal
  EXPECT_LT((projector(array.closure_rows()) - projector(closed_form)).norm(), 1e-13);
}

TEST(FieldExpansion, OfATetrahedronUsesEverySensorAlike) {
  expect_whole(tetrahedron(0.25), 4);
  const FieldExpansion array = expansion_of(tetrahedron(0.25));
  // Gxy is the mean of dBx/dy and dBy/dx, each the mean difference of two pairs 0.5 m apart.
  EXPECT_NEAR(array.gradient_rows()(3, 0), 0.5, 1e-14);
  EXPECT_NEAR(array.gradient_rows()(3, 1), 0.5, 1e-14);
  // Gxx of least squares takes the trace out of the three that are measured: 1 - 1/3 of its own, -1/3.
  EXPECT_NEAR(array.gradient_rows()(0, 0), 2.0 / 3, 1e-14);
  EXPECT_NEAR(array.gradient_rows()(0, 1), -1.0 / 3, 1e-14);
}

TEST(FieldExpansion, OfACubeHasSixteenClosureNumbers) {
  expect_whole(cube(0.25), 16);
  EXPECT_NEAR(expansion_of(cube(0.25)).gradient_rows()(3, 0), -0.25, 1e-14);
}

TEST(FieldExpansion, AnArrayBesideTheOriginExtrapolatesToIt) {
  Places places = tetrahedron(0.2);
  for (Eigen::Vector3d& r : places) r += Eigen::Vector3d(1, 2, -3);
  expect_whole(places, 4);
}

TEST(FieldExpansion, ACurlAndADivergenceDoNotClose) {
  Eigen::Matrix3d curl = kG, source = kG;
  curl(0, 1) += 10;
  source(2, 2) += 10;
  const auto left = [](const Places& places, const Eigen::Matrix3d& G) {
    return (expansion_of(places).closure_rows() * readings(places, G)).norm();
  };
  // Half of the 10 nT/m is antisymmetric, in both components: 5 sqrt(2) times the lever arm of the channels.
  EXPECT_NEAR(left(cross(0.2), curl), 5 * std::sqrt(2) * 0.2 * std::sqrt(2), 1e-9);
  EXPECT_LT(left(cross(0.2), source), 1e-9);  // a cross takes Gzz from the divergence
  // A third of it is in each of the three components of the trace.
  EXPECT_NEAR(left(tetrahedron(0.2), source), 10 / std::sqrt(3) * 0.2 * 2, 1e-9);
}

TEST(FieldExpansion, ALineIsOneToAThousandthOfItsSize) {
  const auto bent_by = [](double off_m) { return expansion_of({{0.3, 0, 0}, {0, 0, off_m}, {-0.3, 0, 0}}); };
  EXPECT_EQ(bent_by(0.2e-3).rank(), 6);
  EXPECT_EQ(bent_by(0.2e-3).closure_dof(), 3);
  EXPECT_NEAR(bent_by(0.2e-3).shape().neglected_m, 0.2e-3 * 2 / 3, 1e-9);
  EXPECT_EQ(bent_by(1e-3).rank(), 8);
  EXPECT_EQ(bent_by(1e-3).shape().neglected_m, 0);
  // The unit of length changes nothing.
  for (const double scale : {1e-2, 1e3}) {
    EXPECT_EQ(expansion_of({{0.3 * scale, 0, 0}, {0, 0, 0.2e-3 * scale}, {-0.3 * scale, 0, 0}}).rank(), 6);
    EXPECT_EQ(expansion_of({{0.3 * scale, 0, 0}, {0, 0, 1e-3 * scale}, {-0.3 * scale, 0, 0}}).rank(), 8);
  }
}

TEST(FieldExpansion, RefusesNoSensorTooManyAndPlacesThatAreNone) {
  EXPECT_THAT(FieldExpansion::of(Places{}).error().text(), HasSubstr("1 to 16 sensors, not 0"));
  EXPECT_THAT(FieldExpansion::of(Places(17, {0, 0, 0})).error().text(), HasSubstr("not 17"));
  EXPECT_TRUE(FieldExpansion::of(Places(16, {0, 0, 0})).has_value());
  EXPECT_THAT(FieldExpansion::of(Places{{0, 0, 0}, {0, std::nan(""), 1}}).error().text(),
              HasSubstr("the place of s2 is (0, nan, 1) m"));
}

TEST(WeightedExpansion, OfEqualNoiseIsThePlainOne) {
  for (const Places& places : {Places{{0.1, 0, 0}}, Places{{0.3, 0.4, 0.1}, {-0.1, 0.2, 0}}, cross(0.2),
                               tetrahedron(0.3), cube(0.1)}) {
    const FieldExpansion array = expansion_of(places);
    const auto weighted =
        array.weighted(0.09 * Eigen::MatrixXd::Identity(array.channels(), array.channels()));
    ASSERT_TRUE(weighted);
    EXPECT_LT((weighted->field - array.field_rows()).norm(), 1e-13);
    EXPECT_LT((weighted->gradient - array.gradient_rows()).norm(), 1e-12);
    EXPECT_LT((weighted->covariance.topLeftCorner<3, 3>() -
               0.09 * array.field_rows() * array.field_rows().transpose())
                  .norm(),
              1e-13);
    ASSERT_EQ(weighted->derivatives.size(), array.derivatives_along().size());
    for (std::size_t k = 0; k < weighted->derivatives.size(); ++k)
      EXPECT_LT((weighted->derivatives[k].rows - array.derivatives_along()[k].rows).norm(), 1e-12);
  }
}

/// Against the textbook's normal equations, (D' C^-1 D)^-1 D' C^-1, with D written out here.
TEST(WeightedExpansion, IsTheGeneralisedLeastSquaresEstimate) {
  Places places = tetrahedron(0.3);
  places.push_back({0.1, -0.2, 0.4});
  const FieldExpansion array = expansion_of(places);
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(15, 8);
  for (Eigen::Index i = 0; i < 5; ++i) {
    const Eigen::Vector3d& r = places[static_cast<std::size_t>(i)];
    D.middleRows<3>(3 * i) << 1, 0, 0, r.x(), 0, r.y(), r.z(), 0,  // Bx: xx, yy, xy, xz, yz
        0, 1, 0, 0, r.y(), r.x(), 0, r.z(),                        //
        0, 0, 1, -r.z(), -r.z(), 0, r.x(), r.y();
  }
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(15, 15);
  for (Eigen::Index k = 0; k < 15; ++k) {
    C(k, k) = 1 + 0.5 * static_cast<double>(k);
    if (k > 0) C(k, k - 1) = C(k - 1, k) = 0.3;
  }
  const Eigen::MatrixXd information = D.transpose() * C.inverse() * D;
  const Eigen::MatrixXd covariance = information.inverse();
  const Eigen::MatrixXd rows = covariance * D.transpose() * C.inverse();
  const auto weighted = array.weighted(C);
  ASSERT_TRUE(weighted);
  EXPECT_LT((weighted->field - rows.topRows(3)).norm(), 1e-11);
  EXPECT_LT((weighted->gradient({0, 1, 3, 4, 5}, Eigen::all) - rows.bottomRows(5)).norm(), 1e-11);
  EXPECT_LT((weighted->gradient.row(2) + rows.row(3) + rows.row(4)).norm(), 1e-11);
  const std::array<Eigen::Index, 8> without_zz{0, 1, 2, 3, 4, 6, 7, 8};
  EXPECT_LT((weighted->covariance(without_zz, without_zz) - covariance).norm(), 1e-10);
  EXPECT_NEAR(weighted->covariance(5, 5), covariance(3, 3) + covariance(4, 4) + 2 * covariance(3, 4), 1e-10);
}

TEST(WeightedExpansion, ANoisySensorHardlyCounts) {
  const FieldExpansion array = expansion_of(cube(0.2));
  Eigen::VectorXd variance = Eigen::VectorXd::Ones(24);
  variance.segment<3>(9).setConstant(1e8);
  const auto weighted = array.weighted(variance.asDiagonal());
  ASSERT_TRUE(weighted);
  EXPECT_LT(weighted->gradient.middleCols<3>(9).norm(), 1e-6);
  EXPECT_GT(array.gradient_rows().middleCols<3>(9).norm(), 0.5);
  const Eigen::MatrixXd plain =
      array.gradient_rows() * variance.asDiagonal() * array.gradient_rows().transpose();
  for (Eigen::Index c = 0; c < 6; ++c) EXPECT_LT(weighted->covariance(3 + c, 3 + c), plain(c, c) / 1000);
  EXPECT_LT((weighted->gradient * readings(cube(0.2)) - kComponents).norm(), 1e-8);
}

TEST(WeightedExpansion, RefusesACovarianceOfAnotherSizeOrWithoutNoise) {
  const FieldExpansion array = expansion_of(cross(0.2));
  EXPECT_THAT(array.weighted(Eigen::MatrixXd::Identity(9, 9)).error().text(), HasSubstr("9 x 9"));
  Eigen::MatrixXd C = Eigen::MatrixXd::Identity(12, 12);
  C(5, 5) = 0;
  EXPECT_THAT(array.weighted(C).error().text(), HasSubstr("not positive definite"));
  C(5, 5) = std::nan("");
  EXPECT_FALSE(array.weighted(C));
}

}  // namespace
}  // namespace mgtd::calib::calibration
