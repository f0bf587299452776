// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <limits>

/// A Dual is a forward-mode dual number: a value and its N partial derivatives, carried exactly through every
/// operation.
///
///     f(v + sum d_i e_i) = f(v) + f'(v) sum d_i e_i,   e_i e_j = 0
///
/// Works as an Eigen scalar, so that one templated equation gives values (double) and Jacobians (Dual<N>).
/// Eigen's AutoDiffScalar lies among its unsupported modules, and Boost.Math's autodiff nests a type for each
/// variable to give higher derivatives, which nothing here needs. Comparisons look at the value only: a
/// branch is differentiated as if it were taken everywhere near the point.
namespace mgtd::calib::sensor {

template <int N>
struct Dual {
  using Derivatives = Eigen::Array<double, N, 1>;
  double v;
  Derivatives d;

  /// Like a double, not initialised. A debug build sets NaN, so that a use before it is assigned shows.
#ifdef NDEBUG
  Dual() {}
#else
  Dual() : v(std::numeric_limits<double>::quiet_NaN()) {}
#endif
  /// Not explicit: constants mix with variables.
  Dual(double value) : v(value), d(Derivatives::Zero()) {}
  Dual(double value, const Derivatives& derivatives) : v(value), d(derivatives) {}
  /// The variable that owns derivative slot `slot`.
  [[nodiscard]] static Dual variable(double value, int slot) {
    Dual x(value);
    x.d[slot] = 1;
    return x;
  }

  Dual& operator+=(const Dual& o) {
    v += o.v;
    d += o.d;
    return *this;
  }
  Dual& operator-=(const Dual& o) {
    v -= o.v;
    d -= o.d;
    return *this;
  }
  Dual& operator*=(const Dual& o) {
    d = d * o.v + v * o.d;
    v *= o.v;
    return *this;
  }
  Dual& operator/=(const Dual& o) {
    v /= o.v;
    d = (d - v * o.d) / o.v;
    return *this;
  }

  friend Dual operator-(const Dual& a) { return {-a.v, -a.d}; }
  friend Dual operator+(Dual a, const Dual& b) { return a += b; }
  friend Dual operator-(Dual a, const Dual& b) { return a -= b; }
  friend Dual operator*(Dual a, const Dual& b) { return a *= b; }
  friend Dual operator/(Dual a, const Dual& b) { return a /= b; }
  friend bool operator<(const Dual& a, const Dual& b) { return a.v < b.v; }
  friend bool operator>(const Dual& a, const Dual& b) { return a.v > b.v; }
  friend bool operator<=(const Dual& a, const Dual& b) { return a.v <= b.v; }
  friend bool operator>=(const Dual& a, const Dual& b) { return a.v >= b.v; }
  friend bool operator==(const Dual& a, const Dual& b) { return a.v == b.v; }

  friend Dual sin(const Dual& a) { return {std::sin(a.v), std::cos(a.v) * a.d}; }
  friend Dual cos(const Dual& a) { return {std::cos(a.v), -std::sin(a.v) * a.d}; }
  friend Dual exp(const Dual& a) {
    const double e = std::exp(a.v);
    return {e, e * a.d};
  }
  friend Dual log(const Dual& a) { return {std::log(a.v), a.d / a.v}; }
  friend Dual sqrt(const Dual& a) {
    const double s = std::sqrt(a.v);
    return {s, a.d / (2 * s)};
  }
  friend Dual abs(const Dual& a) { return a.v < 0 ? -a : a; }
};

/// The number without its derivatives, for either scalar.
[[nodiscard]] inline double value_of(double x) { return x; }
template <int N>
[[nodiscard]] double value_of(const Dual<N>& x) {
  return x.v;
}

}  // namespace mgtd::calib::sensor

namespace Eigen {
template <int N>
struct NumTraits<mgtd::calib::sensor::Dual<N>> : NumTraits<double> {
  using Real = mgtd::calib::sensor::Dual<N>;
  using NonInteger = Real;
  using Nested = Real;
  enum {
    IsComplex = 0,
    IsInteger = 0,
    IsSigned = 1,
    RequireInitialization = 1,
    ReadCost = N,
    AddCost = N,
    MulCost = 2 * N
  };
};
template <int N, class Op>
struct ScalarBinaryOpTraits<mgtd::calib::sensor::Dual<N>, double, Op> {
  using ReturnType = mgtd::calib::sensor::Dual<N>;
};
template <int N, class Op>
struct ScalarBinaryOpTraits<double, mgtd::calib::sensor::Dual<N>, Op> {
  using ReturnType = mgtd::calib::sensor::Dual<N>;
};
}  // namespace Eigen
