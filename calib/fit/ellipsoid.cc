// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/ellipsoid.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <optional>

namespace mgtd::calib {
namespace {

using Points = Eigen::Matrix<double, Eigen::Dynamic, 3>;

constexpr int kMinPoses = 9;
/// Smallest spread over largest, over all directions: readings on a plane within this leave the quadric
/// undetermined. One axis of a table that wobbles by 0.1 degree reaches 0.004, tilts of 5 degrees 0.1.
constexpr double kFlat = 0.02;
/// Axis ratio beyond which a fitted "ellipsoid" is no fluxgate.
constexpr double kMaxAxisRatio = 5;

std::optional<Ellipsoid> quadric(const Points& z) {
  Eigen::Matrix<double, Eigen::Dynamic, 9> d(z.rows(), 9);
  const auto x = z.col(0).array(), y = z.col(1).array(), w = z.col(2).array();
  d.col(0) = x * x;
  d.col(1) = y * y;
  d.col(2) = w * w;
  d.col(3) = 2 * x * y;
  d.col(4) = 2 * x * w;
  d.col(5) = 2 * y * w;
  d.rightCols<3>() = z;
  const Eigen::Matrix<double, 9, 1> p = d.householderQr().solve(Eigen::VectorXd::Ones(z.rows()));
  Eigen::Matrix3d q;
  q << p[0], p[3], p[4], p[3], p[1], p[5], p[4], p[5], p[2];
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(q);
  const Eigen::Vector3d e = eigen.eigenvalues();
  if (!(e[0] > 0) || e[2] > kMaxAxisRatio * kMaxAxisRatio * e[0]) return std::nullopt;
  const Eigen::Vector3d centre = -0.5 * q.ldlt().solve(p.tail<3>());
  const Eigen::Matrix3d unit = q / (1 + centre.dot(q * centre));
  return Ellipsoid{.K = unit.llt().matrixU(), .offset_nT = centre};
}

/// |z|^2 = 2 c' z + d, linear; always a sphere.
Ellipsoid sphere(const Points& z) {
  Eigen::Matrix<double, Eigen::Dynamic, 4> d(z.rows(), 4);
  d << 2 * z, Eigen::VectorXd::Ones(z.rows());
  const Eigen::Vector4d p = d.colPivHouseholderQr().solve(z.rowwise().squaredNorm());
  const Eigen::Vector3d centre = p.head<3>();
  const double radius = std::sqrt(p[3] + centre.squaredNorm());
  return {.K = Eigen::Matrix3d::Identity() / radius, .offset_nT = centre, .is_sphere = true};
}

}  // namespace

Result<Ellipsoid> fit_ellipsoid(const std::vector<Eigen::Vector3d>& y_nT, double f_nT) {
  const auto n = static_cast<Eigen::Index>(y_nT.size());
  if (n < kMinPoses) {
    return fail(ErrorCode::refused, fmt::format("{} poses; one sensor alone has nine unknowns", n),
                "measure at least 9 poses in general position, better 30");
  }
  Points y(n, 3);
  for (Eigen::Index k = 0; k < n; ++k) y.row(k) = y_nT[static_cast<std::size_t>(k)];
  const Eigen::RowVector3d mean = y.colwise().mean();
  y.rowwise() -= mean;
  const Eigen::Vector3d spread = (y.transpose() * y / static_cast<double>(n))
                                     .selfadjointView<Eigen::Lower>()
                                     .eigenvalues()
                                     .cwiseMax(0)
                                     .cwiseSqrt();
  if (!(spread[0] > kFlat * spread[2])) {
    return fail(
        ErrorCode::refused,
        fmt::format("the readings lie on a plane: spread {:.3g} nT across it, {:.3g} nT along it", spread[0],
                    spread[2]),
        "poses about one axis only do not determine a sensor; turn the rig about a second axis as well");
  }
  const double scale = spread[2];
  const Points z = y / scale;
  Ellipsoid e = quadric(z).value_or(sphere(z));
  e.K *= f_nT / scale;
  e.offset_nT = mean.transpose() + scale * e.offset_nT;
  return e;
}

}  // namespace mgtd::calib
