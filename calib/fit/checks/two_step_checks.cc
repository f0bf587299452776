// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/checks/two_step_checks.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "calib/fit/checks/check_limits.h"
#include "calib/fit/checks/common_checks.h"
#include "proto/units.h"

namespace mgtd::calib::fit::checks {
namespace {

Check table_check(const AzimuthOrigin& origin, const FitOptions& options) {
  const double limit = kMaxMisfitSigmas * options.table_sd_rad;
  return {"table angles", origin.misfit_rad <= limit,
          fmt::format("the tilted poses put the field {:.3f} deg rms away from where the sensors saw it",
                      to_deg(origin.misfit_rad)),
          fmt::format("{:.3f} deg, {} times the table's {:.3f} deg", to_deg(limit), kMaxMisfitSigmas,
                      to_deg(options.table_sd_rad)),
          "check the sense and the zero of every table axis, and the declination if you gave one"};
}

Check inclination_check(const FitReport& r, const FitOptions& options) {
  const double limit = kMaxMisfitSigmas * std::hypot(r.site.inclination_sd_rad, options.table_sd_rad);
  const double off = r.site.inclination_rad - *options.inclination_rad;
  return {"inclination", std::abs(off) <= limit,
          fmt::format("the turn about Z shows {:.3f} deg, {:.3f} deg was given",
                      to_deg(r.site.inclination_rad), to_deg(*options.inclination_rad)),
          fmt::format("{:.3f} deg apart", to_deg(limit)),
          "a mismatch means reversed table angles, a mirrored sensor, an axis that is not vertical, or "
          "a wrong inclination"};
}

Check halves_check(const FitReport& r, const FitOptions& options) {
  // Each half has some 18 poses; an angle of step 2 then scatters by about sd sqrt(2/18), a difference by
  // sqrt 2 of it.
  const double limit = kMaxHalvesSigmas * options.table_sd_rad * std::sqrt(2.0 / 9.0);
  return {"odd and even halves", r.halves->angle_difference_rad <= limit,
          fmt::format("step 2 differs by {:.4f} deg at most", to_deg(r.halves->angle_difference_rad)),
          fmt::format("{:.4f} deg", to_deg(limit)),
          "something changed between the way out and the way back: backlash, drift or a passing vehicle"};
}

}  // namespace

std::vector<Check> two_step_checks(const FitReport& report, const FitOptions& options) {
  std::vector<Check> out = common_checks(report);
  if (report.azimuth_origin && report.azimuth_origin->misfit_rad > 0)
    out.push_back(table_check(*report.azimuth_origin, options));
  if (options.inclination_rad) out.push_back(inclination_check(report, options));
  if (report.halves) out.push_back(halves_check(report, options));
  if (!report.outliers.empty()) out.push_back(bad_poses_check(report));
  return out;
}

}  // namespace mgtd::calib::fit::checks
