// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>

#include "calib/effects/effect_spec.h"
#include "calib/effects/site_effect.h"

/// `site.dipole`: a magnet or a piece of iron near the array.
///
///     B(x) += D(x) - D(0),   D(x) = 100 nT m^3/(A m^2) (3 (m u) u - m)/d^3,   u d = x - (place + shift)
///
/// Its field at the centre of the array is part of B0, as that of every magnet further away is.
/// Coefficients: moment m (A m^2) and shift (m) from the place it is started at, which is one of a grid
/// (`place`) or given (`x`, `y`, `z`). The shift has a prior of half a metre: without a moment nothing else
/// holds it.
namespace mgtd::calib {

/// Places to start from: 26 directions at 0.6 m and at 1.2 m from the centre of the array.
inline constexpr int kDipolePlaces = 52;
[[nodiscard]] Eigen::Vector3d dipole_place_S_m(int place);

class SiteDipole final : public SiteEffect<SiteDipole> {
 public:
  static constexpr std::string_view kName = "site.dipole";
  explicit SiteDipole(std::optional<Eigen::Vector3d> place_S_m);
  [[nodiscard]] std::string spec() const override;

  template <class S>
  void equation(const Conditions&, int, std::span<const S> x, std::span<const S> c, std::span<S> out) const {
    std::array<S, 3> from, centre;
    for (std::size_t i = 0; i < 3; ++i) {
      centre[i] = -c[3 + i] - S(start_S_m_[static_cast<Eigen::Index>(i)]);
      from[i] = x[i] + centre[i];
    }
    const std::array<S, 3> here = field(c, from), there = field(c, centre);
    for (std::size_t i = 0; i < 3; ++i) out[i] = here[i] - there[i];
  }

 private:
  static constexpr double kDipole_nT_m3_per_Am2 = 100;  // mu0/4 pi

  template <class S>
  static std::array<S, 3> field(std::span<const S> m, const std::array<S, 3>& d) {
    using std::sqrt;
    const S r2 = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    const S scale = S(kDipole_nT_m3_per_Am2) / (r2 * sqrt(r2));
    const S along = (m[0] * d[0] + m[1] * d[1] + m[2] * d[2]) * S(3.0) / r2;
    return {(along * d[0] - m[0]) * scale, (along * d[1] - m[1]) * scale, (along * d[2] - m[2]) * scale};
  }

  bool given_;
  Eigen::Vector3d start_S_m_;
};

}  // namespace mgtd::calib
