// SPDX-License-Identifier: Apache-2.0
#include "calib/report/run_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "calib/report/described_array.h"
#include "calib/report/figures/accuracy_figure.h"
#include "calib/report/figures/lanes_figure.h"
#include "calib/report/figures/sky_figures.h"
#include "calib/sensor/channels.h"
#include "calib/stats/median.h"
#include "calib/stats/probability.h"

namespace mgtd::calib::report {
namespace {

using criticism::tests::ResidualColumns;

constexpr std::size_t kColumnLanes = 3;

figures::Series time_series(const ResidualColumns& p, std::string name, std::vector<double> y,
                            std::size_t tone) {
  figures::Series out{.name = std::move(name),
                      .x = p.t_h,
                      .y = std::move(y),
                      .tone = figures::sensor_tone(tone),
                      .shape = figures::sensor_shape(tone)};
  for (const Pose* pose : p.pose) out.poses.push_back(pose->number);
  return out;
}

std::vector<double> matrix_row(const Eigen::MatrixXd& m, Eigen::Index row) {
  std::vector<double> out;
  for (Eigen::Index k = 0; k < m.cols(); ++k) out.push_back(m(row, k));
  return out;
}

std::vector<figures::Gap> gaps_of(const std::vector<double>& t_h) {
  std::vector<double> sorted = t_h, steps;
  std::sort(sorted.begin(), sorted.end());
  for (std::size_t i = 1; i < sorted.size(); ++i) steps.push_back(sorted[i] - sorted[i - 1]);
  if (steps.size() < 4) return {};
  const double usual = stats::median(steps);
  std::vector<figures::Gap> out;
  for (std::size_t i = 0; i < steps.size(); ++i)
    if (usual > 0 && steps[i] > 5 * usual)
      out.push_back({sorted[i] + usual / 2, sorted[i + 1] - usual / 2, "no pose"});
  return out;
}

/// Channel of the readings whose residual depends most on time.
int channel_of_time(const PanelModel& model) {
  std::string component = "s1.x";
  for (const auto& channel : model.comparison.channels)
    for (const auto& d : channel.against)
      if (channel.name == "whitened" && d.covariate == "time_h") component = d.component;
  for (int c = 0; c < static_cast<int>(model.left.residual_nT.rows()); ++c)
    if (sensor::channel_name(c) == component) return c;
  return 0;
}

std::string unit_of(const std::string& column) {
  const std::size_t at = column.rfind('_');
  return at == std::string::npos ? "" : column.substr(at + 1);
}

}  // namespace

figures::Figure coverage_of(const PanelModel& model) {
  figures::CoverageValues v;
  const Eigen::Matrix3d R_PS = model.comparison.fit->state.sensors.front().R_PS();
  for (Eigen::Index k = 0; k < model.left.direction_S.cols(); ++k) {
    const Eigen::Vector3d d = model.left.direction_S.block<3, 1>(0, k);
    if (d.allFinite()) v.measured.emplace_back(R_PS * d);
  }
  return figures::coverage_figure(v);
}

figures::Figure time_figure(const PanelModel& model) {
  const ResidualColumns& p = model.left;
  const int c = channel_of_time(model);
  figures::LanesValues v{
      .name = "time",
      .title = "One time axis",
      .what =
          "What happened at the same time. The residual is that of the channel that depends most on time."};
  if (!model.comparison.fit->problem.effects.empty())
    v.what += " The effects of the model are taken out of it.";
  v.gaps = gaps_of(p.t_h);
  const auto add = [&](std::string name, std::string unit, std::vector<figures::Series> series, bool joined) {
    v.lanes.push_back({.name = std::move(name),
                       .unit = std::move(unit),
                       .series = std::move(series),
                       .limit = {},
                       .limit_text = {},
                       .joined = joined});
  };
  add("residual", sensor::channel_name(c) + ", nT",
      {time_series(p, sensor::channel_name(c), matrix_row(p.residual_nT, c),
                   static_cast<std::size_t>(c / 3))},
      false);
  std::vector<figures::Series> temperatures;
  for (std::size_t s = 0; s < static_cast<std::size_t>(p.scalar_nT.rows()); ++s) {
    std::vector<double> T;
    for (const Pose* pose : p.pose) T.push_back(pose->T_degC[s].value_or(std::nan("")));
    if (figures::spread_out(T))
      temperatures.push_back(time_series(p, fmt::format("s{}", s + 1), std::move(T), s));
  }
  if (!temperatures.empty()) add("temperature", "°C", std::move(temperatures), true);
  std::size_t columns = 0;
  for (const auto& [name, values] : p.columns) {
    if (columns == kColumnLanes || !figures::spread_out(values)) continue;
    ++columns;
    add(name, unit_of(name), {time_series(p, name, values, 4)}, true);
  }
  std::vector<double> field;
  for (const Pose* pose : p.pose) field.push_back(pose->f_nT.value_or(std::nan("")));
  const figures::Range all = figures::range_of(field, figures::ScaleKind::linear, 0);
  if (figures::spread_out(field)) {
    const double middle = std::round((all.from + all.to) / 2);
    for (double& f : field) f -= middle;
    add("scalar reference", fmt::format("nT, less {:.0f}", middle),
        {time_series(p, "F", std::move(field), 5)}, false);
  }
  double hours = 0;
  const criticism::tests::Dependence* strongest = nullptr;
  for (const auto& channel : model.comparison.channels)
    for (const auto& d : channel.against)
      if (channel.name == "whitened" && d.covariate == "time_h") strongest = &d, hours = d.to - d.from;
  v.good = fmt::format(
      "the residual stays level while everything else moves. Here, over {:.2f} h with {} gaps, {}.", hours,
      v.gaps.size(),
      strongest == nullptr
          ? "no time was recorded"
          : "a level residual would stray this far with " + stats::p_phrase(strongest->log10_p));
  return figures::lanes_figure(v);
}

std::optional<figures::Figure> closure_figure(const PanelModel& model) {
  const ResidualColumns& p = model.left;
  if (p.closure_nT.rows() == 0) return std::nullopt;
  figures::LanesValues v{
      .name = "closure",
      .title = "Closure at every pose",
      .what =
          "Combinations of the readings that no uniform field and no gradient can make, and their chi-square "
          "against the noise of a pose mean."};
  v.gaps = gaps_of(p.t_h);
  std::vector<figures::Series> parts;
  for (Eigen::Index i = 0; i < std::min<Eigen::Index>(p.closure_nT.rows(), kMostClosures); ++i)
    parts.push_back(time_series(p, p.closure_names[static_cast<std::size_t>(i)], matrix_row(p.closure_nT, i),
                                static_cast<std::size_t>(i)));
  v.lanes.push_back(
      {.name = "closure", .unit = "nT", .series = std::move(parts), .limit = {}, .limit_text = {}});
  const auto dof = static_cast<double>(p.closure_nT.rows());
  const std::vector<double> chi2(p.closure_chi2.begin(), p.closure_chi2.end());
  const double limit = closure_limit(dof);
  v.lanes.push_back({.name = "chi-square",
                     .unit = fmt::format("{:.0f} d.o.f.", dof),
                     .series = {time_series(p, "chi-square", chi2, 0)},
                     .limit = limit,
                     .limit_text = "1 of 1000",
                     .log = true});
  const auto above = std::count_if(chi2.begin(), chi2.end(), [&](double x) { return x > limit; });
  v.good = fmt::format("chi-square above {:.1f} in one pose of a thousand. Here it is in {} of {}.", limit,
                       above, chi2.size());
  figures::Figure out = figures::lanes_figure(v);
  out.stands_out = static_cast<double>(above) > 2 + 0.003 * static_cast<double>(chi2.size());
  return out;
}

std::optional<figures::Figure> accuracy_of(const PoseTable& table, const fit::FitOptions& options,
                                           std::optional<double> wanted_nT_per_m) {
  if (table.poses.size() > kMostPosesForAccuracy || table.poses.empty()) return std::nullopt;
  if (described(options.geometry).gradient.empty()) return std::nullopt;
  const bool timed =
      std::all_of(table.poses.begin(), table.poses.end(), [](const Pose& p) { return p.t_s.has_value(); });
  figures::AccuracyValues v{.x_label = timed ? "time since the start, min" : "poses",
                            .wanted_nT_per_m = wanted_nT_per_m};
  std::optional<fit::joint::JointState> start;
  const double n = static_cast<double>(table.poses.size());
  constexpr int kSteps = 9;
  std::size_t before = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const auto count = static_cast<std::size_t>(
        std::lround(n * std::pow(16 / std::max(n, 17.0), 1 - i / static_cast<double>(kSteps))));
    if (count <= before) continue;
    before = count;
    PoseTable part;
    part.poses.assign(table.poses.begin(), table.poses.begin() + static_cast<std::ptrdiff_t>(count));
    const auto so_far = fit::joint::accuracy_so_far(part, options, start ? &*start : nullptr);
    if (!so_far || !(so_far->worst_nT_per_m() > 0)) continue;
    start = so_far->state;
    v.poses.push_back(so_far->poses);
    v.x.push_back(timed ? (part.poses.back().t_s.value_or(0) - table.poses.front().t_s.value_or(0)) / 60
                        : static_cast<double>(so_far->poses));
    v.worst_nT_per_m.push_back(so_far->worst_nT_per_m());
  }
  return figures::accuracy_figure(v);
}

}  // namespace mgtd::calib::report
