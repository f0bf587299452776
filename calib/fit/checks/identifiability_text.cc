// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/checks/identifiability_text.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "calib/fit/joint/field_direction.h"
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

std::string field_directions_text(const std::vector<TableAngles>& poses) {
  constexpr double kOnAxis = 1 - 1e-9;
  std::vector<std::string> texts;
  for (const TableAngles& a : poses) {
    const Eigen::Vector3d b = joint::field_direction(a);
    Eigen::Index nearest = 0;
    const double along = b.cwiseAbs().maxCoeff(&nearest);
    const auto shown = [&b](int i) { return std::abs(b[i]) < 0.005 ? 0.0 : b[i]; };  // no -0.00
    std::string text = along > kOnAxis
                           ? fmt::format("{}{}", b[nearest] < 0 ? '-' : '+', "XYZ"[nearest])
                           : fmt::format("({:.2f}, {:.2f}, {:.2f})", shown(0), shown(1), shown(2));
    if (std::find(texts.begin(), texts.end(), text) == texts.end()) texts.push_back(std::move(text));
  }
  return fmt::format("{}", fmt::join(texts, "; "));
}

std::string additions_text(const std::vector<TableAngles>& poses, bool table) {
  return table ? "add poses: " + to_text(poses)
               : "hold the array so that the field points along platform " + field_directions_text(poses);
}

std::string to_text(const std::vector<TableAngles>& poses) {
  std::vector<std::string> texts;
  for (const TableAngles& angles : poses) texts.push_back(to_text(angles));
  return fmt::format("{}", fmt::join(texts, "; "));
}

}  // namespace mgtd::calib::fit::checks
