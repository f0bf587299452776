// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/inverse.h"

#include <Eigen/LU>

namespace mgtd::calib::linear {

Eigen::MatrixXd inverse_by_lu(const Eigen::MatrixXd& A) { return A.inverse(); }

}  // namespace mgtd::calib::linear
