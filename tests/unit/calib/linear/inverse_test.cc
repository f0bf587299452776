// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/inverse.h"

#include <gtest/gtest.h>

namespace mgtd::calib::linear {
namespace {

TEST(InverseByLu, PivotsWhereTheDiagonalIsZero) {
  const Eigen::MatrixXd A{{0, 2, 0}, {1, 0, 3}, {0, 1, 4}};
  const Eigen::MatrixXd expected{{0.375, 1, -0.75}, {0.5, 0, 0}, {-0.125, 0, 0.25}};
  EXPECT_TRUE(inverse_by_lu(A).isApprox(expected, 1e-14)) << inverse_by_lu(A);
}

}  // namespace
}  // namespace mgtd::calib::linear
