// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/survey.h"

namespace mgtd::rig {
namespace {

/// What both have under the same name, except the sensors' own.
template <class From, class To>
void copy_row(const From& from, To& to) {
  to.number = from.number;
  to.set = from.set;
  to.t_s = from.t_s;
  to.azimuth_rad = from.azimuth_rad;
  to.pitch_rad = from.pitch_rad;
  to.roll_rad = from.roll_rad;
  to.f_nT = from.f_nT;
  to.f_sd_nT = from.f_sd_nT;
  to.n = from.n;
  to.n_eff = from.n_eff;
  to.mount = from.mount;
  to.sense = from.sense;
  to.dwell_s = from.dwell_s;
  to.since_stop_s = from.since_stop_s;
  to.covariates = from.covariates;
  to.ref_nT = from.ref_nT;
  to.ref_sd_nT = from.ref_sd_nT;
  to.y_nT.assign(from.y_nT.begin(), from.y_nT.end());
  to.sd_nT.assign(from.sd_nT.begin(), from.sd_nT.end());
  to.T_degC.assign(from.T_degC.begin(), from.T_degC.end());
}

}  // namespace

PoseTable pose_table_of(const Survey& survey) {
  PoseTable out;
  out.path = survey.path;
  for (const SurveyRow& row : survey.rows) copy_row(row, out.poses.emplace_back());
  return out;
}

Survey survey_of(const PoseTable& table) {
  const std::size_t sensors = table.poses.empty() ? kSensorCount : table.poses.front().y_nT.size();
  Survey out{.sensors = sensors, .rows = {}, .path = table.path};
  for (const Pose& pose : table.poses) copy_row(pose, out.rows.emplace_back(sensors));
  return out;
}

}  // namespace mgtd::rig
