// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "daemon/plan/random_source.h"
#include "tests/unit/calib/calibration/arrays.h"

/// What holds for every array: one to sixteen sensors at one place, on a line, in a plane, in space.
namespace mgtd::calib::calibration {
namespace {

using daemon::plan::RandomSource;
using test::expansion_of;
using test::Places;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Places on a grid, so that rank and direction follow from whole numbers, without rounding.
struct GridArray {
  std::vector<Eigen::Vector3i> at;

  static constexpr double kStep_m = 0.05;

  [[nodiscard]] Places places_m() const {
    Places out;
    for (const Eigen::Vector3i& p : at) out.emplace_back(kStep_m * p.cast<double>());
    return out;
  }
  /// From the first sensor to one that is elsewhere; zero where there is none.
  [[nodiscard]] Eigen::Vector3i line() const {
    for (const Eigen::Vector3i& p : at) {
      if (p != at[0]) return p - at[0];
    }
    return Eigen::Vector3i::Zero();
  }
  [[nodiscard]] bool on_a_line() const {
    return std::all_of(at.begin(), at.end(),
                       [&](const Eigen::Vector3i& p) { return line().cross(p - at[0]).isZero(); });
  }
  [[nodiscard]] Eigen::Index rank() const {
    if (line().isZero()) return 3;
    return on_a_line() ? 6 : 8;
  }
  /// Of a line: G_ab is in G u only where u is the axis a or the axis b.
  [[nodiscard]] std::array<bool, 6> determined() const {
    const auto along = [&](int axis) {
      Eigen::Vector3i others = line();
      others[axis] = 0;
      return others.isZero();
    };
    if (rank() == 3) return {};
    if (rank() == 8) return {true, true, true, true, true, true};
    const bool x = along(0), y = along(1), z = along(2);
    return {x, y, z, x || y, x || z, y || z};
  }
};

/// From the whole range in the first case too: rapidcheck begins with cases that are nearly zero.
rc::Gen<int> whole_number(int least, int largest) {
  return rc::gen::resize(rc::kNominalSize, rc::gen::inRange(least, largest + 1));
}

Eigen::Vector3i small_vector(int largest) {
  const auto component = whole_number(-largest, largest);
  const int x = *component, y = *component, z = *component;
  return {x, y, z};
}

GridArray any_array() {
  const int n = *whole_number(1, 16), dimension = *whole_number(0, 3);
  const Eigen::Vector3i base = small_vector(4), u = small_vector(2), v = small_vector(2);
  const auto step = whole_number(-2, 2);
  GridArray out;
  for (int i = 0; i < n; ++i) {
    Eigen::Vector3i p = base;
    if (dimension == 3) p = small_vector(6);
    if (dimension >= 1) p += *step * u;
    if (dimension >= 2) p += *step * v;
    out.at.push_back(p);
  }
  return out;
}

double any_number() { return *whole_number(-1000, 1000) * 0.1; }

Eigen::Vector3d any_vector() {
  const double x = any_number(), y = any_number(), z = any_number();
  return {x, y, z};
}

Vector6 any_gradient() {
  Vector6 g;
  for (double& component : g) component = any_number();
  g[2] = -g[0] - g[1];
  return g;
}

Eigen::Matrix3d tensor_of(const Vector6& g) {
  return Eigen::Matrix3d{{g[0], g[3], g[4]}, {g[3], g[1], g[5]}, {g[4], g[5], g[2]}};
}

Eigen::VectorXd linear_field(const Places& places, const Eigen::Vector3d& B, const Eigen::Matrix3d& G) {
  Eigen::VectorXd b(3 * static_cast<Eigen::Index>(places.size()));
  for (std::size_t i = 0; i < places.size(); ++i)
    b.segment<3>(3 * static_cast<Eigen::Index>(i)) = B + G * places[i];
  return b;
}

Eigen::VectorXd any_readings(const Places& places) {
  Eigen::VectorXd b(3 * static_cast<Eigen::Index>(places.size()));
  for (double& reading : b) reading = any_number();
  return b;
}

/// By Box and Muller.
double normal(RandomSource& random) {
  const double u = 1 - random.uniform(), v = random.uniform();
  return std::sqrt(-2 * std::log(u)) * std::cos(2 * std::numbers::pi * v);
}

/// Fields of some 100 nT, levers of some 0.01 to 1 m.
constexpr double kRounding_nT = 1e-9, kRounding_nT_per_m = 1e-7;

void assert_tells(const FieldExpansion& array, const ExpansionEstimate& by, const Eigen::VectorXd& b,
                  const Eigen::Vector3d& B, const Vector6& g) {
  const Eigen::Matrix3d G = tensor_of(g);
  RC_ASSERT((by.field * b - B - G * array.field_place_P_m()).norm() < kRounding_nT);
  const Vector6 got = by.gradient * b;
  for (Eigen::Index c = 0; c < 6; ++c) {
    const double expected = array.determined()[static_cast<std::size_t>(c)] ? g[c] : 0;
    RC_ASSERT(std::abs(got[c] - expected) < kRounding_nT_per_m);
  }
  for (const DirectionalDerivative& along : by.derivatives)
    RC_ASSERT((along.rows * b - G * along.direction_P).norm() < kRounding_nT_per_m);
}

TEST(AnyArray, ALinearFieldGivesItsGradientWhereItIsDeterminedAndCloses) {
  EXPECT_TRUE(rc::check([] {
    const GridArray grid = any_array();
    const Places places = grid.places_m();
    const FieldExpansion array = expansion_of(places);
    RC_ASSERT(array.rank() == grid.rank());
    RC_ASSERT(array.determined() == grid.determined());
    RC_ASSERT(array.closure_dof() == array.channels() - grid.rank());
    const std::size_t directions = grid.rank() == 3 ? 0 : grid.rank() == 6 ? 1 : 3;
    RC_ASSERT(array.derivatives_along().size() == directions);
    if (grid.rank() == 6) {
      const Eigen::Vector3d line = grid.line().cast<double>().normalized();
      RC_ASSERT(std::abs(std::abs(line.dot(array.derivatives_along()[0].direction_P)) - 1) < 1e-12);
    }
    const Eigen::Vector3d B = any_vector();
    const Vector6 g = any_gradient();
    const Eigen::VectorXd b = linear_field(places, B, tensor_of(g));
    assert_tells(array, array.plain(), b, B, g);
    RC_ASSERT((array.closure_rows() * b).norm() < kRounding_nT);
  }));
}

TEST(AnyArray, AUniformFieldHasNoGradientAndCloses) {
  EXPECT_TRUE(rc::check([] {
    const Places places = any_array().places_m();
    const FieldExpansion array = expansion_of(places);
    const Eigen::Vector3d B = any_vector();
    const Eigen::VectorXd b = linear_field(places, B, Eigen::Matrix3d::Zero());
    RC_ASSERT((array.field_rows() * b - B).norm() < kRounding_nT);
    RC_ASSERT((array.gradient_rows() * b).norm() < kRounding_nT_per_m);
    for (const DirectionalDerivative& along : array.derivatives_along())
      RC_ASSERT((along.rows * b).norm() < kRounding_nT_per_m);
    RC_ASSERT((array.closure_rows() * b).norm() < kRounding_nT);
  }));
}

TEST(AnyArray, OtherNumbersOfTheSensorsPermuteTheColumns) {
  EXPECT_TRUE(rc::check([] {
    const Places places = any_array().places_m();
    std::vector<std::size_t> order(places.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    RandomSource random(*rc::gen::arbitrary<std::uint64_t>());
    random.shuffle(order);
    Places permuted;
    for (const std::size_t i : order) permuted.push_back(places[i]);
    const FieldExpansion before = expansion_of(places), after = expansion_of(permuted);
    const Eigen::MatrixXd closure_before = before.closure_rows().transpose() * before.closure_rows();
    const Eigen::MatrixXd closure_after = after.closure_rows().transpose() * after.closure_rows();
    for (std::size_t i = 0; i < order.size(); ++i) {
      const auto from = 3 * static_cast<Eigen::Index>(order[i]), to = 3 * static_cast<Eigen::Index>(i);
      RC_ASSERT((after.field_rows().middleCols<3>(to) - before.field_rows().middleCols<3>(from)).norm() <
                1e-9);
      RC_ASSERT(
          (after.gradient_rows().middleCols<3>(to) - before.gradient_rows().middleCols<3>(from)).norm() <
          1e-9);
      for (std::size_t k = 0; k < order.size(); ++k) {
        const auto other_from = 3 * static_cast<Eigen::Index>(order[k]),
                   other_to = 3 * static_cast<Eigen::Index>(k);
        RC_ASSERT(
            (closure_after.block<3, 3>(to, other_to) - closure_before.block<3, 3>(from, other_from)).norm() <
            1e-9);
      }
    }
  }));
}

TEST(AnyArray, TurnsWithItsFieldAndGradient) {
  EXPECT_TRUE(rc::check([] {
    const Places places = any_array().places_m();
    const Eigen::Vector3d q = small_vector(9).cast<double>();
    const Eigen::Matrix3d R = Eigen::Quaterniond(5, q.x(), q.y(), q.z()).normalized().toRotationMatrix();
    Places turned;
    for (const Eigen::Vector3d& r : places) turned.emplace_back(R * r);
    const FieldExpansion before = expansion_of(places), after = expansion_of(turned);
    const Eigen::VectorXd b = any_readings(places);
    Eigen::VectorXd turned_b = b;
    for (Eigen::Index i = 0; i < before.sensors(); ++i) turned_b.segment<3>(3 * i) = R * b.segment<3>(3 * i);
    RC_ASSERT(after.rank() == before.rank());
    RC_ASSERT((after.field_place_P_m() - R * before.field_place_P_m()).norm() < 1e-12);
    RC_ASSERT((after.field_rows() * turned_b - R * (before.field_rows() * b)).norm() < kRounding_nT_per_m);
    if (before.rank() == 8) {
      const Eigen::Matrix3d G = tensor_of(before.gradient_rows() * b);
      const Eigen::Matrix3d turned_G = tensor_of(after.gradient_rows() * turned_b);
      RC_ASSERT((turned_G - R * G * R.transpose()).norm() < kRounding_nT_per_m);
    } else if (before.rank() == 6) {
      const DirectionalDerivative& along = before.derivatives_along()[0];
      const DirectionalDerivative& turned_along = after.derivatives_along()[0];
      const double sign = turned_along.direction_P.dot(R * along.direction_P);  // -1 or 1
      RC_ASSERT(std::abs(std::abs(sign) - 1) < 1e-12);
      RC_ASSERT((sign * (turned_along.rows * turned_b) - R * (along.rows * b)).norm() < kRounding_nT_per_m);
    }
    RC_ASSERT(std::abs((after.closure_rows() * turned_b).norm() - (before.closure_rows() * b).norm()) <
              kRounding_nT_per_m);
  }));
}

TEST(AnyArray, MovedAsAWholeHasTheSameGradientAndClosure) {
  EXPECT_TRUE(rc::check([] {
    const Places places = any_array().places_m();
    const Eigen::Vector3d by = 0.01 * any_vector();  // within a metre
    Places moved;
    for (const Eigen::Vector3d& r : places) moved.emplace_back(r + by);
    const FieldExpansion before = expansion_of(places), after = expansion_of(moved);
    RC_ASSERT(after.determined() == before.determined());
    RC_ASSERT((after.gradient_rows() - before.gradient_rows()).norm() < 1e-9);
    RC_ASSERT(after.closure_dof() == before.closure_dof());
    RC_ASSERT((after.closure_rows() - before.closure_rows()).norm() < 1e-9);
  }));
}

TEST(AnyArray, WhiteNoiseGivesIndependentClosureNumbersAndTheirChiSquare) {
  EXPECT_TRUE(rc::check([] {
    const FieldExpansion array = expansion_of(any_array().places_m());
    const auto dof = static_cast<double>(array.closure_dof());
    RC_PRE(dof > 0);
    const Eigen::MatrixXd& C = array.closure_rows();
    RC_ASSERT((C * C.transpose()).isIdentity(1e-12));
    RandomSource random(*rc::gen::arbitrary<std::uint64_t>());
    constexpr int kDraws = 1000;
    constexpr double kNoise_nT = 0.3;
    Eigen::VectorXd noise(array.channels());
    double sum = 0, squares = 0;
    for (int k = 0; k < kDraws; ++k) {
      for (double& channel : noise) channel = kNoise_nT * normal(random);
      const double chi2 = (C * noise).squaredNorm() / (kNoise_nT * kNoise_nT);
      sum += chi2;
      squares += (chi2 - dof) * (chi2 - dof);
    }
    // Mean dof and variance 2 dof; six standard deviations of each, for a hundred arrays.
    RC_ASSERT(std::abs(sum / kDraws - dof) < 6 * std::sqrt(2 * dof / kDraws));
    RC_ASSERT(std::abs(squares / kDraws / (2 * dof) - 1) < 6 * std::sqrt((2 + 12 / dof) / kDraws));
  }));
}

TEST(AnyArray, WeightedItIsStillExactAndNeverLessCertain) {
  EXPECT_TRUE(rc::check([] {
    const Places places = any_array().places_m();
    const FieldExpansion array = expansion_of(places);
    Eigen::VectorXd variance(array.channels());
    for (double& channel : variance) channel = *whole_number(1, 100) * 0.01;
    const Eigen::MatrixXd covariance = variance.asDiagonal();
    const auto weighted = array.weighted(covariance);
    RC_ASSERT(weighted.has_value());
    const Eigen::Vector3d B = any_vector();
    const Vector6 g = any_gradient();
    assert_tells(array, *weighted, linear_field(places, B, tensor_of(g)), B, g);
    Eigen::Matrix<double, 9, Eigen::Dynamic> rows(9, array.channels());
    rows << array.field_rows(), array.gradient_rows();
    const Eigen::Matrix<double, 9, 1> plain = (rows * covariance * rows.transpose()).diagonal();
    for (Eigen::Index k = 0; k < 9; ++k) RC_ASSERT(weighted->covariance(k, k) <= plain[k] * (1 + 1e-9));
  }));
}

}  // namespace
}  // namespace mgtd::calib::calibration
