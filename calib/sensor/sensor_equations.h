// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>

/// These functions are the equations of a sensor (sensor_model.h) and of the table, written once for values
/// (double) and for derivatives (Dual<N>).
namespace mgtd::calib::sensor {

template <class S>
using Vector3 = Eigen::Matrix<S, 3, 1>;
template <class S>
using Matrix3 = Eigen::Matrix<S, 3, 3>;

/// Passive rotations of eq. 13.
template <class S>
[[nodiscard]] Matrix3<S> turn_x(const S& a) {
  using std::cos, std::sin;
  const S c = cos(a), s = sin(a);
  Matrix3<S> r;
  r << S(1), S(0), S(0), S(0), c, s, S(0), -s, c;
  return r;
}

template <class S>
[[nodiscard]] Matrix3<S> turn_y(const S& b) {
  using std::cos, std::sin;
  const S c = cos(b), s = sin(b);
  Matrix3<S> r;
  r << c, S(0), -s, S(0), S(1), S(0), s, S(0), c;
  return r;
}

template <class S>
[[nodiscard]] Matrix3<S> turn_z(const S& g) {
  using std::cos, std::sin;
  const S c = cos(g), s = sin(g);
  Matrix3<S> r;
  r << c, s, S(0), -s, c, S(0), S(0), S(0), S(1);
  return r;
}

/// C A of eq. 5: upper triangular.
template <class S>
[[nodiscard]] Matrix3<S> response_matrix(const S& theta, const S& phi, const S& psi, const Vector3<S>& c) {
  using std::cos, std::sin;
  const S cos_phi = cos(phi);
  Matrix3<S> a;
  a << c[0] * cos(theta) * cos_phi, c[0] * sin(theta) * cos_phi, c[0] * sin(phi), S(0), c[1] * cos(psi),
      c[1] * sin(psi), S(0), S(0), c[2];
  return a;
}

/// A small rotation by the vector w (rad), passive like turn_x(w[0]) to first order and an exact rotation for
/// any w: the Cayley form, rational and without a singularity at zero. Turns by 2 atan(|w|/2).
template <class S>
[[nodiscard]] Matrix3<S> turn_by(const Vector3<S>& w) {
  const S x = w[0] * 0.5, y = w[1] * 0.5, z = w[2] * 0.5;
  Matrix3<S> k;
  k << S(0), z, -y, -z, S(0), x, y, -x, S(0);
  const S scale = S(2) / (S(1) + x * x + y * y + z * z);
  Matrix3<S> r = scale * (k + k * k);
  for (int i = 0; i < 3; ++i) r(i, i) += S(1);
  return r;
}

/// Site frame to platform frame: Rz(azimuth) tilt Ry(pitch) Rx(roll). `tilt` is the wobble of the azimuth
/// axis, zero on a perfect table.
template <class S>
[[nodiscard]] Matrix3<S> table_rotation(const S& azimuth, const S& pitch, const S& roll, const S& tilt_x,
                                        const S& tilt_y) {
  const Matrix3<S> tilted = turn_by<S>({tilt_x, tilt_y, S(0)}) * turn_y(pitch);
  return turn_z(azimuth) * tilted * turn_x(roll);
}

}  // namespace mgtd::calib::sensor
