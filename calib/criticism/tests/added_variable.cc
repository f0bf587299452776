// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/tests/added_variable.h"

#include <cmath>

namespace mgtd::calib::criticism::tests {

AddedVariable added_variable(const Signature& s, const OneStep& fitted, const Residual& residual,
                             const fit::joint::JointProblem& problem) {
  const Eigen::VectorXd z = s.times(fitted.basis * (fitted.basis.transpose() * s.by_residual()));
  const Eigen::VectorXd& r = residual.value();
  const double length2 = z.squaredNorm();
  AddedVariable out;
  if (!(length2 > 0)) return out;
  out.slope = z.dot(r) / length2;
  out.slope_sd = 1 / std::sqrt(length2);
  const Eigen::Index rows = residual.rows_per_pose();
  for (Eigen::Index k = 0; k < residual.poses(); ++k) {
    const auto z_k = z.segment(k * rows, rows);
    const double x = z_k.norm(), product = z_k.dot(r.segment(k * rows, rows));
    out.pose.push_back(problem.poses[static_cast<std::size_t>(k)].pose->number);
    out.x.push_back(x);
    out.y.push_back(x > 0 ? product / x : 0);
    out.share.push_back(product / z.dot(r));
  }
  return out;
}

}  // namespace mgtd::calib::criticism::tests
