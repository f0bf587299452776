// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/product.h"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>

namespace mgtd::calib::linear {
namespace {

/// Entries without any pattern that a transposed or shifted product would repeat.
Eigen::MatrixXd some(Eigen::Index rows, Eigen::Index cols, double phase) {
  return Eigen::MatrixXd::NullaryExpr(rows, cols, [=](Eigen::Index i, Eigen::Index j) {
    return std::sin(phase + 1.7 * static_cast<double>(i * i) + 0.9 * static_cast<double>(j));
  });
}

constexpr double kRounding = 1e-12;

TEST(Product, GramIsTheProductOfTheColumns) {
  const Eigen::MatrixXd A = some(70, 33, 0.3);
  EXPECT_TRUE(gram(A).isApprox(A.transpose() * A, kRounding));
  EXPECT_EQ(gram(A), gram(A).transpose().eval());
}

TEST(Product, GramsOfPartsAddUp) {
  const Eigen::MatrixXd A = some(70, 33, 0.3);
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(33, 33);
  add_gram(A.topRows(50), G);
  add_gram(A.bottomRows(20), G);
  EXPECT_TRUE(Eigen::MatrixXd(G.triangularView<Eigen::Lower>())
                  .isApprox(Eigen::MatrixXd(gram(A).triangularView<Eigen::Lower>()), kRounding));
}

/// Small and large first factors, and columns that are no multiple of those taken together.
TEST(Product, RowByRowIsTheSameProduct) {
  for (const Eigen::Index n : {3, 12})
    for (const Eigen::Index columns : {1, 8, 19}) {
      const Eigen::MatrixXd A = some(n, n + 1, 0.1), B = some(n + 1, columns, 2);
      RowByRow C(n, columns);
      set_product(A, RowByRow(B), C);
      EXPECT_TRUE(C.isApprox(A * B, kRounding)) << n << " " << columns;
    }
}

TEST(Product, TransposedTimesAnother) {
  const Eigen::MatrixXd A = some(41, 7, 0.1), B = some(41, 19, 2);
  EXPECT_TRUE(transposed_product(A, B).isApprox(A.transpose() * B, kRounding));
}

TEST(Product, PartsOfLargerMatricesAreTakenWhereTheyStand) {
  const Eigen::MatrixXd A = some(60, 12, 0.1), B = some(50, 9, 2);
  const Eigen::MatrixXd expected = A.topRows(40).transpose() * B.bottomRows(40);
  EXPECT_TRUE(transposed_product(A.topRows(40), B.bottomRows(40)).isApprox(expected, kRounding));
}

TEST(Product, IsTakenOff) {
  const Eigen::MatrixXd A = some(30, 8, 0.4), B = some(8, 21, 1), C = some(30, 21, 3);
  Eigen::MatrixXd left = C;
  subtract_product(A, B, left);
  EXPECT_TRUE(left.isApprox(C - A * B, kRounding));
}

TEST(Product, OfATriangleReadsTheTriangleOnly) {
  const Eigen::MatrixXd L = some(25, 25, 0.4), Z = some(25, 40, 1);
  const Eigen::MatrixXd expected = L.triangularView<Eigen::Lower>() * Z;
  EXPECT_TRUE(triangle_product(L, Z).isApprox(expected, kRounding));
}

TEST(Product, OfNothingIsNothing) {
  const Eigen::MatrixXd none(30, 0), B = some(30, 4, 1);
  EXPECT_EQ(gram(none).size(), 0);
  EXPECT_EQ(transposed_product(none, B).rows(), 0);
  EXPECT_EQ(transposed_product(B.topRows(0), none.topRows(0)).rows(), 4);
  Eigen::MatrixXd C = B;
  subtract_product(none, Eigen::MatrixXd(0, 4), C);
  EXPECT_EQ(C, B);
}

/// OpenBLAS without threads of its own gives two callers the same buffer now and then.
TEST(Product, TwoThreadsMayAskAtOnce) {
  constexpr int kProducts = 100'000;
  std::atomic<int> wrong{0};
  const auto ask = [&](Eigen::Index rows) {
    const Eigen::MatrixXd A = Eigen::MatrixXd::NullaryExpr(rows, 45, [](Eigen::Index i, Eigen::Index j) {
      return std::sin(0.37 * static_cast<double>(i + 41 * j));
    });
    const Eigen::MatrixXd expected = A.transpose() * A;
    for (int k = 0; k < kProducts; ++k)
      if (!((gram(A) - expected).cwiseAbs().maxCoeff() < 1e-9)) ++wrong;
  };
  std::thread other(ask, 41);
  ask(42);
  other.join();
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace mgtd::calib::linear
