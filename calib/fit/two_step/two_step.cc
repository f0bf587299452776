// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/two_step/two_step.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>

#include "calib/fit/orientation.h"

namespace mgtd::calib::fit::two_step {
namespace {

/// An alignment that contradicts the angles of the tilted poses by more than this has the wrong sign of Bz.
constexpr double kContradiction_rad = 20 * kRadiansPerDegree;

struct Placed {
  Alignment alignment;
  AzimuthOrigin origin;
};

Result<Placed> place(const Readings& readings, const PerSensor<Eigen::Matrix3Xd>& b_S_nT,
                     const FitOptions& options, std::optional<double> bz_sign) {
  auto alignment = align(readings, b_S_nT, bz_sign);
  if (!alignment) return tl::unexpected(alignment.error());
  Placed out{*std::move(alignment), {}};
  out.origin = azimuth_origin(readings, out.alignment, b_S_nT, options.declination_rad);
  return out;
}

/// The sign of Bz: from a known inclination, else the majority is right-handed, unless poses that tilt
/// contradict it.
Result<Placed> place(const Readings& readings, const PerSensor<Eigen::Matrix3Xd>& b_S_nT,
                     const FitOptions& options) {
  if (options.inclination_rad)
    return place(readings, b_S_nT, options, *options.inclination_rad < 0 ? -1.0 : 1.0);
  auto first = place(readings, b_S_nT, options, std::nullopt);
  if (!first || first->origin.misfit_rad < kContradiction_rad) return first;
  auto second = place(readings, b_S_nT, options, first->alignment.bz_nT > 0 ? -1.0 : 1.0);
  return second && second->origin.misfit_rad < first->origin.misfit_rad ? second : first;
}

}  // namespace

Eigen::Vector3d TwoStep::site_direction() const {
  const double h = alignment.bh_nT;
  return Eigen::Vector3d{h * std::cos(origin.declination_rad), h * std::sin(origin.declination_rad),
                         alignment.bz_nT}
      .normalized();
}

Result<TwoStep> two_step(const Readings& readings, const FitOptions& options) {
  TwoStep out;
  const std::size_t sensors = readings.y_nT.size();
  out.step1.resize(sensors);
  out.sensors.resize(sensors);
  PerSensor<Eigen::Matrix3Xd> b_S_nT(sensors);
  const auto step1 =
      options.method == Method::simplified ? sensor::simplified_calibration : sensor::scalar_calibration;
  for (std::size_t i = 0; i < sensors; ++i) {
    auto fitted = step1(readings.y_nT[i], readings.f_nT);
    if (!fitted) {
      return fail(fitted.error().code, fmt::format("sensor s{}: {}", i + 1, fitted.error().message),
                  fitted.error().remedy);
    }
    out.step1[i] = *std::move(fitted);
    b_S_nT[i] = out.step1[i].correct(readings.y_nT[i]);
  }
  auto placed = place(readings, b_S_nT, options);
  if (!placed) return tl::unexpected(placed.error());
  out.alignment = std::move(placed->alignment);
  out.origin = placed->origin;
  turn_to(out.alignment, out.origin.declination_rad);
  for (std::size_t i = 0; i < sensors; ++i) {
    out.sensors[i] = sensor_from(out.step1[i].K, out.step1[i].offset_nT, out.alignment.R_PS[i]);
  }
  return out;
}

}  // namespace mgtd::calib::fit::two_step
