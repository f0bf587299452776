// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/checks/common_checks.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "calib/fit/checks/check_limits.h"

namespace mgtd::calib::fit::checks {
namespace {

Check check(std::string name, bool passed, std::string measured, std::string limit, std::string remedy) {
  return {std::move(name), passed, std::move(measured), std::move(limit), std::move(remedy)};
}

Check scale_check(const calibration::Calibration& c) {
  double low = 1e9, high = 0;
  for (const sensor::SensorModel& s : c.sensors)
    low = std::min(low, s.scale.minCoeff()), high = std::max(high, s.scale.maxCoeff());
  return check("scale factors", low >= kMinScale && high <= kMaxScale,
               fmt::format("{:.4f} to {:.4f}", low, high), fmt::format("{} to {}", kMinScale, kMaxScale),
               "check the volts-to-nT profile of the sensor and the total field");
}

Check angle_check(const calibration::Calibration& c) {
  double worst = 0;
  for (const sensor::SensorModel& s : c.sensors)
    worst = std::max({worst, std::abs(s.theta_rad), std::abs(s.phi_rad), std::abs(s.psi_rad)});
  return check("non-orthogonality", worst <= kMaxNonOrthogonality_rad,
               fmt::format("{:.3f} deg at most", to_deg(worst)),
               fmt::format("{:.0f} deg", to_deg(kMaxNonOrthogonality_rad)),
               "an axis is dead or wired twice: look at the raw readings of that sensor");
}

Check determinant_check(const calibration::Calibration& c) {
  double low = 1e9, high = 0;
  for (const sensor::SensorModel& s : c.sensors) {
    const double d = std::abs(s.response().determinant());
    low = std::min(low, d), high = std::max(high, d);
  }
  return check("volume", low >= kMinDeterminant && high <= kMaxDeterminant,
               fmt::format("{:.3f} to {:.3f}", low, high),
               fmt::format("{} to {}", kMinDeterminant, kMaxDeterminant),
               "the solution is degenerate: add attitudes and fit again");
}

Check residual_check(const FitReport& r) {
  const auto& rms = r.after.total_field_rmse_nT;
  const double worst = *std::max_element(rms.begin(), rms.end());
  return check("total field", worst <= kMaxResidualShare * r.site.f_nT,
               fmt::format("{:.3f} nT rms of |b| - F, worst sensor", worst),
               fmt::format("{:.1f} nT, 0.1 % of the field", kMaxResidualShare * r.site.f_nT),
               "look for a disturbed pose, a wrong total field or iron near the rig");
}

}  // namespace

Check bad_poses_check(const FitReport& r) {
  if (!r.contradicting)
    return check("bad poses", true, "not asked: every reading was to be kept",
                 fmt::format("{:.0f} % of the poses", 100 * kMaxBadPoses), "fit without --keep-all");
  return check("bad poses", *r.contradicting <= kMaxBadPoses,
               fmt::format("{:.0f} % of the poses contradict the others", 100 * *r.contradicting),
               fmt::format("{:.0f} % of the poses", 100 * kMaxBadPoses),
               r.outliers.empty()
                   ? "so many contradict that none was left out: look for a disturbance, a loose "
                     "cable or a change during the run, and measure again"
                   : "look at the listed poses; measure them again");
}

std::vector<Check> common_checks(const FitReport& report) {
  const calibration::Calibration& c = report.calibration;
  return {scale_check(c), angle_check(c), determinant_check(c), residual_check(report)};
}

}  // namespace mgtd::calib::fit::checks
