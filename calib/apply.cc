// SPDX-License-Identifier: Apache-2.0
#include "calib/apply.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

namespace mgtd::calib {
namespace {

constexpr std::array<std::string_view, 6> kComponents{"xx", "yy", "zz", "xy", "xz", "yz"};

std::array<double, 6> in_order(const Gradient& g) { return {g.xx, g.yy, g.zz, g.xy, g.xz, g.yz}; }

std::string header(bool with_time, bool with_sd) {
  std::string out = "pose";
  if (with_time) out += ",t_s";
  for (int i = 1; i <= kSensors; ++i) {
    for (const char axis : {'x', 'y', 'z'}) out += fmt::format(",s{}_b{}_nT", i, axis);
  }
  out += ",Bx_nT,By_nT,Bz_nT,F_nT";
  for (const auto component : kComponents) out += fmt::format(",G{}_nT_per_m", component);
  out += ",curl_nT_per_m,center_x_nT,center_y_nT,center_z_nT";
  if (with_sd) {
    for (const auto component : kComponents) out += fmt::format(",G{}_sd_nT_per_m", component);
    out += ",closure_chi2";
  }
  return out + "\n";
}

}  // namespace

std::vector<AppliedPose> apply(const Calibration& calibration, const PoseTable& table) {
  const TensorPipeline pipeline(std::make_shared<Calibration>(calibration));
  std::vector<AppliedPose> out;
  out.reserve(table.poses.size());
  for (const Pose& pose : table.poses) {
    Epoch epoch;
    epoch.y_nT = pose.y_nT;
    const double samples = std::max(1.0, pose.n_eff.value_or(pose.n.value_or(1)));
    out.push_back({pose.number, pose.t_s, pipeline.correct(pose.y_nT), pipeline.apply(epoch, samples)});
  }
  return out;
}

std::string format_applied(const std::vector<AppliedPose>& rows) {
  const bool with_time =
      std::any_of(rows.begin(), rows.end(), [](const auto& r) { return r.t_s.has_value(); });
  const bool with_sd = !rows.empty() && std::isfinite(rows.front().sample.closure.chi2);
  std::string out = header(with_time, with_sd);
  const auto add = [&](double value) { fmt::format_to(std::back_inserter(out), ",{:.6f}", value); };
  for (const AppliedPose& row : rows) {
    fmt::format_to(std::back_inserter(out), "{}", row.number);
    if (with_time) out += row.t_s ? fmt::format(",{}", *row.t_s) : ",";
    const TensorSample& s = row.sample;
    for (const double b : row.b_P_nT) add(b);
    for (const double b : s.b_P_nT) add(b);
    add(s.f_nT);
    for (const double g : in_order(s.g_nT_per_m)) add(g);
    add(s.closure.curl_nT_per_m);
    for (const double c : s.closure.center_nT) add(c);
    if (with_sd) {
      for (const double sd : in_order(s.g_sd_nT_per_m)) add(sd);
      add(s.closure.chi2);
    }
    out += "\n";
  }
  return out;
}

}  // namespace mgtd::calib
