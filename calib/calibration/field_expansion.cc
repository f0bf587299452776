// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration/field_expansion.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "calib/linear/cholesky.h"
#include "calib/linear/propagation.h"
#include "calib/linear/qr.h"
#include "proto/per_sensor.h"

namespace mgtd::calib::calibration {
namespace {

/// Of numbers of order one. What the places determine is at least about kNegligible (array_shape.h), what
/// they do not is rounding, some 1e-16: anything between separates the two.
constexpr double kZero = 1e-9;

/// G v as a function of (xx, yy, xy, xz, yz).
Eigen::Matrix<double, 3, 5> times(const Eigen::Vector3d& v) {
  return Eigen::Matrix<double, 3, 5>{
      {v.x(), 0, v.y(), v.z(), 0}, {0, v.y(), v.x(), 0, v.z()}, {-v.z(), -v.z(), 0, v.x(), v.y()}};
}

/// xx, yy, zz, xy, xz, yz as functions of (xx, yy, xy, xz, yz).
Eigen::Matrix<double, 6, 5> components() {
  return Eigen::Matrix<double, 6, 5>{{1, 0, 0, 0, 0}, {0, 1, 0, 0, 0}, {-1, -1, 0, 0, 0},
                                     {0, 0, 1, 0, 0}, {0, 0, 0, 1, 0}, {0, 0, 0, 0, 1}};
}

/// Orthonormal basis in echelon form of the space of these orthonormal columns, as rows. Row by row it is the
/// part of the next channel that lies in the space and in no row so far: perpendicular to that part are then
/// all later rows, which have nothing left of this channel.
Eigen::MatrixXd echelon_rows(const Eigen::MatrixXd& basis) {
  Eigen::MatrixXd rows(basis.cols(), basis.rows());
  Eigen::Index found = 0;
  for (Eigen::Index channel = 0; channel < basis.rows() && found < rows.rows(); ++channel) {
    Eigen::VectorXd part = Eigen::VectorXd::Unit(basis.rows(), channel);
    for (int pass = 0; pass < 2; ++pass) {  // the second takes out what rounding left of the first
      part = basis * (basis.transpose() * part);
      part -= rows.topRows(found).transpose() * (rows.topRows(found) * part);
      if (part.norm() <= kZero) break;
      part.normalize();
    }
    if (part.norm() <= kZero) continue;
    part.head(channel).setZero();
    rows.row(found++) = part.transpose();
  }
  return rows;
}

}  // namespace

Result<FieldExpansion> FieldExpansion::of(std::span<const Eigen::Vector3d> places_P_m) {
  if (places_P_m.empty() || places_P_m.size() > static_cast<std::size_t>(kMostSensors)) {
    return fail(ErrorCode::usage,
                fmt::format("an array has 1 to {} sensors, not {}", kMostSensors, places_P_m.size()),
                "give the place of every sensor of the array, and of no other");
  }
  Eigen::Matrix3Xd places(3, static_cast<Eigen::Index>(places_P_m.size()));
  for (std::size_t i = 0; i < places_P_m.size(); ++i) {
    const Eigen::Vector3d& r = places_P_m[i];
    if (!r.allFinite()) {
      return fail(
          ErrorCode::bad_input,
          fmt::format("the place of s{} is ({}, {}, {}) m, which is no place", i + 1, r.x(), r.y(), r.z()),
          "give three finite numbers in metres");
    }
    places.col(static_cast<Eigen::Index>(i)) = r;
  }
  return FieldExpansion(std::move(places));
}

FieldExpansion::FieldExpansion(Eigen::Matrix3Xd places_P_m)
    : places_P_m_(std::move(places_P_m)), shape_(shape_of(places_P_m_)) {
  if (shape_.dimension() > 0) unit_m_ = shape_.size_m;
  Eigen::MatrixXd gradient_part(channels(), 5);
  for (Eigen::Index i = 0; i < sensors(); ++i)
    gradient_part.middleRows<3>(3 * i) = times(shape_.offsets_P_m.col(i) / unit_m_);
  row_space_ = linear::column_space(gradient_part.transpose(), Eigen::VectorXd::Ones(channels()), kZero);
  design_.resize(channels(), 3 + row_space_.cols());
  design_.leftCols<3>() = Eigen::Matrix3d::Identity().replicate(sensors(), 1);
  design_.rightCols(row_space_.cols()) = gradient_part * row_space_;

  const Eigen::Matrix<double, 6, 5> each = components();
  for (std::size_t c = 0; c < determined_.size(); ++c)
    determined_[c] = in_row_space(each.row(static_cast<Eigen::Index>(c)));
  const Eigen::Vector3d& c = shape_.centroid_P_m;
  from_centroid_P_m_ = -c;
  at_origin_ = true;
  if (shape_.dimension() < 2) {
    from_centroid_P_m_ = shape_.span_P * (shape_.span_P.transpose() * -c);
    at_origin_ = (c + from_centroid_P_m_).norm() <= std::max(kOnePlace_m, kNegligible * shape_.size_m);
    if (!at_origin_) from_centroid_P_m_.setZero();
  }

  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(channels(), channels());
  plain_ = estimate(linear::least_squares(design_, identity));
  closure_ = echelon_rows(linear::complement_of(design_));
}

bool FieldExpansion::in_row_space(const Eigen::MatrixXd& functionals) const {
  return (functionals - functionals * row_space_ * row_space_.transpose()).norm() <=
         kZero * functionals.norm();
}

Eigen::Vector3d FieldExpansion::field_place_P_m() const {
  return at_origin_ ? Eigen::Vector3d(Eigen::Vector3d::Zero()) : shape_.centroid_P_m;
}

ExpansionEstimate FieldExpansion::estimate(const Eigen::MatrixXd& E) const {
  // The five components, in nT/m; what is not determined of them is left out.
  const Eigen::MatrixXd five = row_space_ * E.bottomRows(row_space_.cols()) / unit_m_;
  ExpansionEstimate out;
  out.field = E.topRows<3>() + times(from_centroid_P_m_) * five;
  out.gradient = components() * five;
  for (std::size_t c = 0; c < determined_.size(); ++c) {
    if (!determined_[c]) out.gradient.row(static_cast<Eigen::Index>(c)).setZero();
  }
  const Eigen::Matrix3Xd directions =
      shape_.dimension() < 2 ? shape_.span_P : Eigen::Matrix3Xd(Eigen::Matrix3d::Identity());
  for (const auto& u : directions.colwise()) out.derivatives.push_back({u, times(u) * five});
  return out;
}

Result<WeightedEstimate> FieldExpansion::weighted(const Eigen::MatrixXd& covariance) const {
  if (covariance.rows() != channels() || covariance.cols() != channels()) {
    return fail(ErrorCode::usage,
                fmt::format("a covariance of {} x {} does not fit the {} channels of {} sensors",
                            covariance.rows(), covariance.cols(), channels(), sensors()));
  }
  const auto root = linear::Cholesky::of(covariance);
  if (!root) {
    return fail(ErrorCode::refused,
                fmt::format("the covariance of the {} channels is not positive definite: a channel, or a "
                            "combination of channels, would be without noise",
                            channels()),
                "give every channel a noise that is larger than zero");
  }
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(channels(), channels());
  WeightedEstimate out;
  static_cast<ExpansionEstimate&>(out) =
      estimate(linear::least_squares(root->whiten(design_), root->whiten(identity)));
  Eigen::Matrix<double, 9, Eigen::Dynamic> both(9, channels());
  both << out.field, out.gradient;
  out.covariance = linear::propagated_covariance(both, covariance);
  return out;
}

}  // namespace mgtd::calib::calibration
