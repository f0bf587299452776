// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/checks/identifiability_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "proto/units.h"

namespace mgtd::calib::fit::checks {

std::string to_text(const joint::WeakDirection& weak) {
  return fmt::format("{}{}", fmt::join(weak.parameters, " with "), weak.others ? " and others" : "");
}

std::string weak_sd_text(double sd_nT) {
  return std::isfinite(sd_nT) ? fmt::format("{:.0f} nT of field", sd_nT) : "not at all";
}

std::string to_text(const joint::FieldCoverage& coverage) {
  constexpr double kAlongAnAxis = 0.95;  // cosine
  const Eigen::Vector3d& axis = coverage.axis_P;
  Eigen::Index nearest = 0;
  const double along = axis.cwiseAbs().maxCoeff(&nearest);
  const std::string name = fmt::format("{}{}", axis[nearest] < 0 ? '-' : '+', "XYZ"[nearest]);
  return fmt::format(
      "seen from the rig the field stays between {:.0f} and {:.0f} deg from platform {}{}",
      to_deg(coverage.least_rad), to_deg(coverage.most_rad), name,
      along > kAlongAnAxis ? "" : fmt::format(" (axis {:.2f}, {:.2f}, {:.2f})", axis[0], axis[1], axis[2]));
}

std::string to_text(const TableAngles& a) {
  return fmt::format("azimuth {:.0f}, pitch {:.0f}, roll {:.0f} deg", to_deg(a.azimuth_rad),
                     to_deg(a.pitch_rad), to_deg(a.roll_rad));
}

std::string to_text(const std::vector<TableAngles>& poses) {
  std::vector<std::string> texts;
  for (const TableAngles& angles : poses) texts.push_back(to_text(angles));
  return fmt::format("{}", fmt::join(texts, "; "));
}

}  // namespace mgtd::calib::fit::checks
