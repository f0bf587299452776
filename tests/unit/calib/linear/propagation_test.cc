// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/propagation.h"

#include <gtest/gtest.h>

namespace mgtd::calib::linear {
namespace {

/// Of (x, y, z): x and y hang together, z stands alone.
const Eigen::Matrix3d kCovariance{{4, 1, 0}, {1, 9, 0}, {0, 0, 16}};

TEST(Propagation, OfASumADifferenceAndAMultiple) {
  const Eigen::Matrix3d J{{1, 1, 0}, {1, -1, 0}, {0, 0, 2}};
  const Eigen::Matrix3d expected{{15, -5, 0}, {-5, 11, 0}, {0, 0, 64}};
  EXPECT_EQ(propagated_covariance(J, kCovariance), expected);
  EXPECT_EQ(propagated_variances(J, kCovariance), expected.diagonal());
  for (Eigen::Index i = 0; i < 3; ++i)
    EXPECT_EQ(propagated_variance(J.row(i).transpose(), kCovariance), expected(i, i));
}

TEST(Propagation, IsTheSameForMatricesOfRunTimeSize) {
  const Eigen::MatrixXd J{{1, 2, 3}}, C = kCovariance;
  const Eigen::MatrixXd out = propagated_covariance(J, C);
  ASSERT_EQ(out.size(), 1);
  EXPECT_EQ(out(0, 0), 4 + 4 * 9 + 9 * 16 + 2 * 2);
}

}  // namespace
}  // namespace mgtd::calib::linear
