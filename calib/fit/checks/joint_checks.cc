// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/checks/joint_checks.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "calib/fit/checks/check_limits.h"
#include "calib/fit/checks/common_checks.h"
#include "calib/fit/checks/identifiability_text.h"
#include "calib/fit/checks/mirrored_text.h"
#include "calib/fit/joint/joint_findings.h"
#include "calib/fit/joint/table_ceiling.h"

namespace mgtd::calib::fit::checks {
namespace {

std::string sd_text(double sd_nT) {
  return std::isfinite(sd_nT) ? fmt::format("{:.0f} nT", sd_nT) : "unlimited";
}

Check coverage_check(const FitReport& r, const joint::Identifiability& known) {
  const double limit = joint::kUnusable * r.site.f_nT;
  const bool passed = known.worst_nT() <= limit;
  return {"coverage", passed,
          known.weak.empty()
              ? std::string("every combination of parameters to better than 0.1 % of the field")
              : fmt::format("{}: {} of field uncertainty; {}", to_text(known.weak.front()),
                            sd_text(known.worst_nT()), to_text(known.coverage)),
          sd_text(limit), known.add.empty() ? std::string() : additions_text(known.add, r.table.sd_rad > 0)};
}

Check condition_check(const FitReport& r, const joint::Identifiability& known) {
  return {
      "condition", known.condition <= kMaxCondition,
      fmt::format("{:.2g} between the best and the worst known combination of parameters", known.condition),
      fmt::format("{:.0e}", kMaxCondition),
      known.add.empty() ? std::string("turn the rig about a second and a third axis")
                        : additions_text(known.add, r.table.sd_rad > 0)};
}

/// The turn from a sensor to the signed permutation that names its mounting: half way to the next one the
/// name means nothing.
Check mounting_check(const FitReport& r) {
  double worst = 0;
  std::size_t which = 0;
  std::vector<std::size_t> mirrored;
  for (std::size_t i = 0; i < r.calibration.sensors.size(); ++i) {
    const sensor::SensorModel& s = r.calibration.sensors[i];
    const Eigen::Matrix3d turn = s.R_PS() * s.mounting.transpose();
    const double angle = std::acos(std::clamp((turn.trace() - 1) / 2, -1.0, 1.0));
    if (angle > worst) worst = angle, which = i;
    if (s.mounting.determinant() < 0) mirrored.push_back(i + 1);
  }
  return {"mounting", worst <= kMaxTurn_rad && mirrored.empty(),
          !mirrored.empty() ? mirrored_text(mirrored, r.calibration.sensors.size())
                            : fmt::format("s{} stands {:.1f} deg from the nearest whole quarter turns",
                                          which + 1, to_deg(worst)),
          fmt::format("{:.0f} deg, and no mirrored sensor", to_deg(kMaxTurn_rad)),
          !mirrored.empty() ? "check the wiring of each sensor with a magnet, mend it and measure again"
                            : "mount the sensor square to the platform, or check that it sat still"};
}

Check table_check(const FitReport& r, const FitOptions& options) {
  const double limit = table_limit_rad(options.table_sd_rad);
  return {"table angles", r.table.sd_rad <= limit,
          fmt::format("the sensors put the attitudes {:.3f} deg rms{} from the table's angles",
                      to_deg(r.table.sd_rad), joint::or_more(r.table.sd_rad)),
          limit > kByHand_rad ? fmt::format("{:.3f} deg, {} times the table's {:.3f} deg", to_deg(limit),
                                            kMaxTableSigmas, to_deg(options.table_sd_rad))
                              : fmt::format("{:.3f} deg, of scales read by hand", to_deg(limit)),
          "check the sense, the order and the zero of every table axis"};
}

Check direction_check(const char* name, double found, double sd, double given, double table_sd) {
  const double limit = kMaxDirectionSigmas * std::hypot(sd, table_sd);
  return {name, std::abs(std::remainder(found - given, 2 * std::numbers::pi)) <= limit,
          fmt::format("the poses show {:.3f} deg, {:.3f} deg was given", to_deg(found), to_deg(given)),
          fmt::format("{:.3f} deg apart", to_deg(limit)),
          "a mismatch means reversed table angles, a mirrored sensor, a table that is not level, or a wrong "
          "value"};
}

Check agreement_check(const joint::Agreement& a) {
  const bool tails = a.scatter.few_far_off();
  const bool unseen = a.poses >= kEnoughPoses && a.held_out_nT && *a.held_out_nT > kMaxHeldOut * a.fitted_nT;
  const bool moved = a.moved > kMaxMoved;
  std::string measured = fmt::format("residual {:.3g} nT rms, {:.3g} nT by the median", a.scatter.residual_nT,
                                     a.scatter.typical_nT);
  if (a.held_out_nT) measured += fmt::format("; {:.3g} nT on poses left out", *a.held_out_nT);
  measured += a.pose > 0 ? fmt::format(
                               "; without pose {} the calibration moves by {:.2g} of its standard "
                               "deviations",
                               a.pose, a.moved)
                         : std::string("; no pose moves it by more than its noise");
  return {"agreement", !tails && !unseen && !moved, std::move(measured),
          fmt::format("rms {} times the median's, poses left out {} times, one pose {} standard deviation",
                      joint::kMaxTails, kMaxHeldOut, kMaxMoved),
          moved ? fmt::format("the calibration rests on pose {}: measure it again", a.pose)
          : tails
              ? std::string("a few readings are far off and bend the others: look at the largest residuals")
              : std::string("poses that were not fitted are missed: look for a change during the run, and "
                            "measure more attitudes")};
}

}  // namespace

std::vector<Check> joint_checks(const FitReport& r, const FitOptions& options) {
  const joint::Identifiability& known = r.joint->known;
  std::vector<Check> out = common_checks(r);
  out.push_back(coverage_check(r, known));
  out.push_back(condition_check(r, known));
  out.push_back(mounting_check(r));
  if (r.table.sd_rad > 0) {
    out.push_back(table_check(r, options));
    const SiteField& s = r.site;
    if (options.inclination_rad) {
      out.push_back(direction_check("inclination", s.inclination_rad, s.inclination_sd_rad,
                                    *options.inclination_rad, options.table_sd_rad));
    }
    if (options.declination_rad) {
      out.push_back(direction_check("declination", s.declination_rad, s.declination_sd_rad,
                                    *options.declination_rad, options.table_sd_rad));
    }
  }
  out.push_back(bad_poses_check(r));
  out.push_back(agreement_check(r.joint->agreement));
  return out;
}

}  // namespace mgtd::calib::fit::checks
