// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>

#include "calib/effects/effect_spec.h"
#include "calib/effects/laws/dipole_field.h"
#include "calib/effects/laws/site_effect.h"

/// `site.dipole` is the field of a magnet or a piece of iron near the array.
///
///     B(x) += D(x - place - shift) - D(-place - shift),   D as in dipole_field.h
///
/// Its field at the centre of the array is part of B0, as that of every magnet further away is.
/// Coefficients: moment m (A m^2) and shift (m) from the place it is started at, which is one of a grid
/// (`place`) or given (`x`, `y`, `z`). The shift has a prior of half a metre: without a moment nothing else
/// holds it.
namespace mgtd::calib::effects::laws {

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
    const std::array<S, 3> here = dipole_field_nT(c, from), there = dipole_field_nT(c, centre);
    for (std::size_t i = 0; i < 3; ++i) out[i] = here[i] - there[i];
  }

 private:
  bool given_;
  Eigen::Vector3d start_S_m_;
};

}  // namespace mgtd::calib::effects::laws
