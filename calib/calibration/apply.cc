// SPDX-License-Identifier: Apache-2.0
#include "calib/calibration/apply.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "calib/calibration/effect_correction.h"
#include "calib/calibration/field_expansion.h"

namespace mgtd::calib::calibration {
namespace {

/// Which columns there are; those that the array cannot tell are left out.
struct AppliedColumns {
  Eigen::Index channels{sensor::kChannels};
  bool time{false}, sd{false}, chi2{false}, left_out{false};
  bool cross{true};  ///< curl and centre
  bool line{false};  ///< the derivative along the line of the sensors
  std::array<bool, 6> measured{};

  explicit AppliedColumns(const std::vector<AppliedPose>& rows) {
    time = std::any_of(rows.begin(), rows.end(), [](const auto& r) { return r.t_s.has_value(); });
    left_out = std::any_of(rows.begin(), rows.end(), [](const auto& r) { return !r.left_out.empty(); });
    measured.fill(true);
    if (rows.empty()) return;
    const TensorSample& first = rows.front().sample;
    channels = rows.front().b_P_nT.size();
    cross = !std::isnan(first.closure.curl_nT_per_m);
    chi2 = std::isfinite(first.closure.chi2);
    line = first.along_line.has_value();
    sd = line && first.along_line->sd_nT_per_m.allFinite();
    const auto g = components(first.g_nT_per_m), g_sd = components(first.g_sd_nT_per_m);
    for (std::size_t i = 0; i < measured.size(); ++i) {
      measured[i] = !std::isnan(g[i]);
      sd = sd || std::isfinite(g_sd[i]);
    }
  }
};

std::string header(const AppliedColumns& columns) {
  std::string out = "pose";
  if (columns.time) out += ",t_s";
  for (Eigen::Index c = 0; c < columns.channels; ++c)
    out += fmt::format(",s{}_b{}_nT", c / 3 + 1, "xyz"[c % 3]);
  out += ",Bx_nT,By_nT,Bz_nT,F_nT";
  const auto add = [&](const char* kind) {
    for (std::size_t i = 0; i < kGradientNames.size(); ++i)
      if (columns.measured[i]) out += fmt::format(",{}{}_nT_per_m", kGradientNames[i], kind);
  };
  const auto add_line = [&](const char* kind) {
    for (const char axis : {'x', 'y', 'z'})
      if (columns.line) out += fmt::format(",dB{}{}_nT_per_m", axis, kind);
  };
  add("");
  add_line("");
  if (columns.cross) out += ",curl_nT_per_m,center_x_nT,center_y_nT,center_z_nT";
  if (columns.sd) add("_sd"), add_line("_sd");
  if (columns.chi2) out += ",closure_chi2";
  if (columns.left_out) out += ",left_out";
  return out + "\n";
}

/// What stops this pose, if anything does.
Result<void> usable(const TensorPipeline& pipeline, const Pose& pose, const ApplyOptions& options) {
  const EffectCorrection* const effects = pipeline.effects();
  if (options.remove_site && (effects == nullptr || !effects->has_site_effects())) {
    return fail(ErrorCode::refused, "the calibration holds no effect of the site",
                "fit with one (mgt fit --with site.gradient), or leave --remove-site out");
  }
  if (options.remove_site && !pose.angles()) {
    return fail(ErrorCode::refused,
                fmt::format("pose {} has no {}, and the site turns with the table", pose.number,
                            effects::missing_angle(pose)),
                "give azimuth_deg, pitch_deg and roll_deg of every pose, or leave --remove-site out");
  }
  if (effects == nullptr || options.missing_ok) return {};
  const auto left_out = effects->left_out(pose, options.remove_site);
  if (left_out.empty()) return {};
  return fail(ErrorCode::refused,
              fmt::format("pose {} has no {}, which {} needs", pose.number, left_out.front().column,
                          left_out.front().effect),
              fmt::format("give the column {}, or leave the effect out with --missing-ok: the standard "
                          "deviations are then wider and the rows say so",
                          left_out.front().column));
}

}  // namespace

Result<std::vector<AppliedPose>> apply(const Calibration& calibration, const PoseTable& table,
                                       const ApplyOptions& options) {
  const TensorPipeline pipeline(std::make_shared<Calibration>(calibration), &table);
  std::vector<AppliedPose> out;
  out.reserve(table.poses.size());
  const Pose* previous = nullptr;
  for (const Pose& pose : table.poses) {
    if (const auto ok = usable(pipeline, pose, options); !ok) return tl::unexpected(ok.error());
    const double samples = std::max(1.0, pose.n_eff.value_or(pose.n.value_or(1)));
    AppliedPose row{pose.number, pose.t_s, {}, {}, {}};
    row.sample = pipeline.apply(pose, samples, options.remove_site, previous, &row.b_P_nT);
    if (row.sample.flags.has(Flag::incomplete)) {
      for (const auto& [effect, column] : pipeline.effects()->left_out(pose, options.remove_site))
        row.left_out.emplace_back(effect);
    }
    out.push_back(std::move(row));
    previous = &pose;
  }
  return out;
}

std::string format_applied(const std::vector<AppliedPose>& rows) {
  const AppliedColumns columns(rows);
  std::string out = header(columns);
  const auto add = [&](double value) { fmt::format_to(std::back_inserter(out), ",{:.6f}", value); };
  for (const AppliedPose& row : rows) {
    fmt::format_to(std::back_inserter(out), "{}", row.number);
    if (columns.time) out += row.t_s ? fmt::format(",{}", *row.t_s) : ",";
    const TensorSample& s = row.sample;
    for (const double b : row.b_P_nT) add(b);
    for (const double b : s.b_P_nT) add(b);
    add(s.f_nT);
    const auto add_components = [&](const Gradient& g) {
      for (std::size_t i = 0; i < columns.measured.size(); ++i)
        if (columns.measured[i]) add(components(g)[i]);
    };
    add_components(s.g_nT_per_m);
    if (s.along_line)
      for (const double d : s.along_line->nT_per_m) add(d);
    if (columns.cross) {
      add(s.closure.curl_nT_per_m);
      for (const double c : s.closure.center_nT) add(c);
    }
    if (columns.sd) add_components(s.g_sd_nT_per_m);
    if (columns.sd && s.along_line)
      for (const double sd : s.along_line->sd_nT_per_m) add(sd);
    if (columns.chi2) add(s.closure.chi2);
    if (columns.left_out) fmt::format_to(std::back_inserter(out), ",{}", fmt::join(row.left_out, ";"));
    out += "\n";
  }
  return out;
}

}  // namespace mgtd::calib::calibration
