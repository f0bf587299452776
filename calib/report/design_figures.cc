// SPDX-License-Identifier: Apache-2.0
#include "calib/report/design_figures.h"

#include "calib/fit/joint/joint_problem.h"
#include "calib/report/explain_figures.h"
#include "calib/report/figures/sky_figures.h"
#include "calib/sensor/sensor_equations.h"

namespace mgtd::calib::report {
namespace {

/// Directions of the field in the platform at the angles of the poses.
std::vector<Eigen::Vector3d> directions_P(const design::DesignRequest& request) {
  const Eigen::Vector3d n = fit::joint::direction_of(request.inclination_rad, request.declination_rad);
  std::vector<Eigen::Vector3d> out;
  for (const Pose& pose : request.poses.poses) {
    const TableAngles a = pose.angles().value_or(TableAngles{});
    out.emplace_back(sensor::table_rotation(a.azimuth_rad, a.pitch_rad, a.roll_rad, 0.0, 0.0) * n);
  }
  return out;
}

}  // namespace

std::vector<figures::Figure> design_figures(const design::DesignRequest& request,
                                            const design::DesignReport& report) {
  std::vector<figures::Figure> out{
      figures::coverage_figure({.measured = directions_P(request), .planned = {}, .ahead = true})};
  if (report.power) out.push_back(detectable_of(report.power->detectable, report.power->untestable));
  return out;
}

}  // namespace mgtd::calib::report
