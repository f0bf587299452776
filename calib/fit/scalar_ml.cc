// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/scalar_ml.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <cmath>

#include "calib/dual.h"
#include "calib/sensor_equations.h"

namespace mgtd::calib {
namespace {

constexpr int kUnknowns = 9, kMaxIterations = 200;
constexpr double kSettled = 1e-12, kMaxGain = 8;
using D = Dual<kUnknowns>;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;
using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;

template <class S>
Matrix3<S> shape(const std::array<S, kUnknowns>& x) {
  Matrix3<S> k;
  k << x[0], x[1], x[2], S(0), x[3], x[4], S(0), S(0), x[5];
  return k;
}

struct Sums {
  Normal normal{Normal::Zero()};
  Unknowns right{Unknowns::Zero()};
  double cost{0};
};

/// Readings come as z = K0 (y - I0) / F, so that all nine unknowns are of order one; residuals are distances
/// in y / F.
Sums accumulate(const Eigen::Matrix3Xd& z, const Eigen::VectorXd& f, const Eigen::Matrix3d& K0,
                const Unknowns& x) {
  const Matrix3<D> to_raw = K0.transpose().cast<D>();
  std::array<D, kUnknowns> d;
  for (int j = 0; j < kUnknowns; ++j) d[static_cast<std::size_t>(j)] = D::variable(x[j], j);
  const Matrix3<D> k = shape(d);
  Sums out;
  for (Eigen::Index i = 0; i < z.cols(); ++i) {
    Vector3<D> shifted;
    for (int a = 0; a < 3; ++a) shifted[a] = z(a, i) - d[static_cast<std::size_t>(6 + a)];
    const Vector3<D> b = k * shifted;
    const D size = sqrt(b[0] * b[0] + b[1] * b[1] + b[2] * b[2]);
    const Vector3<D> normal = to_raw * (k.transpose() * b / size);
    const D r = (size - f[i]) / sqrt(normal[0] * normal[0] + normal[1] * normal[1] + normal[2] * normal[2]);
    out.normal += r.d.matrix() * r.d.matrix().transpose();
    out.right -= r.v * r.d.matrix();
    out.cost += r.v * r.v;
  }
  return out;
}

}  // namespace

Result<ScalarMl> scalar_ml(const Eigen::Matrix3Xd& y_nT, const Eigen::VectorXd& f_nT,
                           const ScalarCalibration& start) {
  const double f = f_nT.mean();
  const Eigen::Matrix3Xd z = start.correct(y_nT) / f;
  const Eigen::VectorXd relative = f_nT / f;
  Unknowns x;
  x << 1, 0, 0, 1, 0, 1, 0, 0, 0;
  Sums at = accumulate(z, relative, start.K, x);
  double damping = 0;
  int iteration = 0;
  for (; iteration < kMaxIterations; ++iteration) {
    Normal damped = at.normal;
    damped.diagonal() *= 1 + damping;
    const Unknowns step = damped.ldlt().solve(at.right);
    if (damping == 0 && step.dot(at.right) < kSettled * at.cost) break;
    const Sums next = accumulate(z, relative, start.K, x + step);
    if (next.cost < at.cost) {
      x += step;
      at = next;
      damping = damping < 1e-6 ? 0 : damping / 10;
    } else {
      damping = std::max(1e-6, damping * 10);
      if (damping > 1e6) break;
    }
  }
  std::array<double, kUnknowns> v{};
  for (int j = 0; j < kUnknowns; ++j) v[static_cast<std::size_t>(j)] = x[j];
  const Eigen::Matrix3d change = shape(v);
  const double gain = 1 / std::abs((change * start.K).determinant());
  if (iteration == kMaxIterations || !(gain < kMaxGain && gain > 1 / kMaxGain)) {
    return fail(
        ErrorCode::refused,
        fmt::format(
            "the sensor's fit ended after {} iterations at a volume gain of {:.3g}; at nominal scale it is 1 "
            "(limits 1/{} and {})",
            iteration, gain, kMaxGain, kMaxGain),
        "cover more of the sphere, or check the nominal scale and the known field");
  }
  ScalarMl out{.sensor = start, .iterations = iteration};
  out.sensor.K = change * start.K;
  out.sensor.offset_nT += f * start.K.inverse() * x.tail<3>();
  const Eigen::VectorXd r = out.sensor.correct(y_nT).colwise().norm().transpose() - f_nT;
  out.residual_rms_nT = std::sqrt(r.squaredNorm() / static_cast<double>(r.size()));
  out.raw_residual_rms_nT = f * std::sqrt(at.cost / static_cast<double>(r.size()));
  return out;
}

}  // namespace mgtd::calib
