// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/joint_verdict.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "calib/fit/joint/joint_fit.h"

namespace mgtd::calib {
namespace {

constexpr double kMaxTableSigmas = 5;  ///< of the uncertainty the operator gives the table
/// A fit estimates 10 degrees at the most: what is nearer to that may be anything.
constexpr double kMaxTable_rad = to_rad(9);
/// Scales read by hand are good to 2 degrees.
constexpr double kByHand_rad = to_rad(5);
constexpr double kMaxDirectionSigmas = 5;
constexpr double kMaxCondition = 1e6;  ///< its square is what double precision has left of ten digits
constexpr double kMaxTurn_rad = to_rad(35);

std::string additions(const Identifiability& known) {
  std::vector<std::string> texts;
  for (const TableAngles& angles : known.add) texts.push_back(to_text(angles));
  return fmt::format("{}", fmt::join(texts, "; "));
}

std::string sd_text(double sd_nT) {
  return std::isfinite(sd_nT) ? fmt::format("{:.0f} nT", sd_nT) : "unlimited";
}

Check coverage_check(const FitReport& r, const Identifiability& known) {
  const double limit = kUnusable * r.site.f_nT;
  const bool passed = known.worst_nT() <= limit;
  return {"coverage", passed,
          known.weak.empty()
              ? std::string("every combination of parameters to better than 0.1 % of the field")
              : fmt::format("{}: {} of field uncertainty; {}", known.weak.front().what,
                            sd_text(known.worst_nT()), known.coverage),
          sd_text(limit), known.add.empty() ? std::string() : "add poses: " + additions(known)};
}

Check condition_check(const Identifiability& known) {
  return {
      "condition", known.condition <= kMaxCondition,
      fmt::format("{:.2g} between the best and the worst known combination of parameters", known.condition),
      fmt::format("{:.0e}", kMaxCondition),
      known.add.empty() ? std::string("turn the rig about a second and a third axis")
                        : "add poses: " + additions(known)};
}

/// The turn from a sensor to the signed permutation that names its mounting: half way to the next one the
/// name means nothing.
Check mounting_check(const FitReport& r) {
  double worst = 0;
  std::size_t which = 0;
  std::vector<std::size_t> mirrored;
  for (std::size_t i = 0; i < kSensors; ++i) {
    const SensorModel& s = r.calibration.sensors[i];
    const Eigen::Matrix3d turn = s.R_PS() * s.mounting.transpose();
    const double angle = std::acos(std::clamp((turn.trace() - 1) / 2, -1.0, 1.0));
    if (angle > worst) worst = angle, which = i;
    if (s.mounting.determinant() < 0) mirrored.push_back(i + 1);
  }
  const bool tie = 2 * mirrored.size() == kSensors;
  return {
      "mounting", worst <= kMaxTurn_rad && mirrored.empty(),
      tie ? fmt::format("two sensors are mirror images of the other two: which are right-handed cannot be "
                        "told from the field")
      : !mirrored.empty() ? mirrored_text(mirrored)
                          : fmt::format("s{} stands {:.1f} deg from the nearest whole quarter turns",
                                        which + 1, to_deg(worst)),
      fmt::format("{:.0f} deg, and no mirrored sensor", to_deg(kMaxTurn_rad)),
      !mirrored.empty() ? "check the wiring of each sensor with a magnet, mend it and measure again"
                        : "mount the sensor square to the platform, or check that it sat still"};
}

Check table_check(const FitReport& r, const FitOptions& options) {
  const double limit = table_limit_rad(options.table_sd_rad);
  return {"table angles", r.table_sd_rad <= limit,
          fmt::format("the sensors put the attitudes {:.3f} deg rms from the table's angles",
                      to_deg(r.table_sd_rad)),
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

}  // namespace

double table_limit_rad(double table_sd_rad) {
  return std::clamp(kMaxTableSigmas * table_sd_rad, kByHand_rad, kMaxTable_rad);
}

std::string rough_table_text(double estimated_rad, double told_rad) {
  if (estimated_rad <= kMaxTableSigmas * told_rad) return {};
  return fmt::format(
      "the table angles are good to {0:.2g} deg a pose, estimated, where {1:.2g} deg was told: --table-sd "
      "{0:.2g} tells it; of a table with a motor, check the zero and the sense of each axis",
      to_deg(estimated_rad), to_deg(told_rad));
}

std::string mirrored_text(const std::vector<std::size_t>& sensors) {
  return fmt::format("sensor {} mirrored: left-handed axes, two leads are swapped or one is inverted",
                     sensors.size() == 1 ? fmt::format("{} is", sensors.front())
                                         : fmt::format("{} are", fmt::join(sensors, ", ")));
}

std::vector<Check> joint_verdict(const FitReport& r, const Identifiability& known,
                                 const FitOptions& options) {
  std::vector<Check> out = common_checks(r);
  out.push_back(coverage_check(r, known));
  out.push_back(condition_check(known));
  out.push_back(mounting_check(r));
  if (r.table_sd_rad > 0) {
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
  return out;
}

std::vector<std::string> joint_remarks(const FitReport& report, const Identifiability& known, double spread) {
  std::vector<std::string> out = remarks(report);
  if (spread > 1) {
    out.push_back(fmt::format(
        "for the uncertainties the readings count as {:.4g} times as noisy (the root of chi-square "
        "per degree of freedom), so that they cover what the model leaves out",
        spread));
  }
  if (report.calibration.gauge.find(kScaleIsFree) != std::string::npos) {
    out.push_back(
        fmt::format("no field is known, so {}: fields and gradients are in units of the mean scale "
                    "factor; give the field of the site with --field, or measure it",
                    kScaleIsFree));
  }
  for (const std::string& weak : report.weak) out.push_back("weakly known: " + weak);
  if (!known.add.empty())
    out.push_back(fmt::format("{}; the poses that would help most: {}", known.coverage, additions(known)));
  return out;
}

}  // namespace mgtd::calib
