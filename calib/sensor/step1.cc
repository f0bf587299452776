// SPDX-License-Identifier: Apache-2.0
#include "calib/sensor/step1.h"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "calib/linear/ldlt.h"
#include "calib/linear/qr.h"
#include "calib/linear/symmetric_eigen.h"

namespace mgtd::calib::sensor {
namespace {

constexpr Eigen::Index kUnknowns = 9;
/// Beyond this the noise of a fluxgate (2e-5 of the field) moves the solution by several percent.
constexpr double kMaxCondition = 2000;
/// Spread across the thinnest direction over the widest one; below, the readings lie on a plane.
constexpr double kMinFlatness = 0.01;

using Normal = Eigen::Matrix<double, kUnknowns, kUnknowns>;
using Unknowns = Eigen::Matrix<double, kUnknowns, 1>;

constexpr const char* kTurnMore =
    "turn the rig about a second and a third axis as well (random attitudes, or tilts of 20 deg and more)";

/// D'D and D'1 of the nine columns, in blocks that stay in the cache.
void accumulate(const Eigen::Matrix3Xd& z, Normal& normal, Unknowns& right) {
  constexpr Eigen::Index kBlock = 128;
  Eigen::Matrix<double, kUnknowns, kBlock> d;
  normal.setZero();
  right.setZero();
  for (Eigen::Index from = 0; from < z.cols(); from += kBlock) {
    const Eigen::Index n = std::min(kBlock, z.cols() - from);
    const auto block = z.middleCols(from, n);
    const auto x = block.row(0).array(), y = block.row(1).array(), w = block.row(2).array();
    auto rows = d.leftCols(n);
    rows.topRows<3>() = block;
    rows.row(3) = x * x;
    rows.row(4) = y * y;
    rows.row(5) = w * w;
    rows.row(6) = x * y;
    rows.row(7) = x * w;
    rows.row(8) = y * w;
    normal.selfadjointView<Eigen::Lower>().rankUpdate(rows);
    right += rows.rowwise().sum();
  }
  normal.triangularView<Eigen::StrictlyUpper>() = normal.transpose();
}

/// From so many poses on the columns are summed product by product: the same sums in another order, in a
/// third of the time.
constexpr Eigen::Index kMany = 2000;

using Entry = std::pair<int, int>;

/// The entry of the normal matrix, lower triangle, that holds the same monomial as (i, j) and comes first:
/// the 45 products of the nine columns are 34 different ones.
constexpr Entry first_with_monomial_of(int i, int j) {
  constexpr int kPowers[kUnknowns][3]{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {2, 0, 0}, {0, 2, 0},
                                      {0, 0, 2}, {1, 1, 0}, {1, 0, 1}, {0, 1, 1}};
  const auto same = [&](int k, int l) {
    for (int a = 0; a < 3; ++a)
      if (kPowers[i][a] + kPowers[j][a] != kPowers[k][a] + kPowers[l][a]) return false;
    return true;
  };
  for (int k = 0; k < kUnknowns; ++k)
    for (int l = 0; l <= k; ++l)
      if (same(k, l)) return {k, l};
  return {i, j};
}

/// What accumulate() gives for z = (y - mean) / scale, in blocks of columns that stay in the cache.
void accumulate_many(const Eigen::Matrix3Xd& y, const Eigen::Vector3d& mean, double scale, Normal& normal,
                     Unknowns& right) {
  constexpr Eigen::Index kBlock = 256, kLanes = 8;
  using Lanes = Eigen::Array<double, kLanes, 1>;
  Eigen::Array<double, kBlock, kUnknowns> d;
  normal.setZero();
  right.setZero();
  for (Eigen::Index from = 0; from < y.cols(); from += kBlock) {
    const Eigen::Index n = std::min(kBlock, y.cols() - from);
    if (n < kBlock) d.setZero();
    for (int a = 0; a < 3; ++a)
      d.col(a).head(n) = (y.row(a).segment(from, n).transpose().array() - mean[a]) / scale;
    for (int a = 0; a < 3; ++a) d.col(3 + a) = d.col(a) * d.col(a);
    d.col(6) = d.col(0) * d.col(1);
    d.col(7) = d.col(0) * d.col(2);
    d.col(8) = d.col(1) * d.col(2);
    for (int i = 0; i < kUnknowns; ++i) {
      for (int j = 0; j <= i; ++j) {
        if (first_with_monomial_of(i, j) != Entry{i, j}) continue;
        Lanes sum = Lanes::Zero();
        for (Eigen::Index k = 0; k < kBlock; k += kLanes)
          sum += d.col(i).segment<kLanes>(k) * d.col(j).segment<kLanes>(k);
        normal(i, j) += sum.sum();
      }
    }
    right.head<3>() += d.leftCols<3>().colwise().sum().matrix().transpose();
  }
  for (int i = 0; i < kUnknowns; ++i) {
    for (int j = 0; j <= i; ++j) {
      const auto [k, l] = first_with_monomial_of(i, j);
      normal(i, j) = normal(j, i) = normal(k, l);
    }
  }
  right.tail<6>() << normal(0, 0), normal(1, 1), normal(2, 2), normal(1, 0), normal(2, 0), normal(2, 1);
}

/// Condition of the columns once each has unit length: square root of that of the normal matrix.
double condition_of(const Normal& normal, const Unknowns& lengths) {
  const Normal unit = lengths.cwiseInverse().asDiagonal() * normal * lengths.cwiseInverse().asDiagonal();
  const Unknowns e = linear::symmetric_eigenvalues(unit);
  return e[0] > 0 ? std::sqrt(e[kUnknowns - 1] / e[0]) : std::numeric_limits<double>::infinity();
}

/// w to K and the centre, in the coordinates of w. Refuses a quadric that is no ellipsoid.
Result<ScalarCalibration> ellipsoid_of(const Unknowns& w) {
  Eigen::Matrix3d Q;
  Q << w[3], w[6] / 2, w[7] / 2, w[6] / 2, w[4], w[8] / 2, w[7] / 2, w[8] / 2, w[5];
  const Eigen::LLT<Eigen::Matrix3d> llt(Q);
  if (llt.info() != Eigen::Success) {
    return fail(
        ErrorCode::refused, "the readings do not lie on an ellipsoid",
        "look for a disturbed or saturated pose, a wrong total field, or too narrow a range of attitudes");
  }
  const Eigen::Vector3d centre = -0.5 * llt.solve(w.head<3>());
  ScalarCalibration out;
  out.K = Eigen::Matrix3d(llt.matrixU()) / std::sqrt(1 + centre.dot(Q * centre));
  out.offset_nT = centre;
  return out;
}

/// Refuses readings on a plane; gives the widest of their three spreads, nT.
Result<double> widest_spread(const Eigen::Matrix3d& scatter_nT2) {
  const Eigen::Vector3d spread = linear::principal_axes(scatter_nT2).values.cwiseMax(0).cwiseSqrt();
  if (spread[0] > kMinFlatness * spread[2]) return spread[2];
  return fail(ErrorCode::refused,
              fmt::format("the readings lie on a plane: they spread {:.4g} nT across it and {:.4g} nT "
                          "along it, {:.3g} of it; "
                          "{} is needed",
                          spread[0], spread[2], spread[0] / spread[2], kMinFlatness),
              fmt::format("poses about one axis only do not determine a sensor: {}", kTurnMore));
}

/// From the normal equations of the nine columns in (y - mean) / scale.
Result<ScalarCalibration> solved(const Normal& normal, const Unknowns& right, const Eigen::Vector3d& mean_nT,
                                 double scale_nT, double f_nT) {
  const Unknowns lengths = normal.diagonal().cwiseSqrt();
  const double condition = condition_of(normal, lengths);
  if (!(condition < kMaxCondition)) {
    return fail(ErrorCode::refused,
                fmt::format("condition number {:.3g}, limit {}", condition, kMaxCondition),
                fmt::format("the attitudes are too much alike: {}", kTurnMore));
  }
  const Unknowns scaled = linear::solve_by_ldlt(
      lengths.cwiseInverse().asDiagonal() * normal * lengths.cwiseInverse().asDiagonal(),
      Eigen::VectorXd(right.cwiseQuotient(lengths)));
  auto out = ellipsoid_of(scaled.cwiseQuotient(lengths));
  if (!out) return out;
  out->K *= f_nT / scale_nT;
  out->offset_nT = mean_nT + scale_nT * out->offset_nT;
  out->condition = condition;
  return out;
}

Result<ScalarCalibration> fit_many(const Eigen::Matrix3Xd& y, double f_nT) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (Eigen::Index k = 0; k < y.cols(); ++k) mean += y.col(k);
  mean /= static_cast<double>(y.cols());
  Normal normal;
  Unknowns right;
  accumulate_many(y, mean, f_nT, normal, right);
  const auto spread =
      widest_spread(normal.topLeftCorner<3, 3>() * (f_nT * f_nT / static_cast<double>(y.cols())));
  if (!spread) return tl::unexpected(spread.error());
  return solved(normal, right, mean, f_nT, f_nT);
}

Result<ScalarCalibration> fit_constant_field(const Eigen::Matrix3Xd& y, double f_nT) {
  if (y.cols() >= kMany) return fit_many(y, f_nT);
  const Eigen::Vector3d mean = y.rowwise().mean();
  Eigen::Matrix3Xd z = y.colwise() - mean;
  const Eigen::Matrix3d scatter = z * z.transpose() / static_cast<double>(y.cols());
  const auto spread = widest_spread(scatter);
  if (!spread) return tl::unexpected(spread.error());
  z /= *spread;
  Normal normal;
  Unknowns right;
  accumulate(z, normal, right);
  return solved(normal, right, mean, *spread, f_nT);
}

Result<void> enough(const Eigen::Matrix3Xd& y) {
  if (y.cols() >= kFewestScalarPoses) return {};
  return fail(
      ErrorCode::refused,
      fmt::format("{} poses; a sensor has nine parameters, so {} is the least", y.cols(), kFewestScalarPoses),
      "measure at least 9 poses in general position, better 30 and more");
}

}  // namespace

Result<ScalarCalibration> scalar_calibration(const Eigen::Matrix3Xd& y_nT, const Eigen::VectorXd& f_nT) {
  if (auto ok = enough(y_nT); !ok) return tl::unexpected(ok.error());
  const double mean_f = f_nT.mean();
  auto out = fit_constant_field(y_nT, mean_f);
  const Eigen::VectorXd ratio = mean_f * f_nT.cwiseInverse();
  if (!out || (ratio.array() - 1).abs().maxCoeff() < 1e-12) return out;
  // The offset enters with the relative change of F only: two rounds leave less than (change)^3 of it.
  for (int round = 0; out && round < 3; ++round) {
    const Eigen::Vector3d offset = out->offset_nT;
    const Eigen::Matrix3Xd y = ((y_nT.colwise() - offset) * ratio.asDiagonal()).colwise() + offset;
    out = fit_constant_field(y, mean_f);
  }
  return out;
}

Result<ScalarCalibration> simplified_calibration(const Eigen::Matrix3Xd& y_nT, const Eigen::VectorXd& f_nT) {
  if (auto ok = enough(y_nT); !ok) return tl::unexpected(ok.error());
  const double f = f_nT.mean();
  const Eigen::Matrix3Xd z = y_nT / f;
  Eigen::Matrix<double, Eigen::Dynamic, kUnknowns> d(z.cols(), kUnknowns);
  const auto x = z.row(0).transpose().array(), y = z.row(1).transpose().array(),
             w = z.row(2).transpose().array();
  d.col(0) = x * x, d.col(1) = x * y, d.col(2) = x * w;
  d.col(3) = y * y, d.col(4) = y * w, d.col(5) = w * w;
  d.rightCols<3>() = z.transpose();
  const Eigen::VectorXd right =
      0.5 * (z.colwise().squaredNorm().transpose() - (f_nT / f).array().square().matrix());
  const auto solution = linear::unique_least_squares(d, right);
  if (!solution) {
    return fail(ErrorCode::refused, fmt::format("the poses decide {} of nine unknowns", linear::rank_of(d)),
                kTurnMore);
  }
  const Unknowns p = *solution;
  Eigen::Matrix3d D;
  D << p[0], p[1], p[2], 0, p[3], p[4], 0, 0, p[5];
  ScalarCalibration out;
  out.K = Eigen::Matrix3d::Identity() - D;
  out.offset_nT = f * out.K.inverse() * p.tail<3>();
  return out;
}

}  // namespace mgtd::calib::sensor
