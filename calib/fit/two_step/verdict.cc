// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/two_step/verdict.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace mgtd::calib {
namespace {

/// A fluxgate is built to parts in a thousand; a factor of two is another sensor, range or unit.
constexpr double kMinScale = 0.5, kMaxScale = 2;
constexpr double kMaxNonOrthogonality_rad = 15 * kRadiansPerDegree;
/// The corrected volume against the raw one: zero for the trivial solution in which every reading maps to one
/// field.
constexpr double kMinDeterminant = 0.1, kMaxDeterminant = 10;
/// Residual of |b| beyond which no known effect of a working rig explains it: 0.1 % of the field.
constexpr double kMaxResidualShare = 1e-3;
/// Tilted poses may disagree with the table angles by their own uncertainty, in standard deviations.
constexpr double kMaxMisfitSigmas = 5;
constexpr double kMaxHalvesSigmas = 6;

Check check(std::string name, bool passed, std::string measured, std::string limit, std::string remedy) {
  return {std::move(name), passed, std::move(measured), std::move(limit), std::move(remedy)};
}

Check scale_check(const Calibration& c) {
  double low = 1e9, high = 0;
  for (const SensorModel& s : c.sensors)
    low = std::min(low, s.scale.minCoeff()), high = std::max(high, s.scale.maxCoeff());
  return check("scale factors", low >= kMinScale && high <= kMaxScale,
               fmt::format("{:.4f} to {:.4f}", low, high), fmt::format("{} to {}", kMinScale, kMaxScale),
               "check the volts-to-nT profile of the sensor and the total field");
}

Check angle_check(const Calibration& c) {
  double worst = 0;
  for (const SensorModel& s : c.sensors)
    worst = std::max({worst, std::abs(s.theta_rad), std::abs(s.phi_rad), std::abs(s.psi_rad)});
  return check("non-orthogonality", worst <= kMaxNonOrthogonality_rad,
               fmt::format("{:.3f} deg at most", to_deg(worst)),
               fmt::format("{:.0f} deg", to_deg(kMaxNonOrthogonality_rad)),
               "an axis is dead or wired twice: look at the raw readings of that sensor");
}

Check determinant_check(const Calibration& c) {
  double low = 1e9, high = 0;
  for (const SensorModel& s : c.sensors) {
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

Check table_check(const TwoStep& t, const FitOptions& options) {
  const double limit = kMaxMisfitSigmas * options.table_sd_rad;
  return check("table angles", t.origin.misfit_rad <= limit,
               fmt::format("the tilted poses put the field {:.3f} deg rms away from where the sensors saw it",
                           to_deg(t.origin.misfit_rad)),
               fmt::format("{:.3f} deg, {} times the table's {:.3f} deg", to_deg(limit), kMaxMisfitSigmas,
                           to_deg(options.table_sd_rad)),
               "check the sense and the zero of every table axis, and the declination if you gave one");
}

Check inclination_check(const FitReport& r, const FitOptions& options) {
  const double limit = kMaxMisfitSigmas * std::hypot(r.site.inclination_sd_rad, options.table_sd_rad);
  const double off = r.site.inclination_rad - *options.inclination_rad;
  return check("inclination", std::abs(off) <= limit,
               fmt::format("the turn about Z shows {:.3f} deg, {:.3f} deg was given",
                           to_deg(r.site.inclination_rad), to_deg(*options.inclination_rad)),
               fmt::format("{:.3f} deg apart", to_deg(limit)),
               "a mismatch means reversed table angles, a mirrored sensor, an axis that is not vertical, or "
               "a wrong inclination");
}

Check halves_check(const FitReport& r, const FitOptions& options) {
  // Each half has some 18 poses; an angle of step 2 then scatters by about sd sqrt(2/18), a difference by
  // sqrt 2 of it.
  const double limit = kMaxHalvesSigmas * options.table_sd_rad * std::sqrt(2.0 / 9.0);
  return check(
      "odd and even halves", r.halves->angle_difference_rad <= limit,
      fmt::format("step 2 differs by {:.4f} deg at most", to_deg(r.halves->angle_difference_rad)),
      fmt::format("{:.4f} deg", to_deg(limit)),
      "something changed between the way out and the way back: backlash, drift or a passing vehicle");
}

}  // namespace

Check bad_poses_check(const FitReport& r) {
  return check("bad poses", r.contradicting <= kMaxBadPoses,
               fmt::format("{:.0f} % of the poses contradict the others", 100 * r.contradicting),
               fmt::format("{:.0f} % of the poses", 100 * kMaxBadPoses),
               r.outliers.empty()
                   ? "so many contradict that none was left out: look for a disturbance, a loose "
                     "cable or a change during the run, and measure again"
                   : "look at the listed poses; measure them again");
}

std::vector<Check> common_checks(const FitReport& report) {
  const Calibration& c = report.calibration;
  return {scale_check(c), angle_check(c), determinant_check(c), residual_check(report)};
}

std::vector<Check> verdict(const FitReport& report, const TwoStep& fitted, const FitOptions& options) {
  std::vector<Check> out = common_checks(report);
  if (fitted.origin.misfit_rad > 0) out.push_back(table_check(fitted, options));
  if (options.inclination_rad) out.push_back(inclination_check(report, options));
  if (report.halves) out.push_back(halves_check(report, options));
  if (!report.outliers.empty()) out.push_back(bad_poses_check(report));
  return out;
}

std::vector<std::string> remarks(const FitReport& report) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < kSensorCount; ++i) {
    const SensorModel& s = report.calibration.sensors[i];
    if (s.mounting.isIdentity()) continue;
    const bool mirrored = s.mounting.determinant() < 0;
    std::string axes;
    for (int p = 0; p < 3; ++p) {
      int a = 0;
      s.mounting.row(p).cwiseAbs().maxCoeff(&a);
      axes += fmt::format("{}{} is platform {}", axes.empty() ? "" : ", ",
                          s.mounting(p, a) < 0 ? std::string("-") + "xyz"[a] : std::string(1, "xyz"[a]),
                          "XYZ"[p]);
    }
    out.push_back(fmt::format(
        "sensor s{} is {}: its {}", i + 1,
        mirrored ? "mirrored (an axis wired backwards, or two swapped)" : "mounted turned", axes));
  }
  if (std::string left = left_over(report); !left.empty()) out.push_back(std::move(left));
  for (const std::string& text : outlier_texts(report.outliers))
    out.push_back(text + "; left out of the fit");
  return out;
}

std::string left_over(const FitReport& report) {
  if (!(report.dof > 0)) return {};
  const double ratio = std::sqrt(report.chi2 / report.dof);
  // The square root of chi-square per degree of freedom scatters by 1/sqrt(2 dof).
  if (ratio <= 1 + 5 / std::sqrt(2 * report.dof)) return {};
  const std::string size =
      report.residual_nT > 0
          ? fmt::format("the residual is {:.3g} nT", report.residual_nT)
          : fmt::format("|b| less F scatters as if that noise were {:.3g} nT", ratio * report.noise_nT);
  return fmt::format("the model leaves something out: {}, and the noise of a pose mean is {:.3g} nT", size,
                     report.noise_nT);
}

std::string gauge_text(const AzimuthOrigin& origin, double declination_sd_rad) {
  switch (origin.gauge) {
    case AzimuthGauge::declination_given:
      return fmt::format(
          "platform Z is the axis of the standard turn; azimuth from the given declination {:.4f} deg, taken "
          "as exact",
          to_deg(origin.declination_rad));
    case AzimuthGauge::table_frame:
      return fmt::format(
          "platform frame is the table frame: Z by the standard turn, azimuth by the tilted poses, "
          "declination {:.4f} +- {:.4f} deg",
          to_deg(origin.declination_rad), to_deg(declination_sd_rad));
    case AzimuthGauge::mean_gamma_zero:
      return "platform Z is the axis of the standard turn; the azimuth is free: mean gamma of the four "
             "sensors set to zero";
  }
  return {};
}

}  // namespace mgtd::calib
