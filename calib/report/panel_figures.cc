// SPDX-License-Identifier: Apache-2.0
#include "calib/report/panel_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "calib/criticism/tests/residual_shape.h"
#include "calib/report/figures/residual_figure.h"
#include "calib/report/figures/scatter_figures.h"
#include "calib/report/figures/sky_figures.h"
#include "calib/report/named_columns.h"
#include "calib/sensor/channels.h"
#include "calib/stats/probability.h"
#include "proto/units.h"

namespace mgtd::calib::report {
namespace {

using criticism::tests::Comparison;
using criticism::tests::Dependence;
using criticism::tests::ResidualColumns;

constexpr double kFollows_log10_p = -3;
constexpr std::size_t kMostColumns = 4;

/// Of a channel over a covariate, or over the one that orders the poses as it does; null: not recorded.
const Dependence* dependence(const Comparison& c, std::string_view channel, std::string_view covariate) {
  for (const auto& [name, shown] : c.alike)
    if (name == covariate) covariate = shown;
  for (const auto& each : c.channels) {
    if (each.name != channel) continue;
    for (const Dependence& d : each.against)
      if (d.covariate == covariate) return &d;
  }
  return nullptr;
}

std::string p_of(const PanelModel& model, std::string_view channel, std::string_view covariate) {
  const Dependence* const d = dependence(model.comparison, channel, covariate);
  return d == nullptr ? "" : stats::p_phrase(d->log10_p);
}

bool follows(const PanelModel& model, std::string_view channel, std::string_view covariate) {
  const Dependence* const d = dependence(model.comparison, channel, covariate);
  return d != nullptr && d->log10_p < kFollows_log10_p;
}

std::vector<double> row_of(const Eigen::MatrixXd& m, Eigen::Index row) {
  std::vector<double> out;
  for (Eigen::Index k = 0; k < m.cols(); ++k) out.push_back(m(row, k));
  return out;
}

std::vector<int> numbers_of(const ResidualColumns& p) {
  std::vector<int> out;
  for (const Pose* pose : p.pose) out.push_back(pose->number);
  return out;
}

template <typename Value>
std::vector<double> by_pose(const ResidualColumns& p, Value value) {
  std::vector<double> out;
  for (const Pose* pose : p.pose) {
    const std::optional<double> v = value(*pose);
    out.push_back(v.value_or(std::nan("")));
  }
  return out;
}

bool any(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

int channel_index(const std::string& name, int channels) {
  for (int c = 0; c < channels; ++c)
    if (sensor::channel_name(c) == name) return c;
  return 0;
}

figures::Series series_of(const ResidualColumns& p, std::string name, std::vector<double> x,
                          std::vector<double> y, std::size_t sensor, int left_out_channel) {
  figures::Series out{.name = std::move(name),
                      .x = std::move(x),
                      .y = std::move(y),
                      .poses = numbers_of(p),
                      .tone = figures::sensor_tone(sensor),
                      .shape = figures::sensor_shape(sensor)};
  if (left_out_channel >= 0) {
    out.hollow.assign(p.pose.size(), false);
    for (std::size_t k = 0; k < p.pose.size(); ++k)
      out.hollow[k] = std::isnan(p.whitened(left_out_channel, static_cast<Eigen::Index>(k)));
  }
  return out;
}

/// Residual of one reading, nT, against something.
figures::Figure channel_panel(const PanelModel& before, const PanelModel* after, figures::ResidualValues v,
                              const std::vector<double>& x, const std::string& covariate) {
  const Dependence* const d = dependence(before.comparison, "whitened", covariate);
  const int c =
      channel_index(d == nullptr ? "s1.x" : d->component, static_cast<int>(before.left.residual_nT.rows()));
  const std::string name = sensor::channel_name(c);
  v.y_label = "residual of " + name + ", nT";
  v.what = fmt::format(
      "Reading less prediction of {}, the channel that depends most; hollow: left out by the fit.", name);
  for (const PanelModel* model : {&before, after}) {
    if (model == nullptr) continue;
    figures::ResidualView& view = model == &before ? v.before : v.after;
    view.series = {series_of(model->left, name, x, row_of(model->left.residual_nT, c),
                             static_cast<std::size_t>(c / 3), c)};
    view.p_text = p_of(*model, "whitened", covariate);
  }
  v.stands_out = follows(after == nullptr ? before : *after, "whitened", covariate);
  return figures::residual_figure(v);
}

/// Several rows of one matrix, each a series.
figures::Figure rows_panel(const PanelModel& before, const PanelModel* after, figures::ResidualValues v,
                           const std::vector<double>& x, const Eigen::MatrixXd ResidualColumns::*rows,
                           const std::vector<std::string>& names, std::string_view channel,
                           const std::string& covariate) {
  for (const PanelModel* model : {&before, after}) {
    if (model == nullptr) continue;
    figures::ResidualView& view = model == &before ? v.before : v.after;
    for (std::size_t i = 0; i < names.size(); ++i) {
      std::vector<double> y = row_of(model->left.*rows, static_cast<Eigen::Index>(i));
      if (any(y)) view.series.push_back(series_of(model->left, names[i], x, std::move(y), i, -1));
    }
    view.p_text = p_of(*model, channel, covariate);
  }
  v.stands_out = follows(after == nullptr ? before : *after, channel, covariate);
  return figures::residual_figure(v);
}

/// An array of many sensors has more of them than can be told apart in a figure.
std::vector<std::string> shown_closures(const ResidualColumns& p) {
  return {p.closure_names.begin(), p.closure_names.begin() + static_cast<std::ptrdiff_t>(std::min(
                                                                 p.closure_names.size(), kMostClosures))};
}

figures::Figure skies_of(const PanelModel& before, const PanelModel* after) {
  const auto sensors = static_cast<std::size_t>(before.left.scalar_nT.rows());
  figures::SkiesValues v{
      .what = "|b| of each sensor less the field of the pose: blind to every error of angles."};
  for (std::size_t s = 0; s < sensors; ++s) {
    const auto row = static_cast<Eigen::Index>(s);
    figures::Sky sky{.sensor = fmt::format("s{}", s + 1)};
    for (Eigen::Index k = 0; k < before.left.direction_S.cols(); ++k)
      sky.directions.emplace_back(before.left.direction_S.block<3, 1>(3 * row, k));
    sky.residual_nT = row_of(before.left.scalar_nT, row);
    if (after != nullptr) sky.after_nT = row_of(after->left.scalar_nT, row);
    sky.poses = numbers_of(before.left);
    v.skies.push_back(std::move(sky));
  }
  for (const auto& map : (after == nullptr ? before : *after).comparison.maps)
    if (map.map == "direction") v.stands_out = map.log10_p < kFollows_log10_p;
  return figures::skies_figure(v);
}

figures::QqView quantiles_of(const PanelModel& model) {
  const auto q = criticism::tests::residual_quantiles(*model.comparison.fit);
  return {.n = q.n, .quantile = q.quantile, .residual = q.residual, .low = q.low, .high = q.high};
}

/// The temperature of the sensor whose residual follows a temperature most; of any where that sensor has
/// none.
std::optional<std::size_t> sensor_of_temperature(const PanelModel& model) {
  const auto sensors = static_cast<std::size_t>(model.left.scalar_nT.rows());
  std::vector<bool> moves;
  for (std::size_t s = 0; s < sensors; ++s)
    moves.push_back(figures::spread_out(by_pose(model.left, [&](const Pose& p) { return p.T_degC[s]; })));
  std::optional<std::size_t> out;
  double best = 1;
  std::string follower;
  for (std::size_t s = 0; s < sensors; ++s) {
    if (!moves[s]) continue;
    const Dependence* const d = dependence(model.comparison, "whitened", fmt::format("s{}_T_degC", s + 1));
    const double log10_p = d == nullptr ? 0.5 : d->log10_p;
    if (log10_p < best) best = log10_p, out = s, follower = d == nullptr ? "" : d->component;
  }
  for (std::size_t s = 0; s < sensors; ++s)
    if (moves[s] && follower.starts_with(fmt::format("s{}.", s + 1))) return s;
  return out;
}

}  // namespace

std::vector<figures::Figure> panel_figures(const PanelModel& before, const PanelModel* after) {
  const ResidualColumns& p = before.left;
  const auto sensors = static_cast<std::size_t>(p.scalar_nT.rows());
  std::vector<figures::Figure> out;
  const std::string after_title = "with the effects",
                    before_title = after == nullptr ? "as fitted" : "without effects";
  const auto values = [&](std::string name, std::string title, std::string x_label, std::string y_label = "",
                          std::string what = "") {
    return figures::ResidualValues{.name = std::move(name),
                                   .title = std::move(title),
                                   .x_label = std::move(x_label),
                                   .y_label = std::move(y_label),
                                   .what = std::move(what),
                                   .before_title = before_title,
                                   .after_title = after_title};
  };
  out.push_back(channel_panel(before, after,
                              values("residual-time", "Residual against time", "time since the start, h"),
                              p.t_h, "time_h"));
  const auto azimuth = by_pose(p, [](const Pose& pose) {
    return pose.azimuth_rad ? std::optional(to_deg(*pose.azimuth_rad)) : std::nullopt;
  });
  if (any(azimuth)) {
    auto v = values("residual-azimuth", "Residual against azimuth", "azimuth of the table, deg");
    v.angle_deg = true;
    out.push_back(channel_panel(before, after, std::move(v), azimuth, "azimuth_deg"));
  }
  if (const auto s = sensor_of_temperature(before)) {
    out.push_back(channel_panel(
        before, after,
        values("residual-temperature", fmt::format("Residual against the temperature of s{}", *s + 1),
               fmt::format("temperature of s{}, °C", *s + 1)),
        by_pose(p, [&](const Pose& pose) { return pose.T_degC[*s]; }), fmt::format("s{}_T_degC", *s + 1)));
  }
  out.push_back(skies_of(before, after));
  figures::QqValues qq{
      .before = quantiles_of(before), .after = {}, .left_out = before.comparison.outliers.size()};
  if (after != nullptr) qq.after = quantiles_of(*after);
  out.push_back(figures::qq_figure(qq));
  const auto memory = criticism::tests::residual_autocorrelation(*before.comparison.fit);
  figures::AutocorrelationValues r{.sensors = sensor_names(static_cast<Eigen::Index>(sensors)),
                                   .before = memory.by_sensor,
                                   .after = {},
                                   .bound = memory.bound,
                                   .rho = (after == nullptr ? before : *after).comparison.noise.rho};
  if (after != nullptr)
    r.after = criticism::tests::residual_autocorrelation(*after->comparison.fit).by_sensor;
  out.push_back(figures::autocorrelation_figure(r));
  out.push_back(rows_panel(
      before, after,
      values("residual-scalar", "Scalar residual against time", "time since the start, h", "|b| − F, nT",
             "|b| of each sensor less the field of the pose: blind to every error of angles."),
      p.t_h, &ResidualColumns::scalar_nT, sensor_names(static_cast<Eigen::Index>(sensors)), "scalar",
      "time_h"));
  if (p.attitude_deg.array().isFinite().any() && before.comparison.fit->problem.has_angles) {
    auto v = values("residual-attitude", "Corrections of the table angles against azimuth",
                    "azimuth of the table, deg", "correction, deg",
                    "What the table angles had to be corrected by, about the axes of the platform: blind to "
                    "the sensors.");
    v.angle_deg = true;
    out.push_back(rows_panel(before, after, std::move(v), any(azimuth) ? azimuth : p.t_h,
                             &ResidualColumns::attitude_deg, {"x", "y", "z"}, "attitude", "azimuth_deg"));
  }
  if (p.closure_nT.rows() > 0)
    out.push_back(rows_panel(
        before, after,
        values("residual-closure", "Closure against time", "time since the start, h", "closure, nT",
               fmt::format("What no uniform field and no gradient can make: zero in any gradient ({} of {} "
                           "combinations).",
                           shown_closures(p).size(), p.closure_names.size())),
        p.t_h, &ResidualColumns::closure_nT, shown_closures(p), "closure", "time_h"));
  std::size_t extra = 0;
  for (const auto& [name, column] : p.columns) {
    if (extra >= kMostColumns || !follows(before, "whitened", name) || !any(column)) continue;
    if (dependence(before.comparison, "whitened", name)->covariate != name) continue;
    out.push_back(channel_panel(
        before, after, values("residual-" + std::to_string(++extra), "Residual against " + name, name),
        column, name));
  }
  return out;
}

}  // namespace mgtd::calib::report
