// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/checks/gauge_text.h"

#include <fmt/format.h>

#include "calib/calibration/scale_gauge.h"
#include "calib/fit/joint/joint_findings.h"
#include "calib/fit/joint/table_ceiling.h"
#include "proto/units.h"

namespace mgtd::calib::fit::checks {
namespace {

std::string common_rotation_zero(std::size_t sensors) {
  if (sensors == 1) return "alpha = beta = gamma = 0, relative to the mounting";
  return fmt::format("mean alpha = mean beta = mean gamma = 0 of the {} sensors, relative to their mountings",
                     sensors == 4 ? "four" : std::to_string(sensors));
}

/// How a reference beside the table stands.
std::string reference_text(const joint::Gauge& gauge) {
  if (!gauge.beside_table) return {};
  const std::string stands =
      "; the vector reference stands still beside the table and takes the variations of the field out, ";
  if (gauge.reference_turn_sd_rad)
    return stands +
           fmt::format("its turn about the field known to {:.2g} deg", to_deg(*gauge.reference_turn_sd_rad));
  return stands +
         "its turn about the field not known and without effect, because as far as the table can tell the "
         "field kept its direction";
}

}  // namespace

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
      return "platform Z is the axis of the standard turn; the azimuth is free: mean gamma of the "
             "sensors set to zero";
  }
  return {};
}

std::string gauge_text(const joint::Gauge& gauge, std::size_t sensors, double table_sd_rad,
                       const std::array<double, 3>& rotation_sd_rad) {
  std::string text;
  if (gauge.by_reference) {
    text =
        "platform frame is the frame of the vector reference; the angles of the sensors are their "
        "misalignment";
  } else if (gauge.angles == joint::AngleCoverage::none) {
    text = fmt::format("no table angles: {}; the common rotation against the platform is unknown",
                       common_rotation_zero(sensors));
    if (gauge.turns_held)
      text += sensors == 1 ? "; how the sensor turns with its temperature is unknown and set to zero"
                           : "; of turns with the temperature only those against s1 are known: that of s1 is "
                             "set to zero";
  } else {
    const bool convention = gauge.angles == joint::AngleCoverage::one_axis && !gauge.declination_known;
    text = fmt::format(
        "{} (table angles to {:.3g} deg{} a pose, estimated); common rotation known to {:.2g} deg about X, "
        "{:.2g} about Y",
        gauge.angles == joint::AngleCoverage::full ? "platform frame is the table frame"
                                                   : "platform by the table's one axis",
        to_deg(table_sd_rad), joint::or_more(table_sd_rad), to_deg(rotation_sd_rad[0]),
        to_deg(rotation_sd_rad[1]));
    text += convention ? "; about Z by convention mean gamma = 0, because the angles turn about one axis only"
                       : fmt::format(", {:.2g} about Z", to_deg(rotation_sd_rad[2]));
    if (gauge.declination_known) text += "; declination as given";
    text += reference_text(gauge);
  }
  if (!gauge.scale_known)
    text += fmt::format("; no field is known: mean scale factor of the {} axes = 1, {}",
                        sensors == 4 ? "twelve" : std::to_string(3 * sensors), calibration::kScaleIsFree);
  return text;
}

std::string gauge_text(const FitReport& report) {
  if (report.joint)
    return gauge_text(report.joint->gauge, report.calibration.sensors.size(), report.table.sd_rad,
                      report.joint->common_rotation_sd_rad);
  return report.azimuth_origin ? gauge_text(*report.azimuth_origin, report.site.declination_sd_rad)
                               : std::string();
}

}  // namespace mgtd::calib::fit::checks
