// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "calib/calibration/array_shape.h"
#include "proto/error.h"

/// A FieldExpansion computes field, gradient and closure of an array of N three-axis sensors as linear
/// functions of its 3N corrected components, wherever the sensors are placed.
///
/// The model is the field's expansion to first order about the origin of the platform frame,
///     b_i = B + G r_i,   G symmetric and traceless (no current, no source between the sensors)
/// with 8 unknowns: B (3), Gxx, Gyy, Gxy, Gxz, Gyz; Gzz = -(Gxx + Gyy). It is fitted by least squares, and
/// what is left of the 3N components is the closure. What the places cannot determine has no value:
///     all sensors at one place   B                             rank 3
///     on a line along u          B and the vector G u          rank 6
///     in a plane or in space     B and all of G                rank 8
/// A component of G is determined when it is a combination of what is: exactly when its row over the unknowns
/// lies in the row space of the design matrix. On a line along x these are Gxx, Gxy, Gxz; on an oblique line
/// none is, though three combinations are.
///
/// B is the field at `field_place_P_m()`. That is the origin where the field there can be told, as for every
/// plane or spatial array, and for a line that goes through the origin (to within kNegligible of its size).
/// Otherwise the field at the origin differs from that at the sensors by a derivative that nobody has
/// measured, and B is the field at the centroid of the sensors, which is the mean of their readings: one
/// sensor away from the origin gives the field where it is. At the origin of an array whose centroid is
/// elsewhere B is extrapolated along G, and has the noise of that.
///
/// Frame P, nT, m. Does not know noise, except for weighted(); does not correct readings; does not judge
/// whether a field is linear over the array (that is what the closure is for).
namespace mgtd::calib::calibration {

/// Order of the components of G in rows and covariances, as in the stream.
inline constexpr std::array<std::string_view, 6> kGradientNames{"Gxx", "Gyy", "Gzz", "Gxy", "Gxz", "Gyz"};

/// The derivative along a direction u of the platform: G u = `rows` b, nT/m.
struct DirectionalDerivative {
  Eigen::Vector3d direction_P;
  Eigen::Matrix3Xd rows;  ///< 3 x 3N
};

/// A linear unbiased estimate. A row of `gradient` whose component is not determined is zero, and so are its
/// products: ask determined() before reading one.
struct ExpansionEstimate {
  Eigen::Matrix3Xd field;                             ///< 3 x 3N: B = field * b
  Eigen::Matrix<double, 6, Eigen::Dynamic> gradient;  ///< 6 x 3N: G = gradient * b
  std::vector<DirectionalDerivative> derivatives;     ///< see derivatives_along()
};

/// The estimate of least variance for a given covariance of the channels.
struct WeightedEstimate : ExpansionEstimate {
  /// Of (B, Gxx, Gyy, Gzz, Gxy, Gxz, Gyz). Rows and columns of components that are not determined are zero,
  /// which says nothing of their uncertainty.
  Eigen::Matrix<double, 9, 9> covariance;
};

class FieldExpansion {
 public:
  /// Refused for less than 1 or more than 16 places, and for a place that is not finite.
  [[nodiscard]] static Result<FieldExpansion> of(std::span<const Eigen::Vector3d> places_P_m);

  [[nodiscard]] Eigen::Index sensors() const { return places_P_m_.cols(); }
  [[nodiscard]] Eigen::Index channels() const { return 3 * sensors(); }
  [[nodiscard]] const Eigen::Matrix3Xd& places_P_m() const { return places_P_m_; }
  [[nodiscard]] const ArrayShape& shape() const { return shape_; }

  /// Number of combinations of the 8 unknowns that are determined: 3, 6 or 8.
  [[nodiscard]] Eigen::Index rank() const { return design_.cols(); }
  [[nodiscard]] const std::array<bool, 6>& determined() const { return determined_; }
  [[nodiscard]] bool field_at_origin() const { return at_origin_; }
  [[nodiscard]] Eigen::Vector3d field_place_P_m() const;

  /// The estimate for equal noise of all channels: ordinary least squares.
  [[nodiscard]] const ExpansionEstimate& plain() const { return plain_; }
  [[nodiscard]] const Eigen::Matrix3Xd& field_rows() const { return plain_.field; }
  /// xx, yy, zz, xy, xz, yz. Zero where not determined.
  [[nodiscard]] const Eigen::Matrix<double, 6, Eigen::Dynamic>& gradient_rows() const {
    return plain_.gradient;
  }
  /// An orthonormal basis of the directions u whose whole vector G u is determined: none at one place, the
  /// line's own of a line (ArrayShape says its sign), else the three axes.
  [[nodiscard]] const std::vector<DirectionalDerivative>& derivatives_along() const {
    return plain_.derivatives;
  }

  /// (3N - rank) x 3N. Orthonormal rows, perpendicular to all that the model can say: noise of equal variance
  /// s^2 in every channel gives independent closure numbers of variance s^2, in nT. The basis is the one in
  /// echelon form: every row begins with more zeros than the one before, and its first number that is not
  /// zero is positive. It depends on nothing but the places and the order of the sensors.
  [[nodiscard]] const Eigen::MatrixXd& closure_rows() const { return closure_; }
  [[nodiscard]] Eigen::Index closure_dof() const { return closure_.rows(); }

  /// Generalised least squares for the covariance (3N x 3N, symmetric, nT^2) of the channels. The plain
  /// estimate, where that is a multiple of the identity. Refused where it has another size or is not positive
  /// definite.
  [[nodiscard]] Result<WeightedEstimate> weighted(const Eigen::MatrixXd& covariance) const;

 private:
  explicit FieldExpansion(Eigen::Matrix3Xd places_P_m);
  /// From E, which takes the channels to the unknowns of design_.
  [[nodiscard]] ExpansionEstimate estimate(const Eigen::MatrixXd& E) const;
  [[nodiscard]] bool in_row_space(const Eigen::MatrixXd& functionals) const;

  Eigen::Matrix3Xd places_P_m_;
  ArrayShape shape_;
  double unit_m_{1};           ///< lengths of design_ are in units of the array's size
  Eigen::MatrixXd row_space_;  ///< 5 x (rank - 3), orthonormal: what of the five components is determined
  Eigen::MatrixXd design_;     ///< 3N x rank: field at the centroid, then coordinates in row_space_
  std::array<bool, 6> determined_{};
  bool at_origin_{false};
  Eigen::Vector3d from_centroid_P_m_;  ///< to the place of the field, along what is determined
  ExpansionEstimate plain_;
  Eigen::MatrixXd closure_;
};

}  // namespace mgtd::calib::calibration
