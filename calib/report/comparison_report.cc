// SPDX-License-Identifier: Apache-2.0
#include "calib/report/comparison_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "calib/fit/joint/table_ceiling.h"
#include "calib/report/explain_json.h"
#include "calib/report/noise_text.h"
#include "calib/report/outlier_text.h"
#include "calib/report/residual_words.h"
#include "calib/stats/probability.h"
#include "proto/json_text.h"
#include "proto/units.h"

namespace mgtd::calib::report {
namespace {

using nlohmann::json;

json axes_json(const calibration::AxisNoise& n) {
  json out = json::array();
  for (Eigen::Index i = 0; i < n.rows(); ++i) out.push_back({n(i, 0), n(i, 1), n(i, 2)});
  return out;
}

json channel_json(const criticism::tests::ResidualChannel& c) {
  json against = json::array();
  for (const criticism::tests::Dependence& d : c.against) {
    against.push_back({{"covariate", d.covariate},
                       {"component", d.component},
                       {"p", std::pow(10.0, d.log10_p)},
                       {"log10_p", d.log10_p},
                       {"means", d.means},
                       {"ses", d.ses},
                       {"centers", d.centers},
                       {"from", d.from},
                       {"to", d.to}});
  }
  return {{"channel", c.name},
          {"unit", c.unit},
          {"meaning", c.meaning},
          {"rms", c.rms},
          {"against", std::move(against)}};
}

/// Means as a row of blocks, lowest to highest of the row.
std::string plot(const std::vector<double>& means) {
  static constexpr std::array<const char*, 8> kBlocks{"▁", "▂", "▃", "▄", "▅", "▆", "▇", "█"};
  if (means.empty()) return "";
  const auto [low, high] = std::minmax_element(means.begin(), means.end());
  std::string out;
  for (const double m : means) {
    const double share = *high > *low ? (m - *low) / (*high - *low) : 0.5;
    out += kBlocks[static_cast<std::size_t>(std::min(7.0, 8 * share))];
  }
  return out;
}

std::string noise_text(const criticism::tests::Comparison& c) {
  std::string out = fmt::format("residual   {:.3g} nT: {}\n", c.residual_nT, kResidualIs);
  out += fmt::format("noise      {:.3g} nT of a pose mean, {}\n", c.noise_nT, noise_source(c.noise.known));
  if (const std::string tests = noise_of_tests(c.noise); !tests.empty())
    out += fmt::format("           {}\n", tests);
  out += fmt::format(
      "chi-square {:.4g} with {:.0f} degrees of freedom, of readings, scalar reference and table angles{}\n",
      c.chi2, c.dof, c.log10_p ? "; " + stats::p_phrase(*c.log10_p) : "");
  if (c.noise.revisits) {
    const criticism::tests::PureError& p = *c.noise.revisits;
    out += fmt::format(
        "revisits   {} pairs of one attitude scatter {:.2f} times that noise; lack of fit F = {:.2f}, {}: ",
        p.pairs, std::sqrt(p.ratio), p.F, stats::p_phrase(p.log10_p));
    out += fmt::format("the model misses {:.2g} nT rms beyond that scatter\n", p.model_nT);
  } else {
    out +=
        "revisits   none: without one, lack of fit cannot be told from an assumed noise that is too small\n";
  }
  out += fmt::format("poses      correlated {:.2f} from one to the next", c.noise.rho);
  if (c.table_sd_deg > 0)
    out += fmt::format("; table angles good to {:.3g} deg{} each, estimated", c.table_sd_deg,
                       fit::joint::or_more(to_rad(c.table_sd_deg)));
  return out + "\n";
}

/// A line for each covariate, beside the name of its channel; below it where that is too wide.
std::string channel_table(const std::vector<criticism::tests::ResidualChannel>& channels, std::size_t width) {
  constexpr std::size_t kBeside = 80;
  const auto row = [width](const std::string& channel, const std::string& dependence) {
    if (width >= kBeside) return fmt::format("{:<26}  {}\n", channel, dependence);
    return (channel.empty() ? "" : channel + "\n") + "  " + dependence + "\n";
  };
  std::string out = row(fmt::format("{:<13} {:>12}", "channel", "rms"),
                        fmt::format("{:<12} {:<9} {:>8}  means, low to high", "against", "strongest", "p"));
  for (const criticism::tests::ResidualChannel& channel : channels) {
    std::string name = fmt::format("{:<13} {:>8.3g} {:<4}", channel.name, channel.rms, channel.unit);
    if (channel.against.empty()) out += row(name, "nothing recorded that it could depend on");
    for (const criticism::tests::Dependence& d : channel.against) {
      out += row(name, fmt::format("{:<12} {:<9} {:>8}  {}", d.covariate, d.component,
                                   stats::p_text(d.log10_p), plot(d.means)));
      name.clear();
    }
  }
  return out;
}

}  // namespace

std::vector<std::string> alike_text(const criticism::tests::Comparison& c) {
  std::map<std::string, std::vector<std::string>> by_shown;
  for (const auto& [name, shown] : c.alike) by_shown[shown].push_back(name);
  std::vector<std::string> out;
  for (const auto& [shown, names] : by_shown) {
    out.push_back(fmt::format("{} {} the poses as {} does: shown once, these poses do not tell them apart",
                              fmt::join(names, ", "), names.size() == 1 ? "orders" : "order", shown));
  }
  return out;
}

json to_json(const criticism::tests::Comparison& c) {
  json channels = json::array(), maps = json::array(), outliers = json::array(), lack, alike = json::array();
  for (const auto& [name, shown] : c.alike) alike.push_back({{"covariate", name}, {"as", shown}});
  for (const criticism::tests::ResidualChannel& channel : c.channels)
    channels.push_back(channel_json(channel));
  for (const criticism::tests::MapScore& map : c.maps) maps.push_back(to_json(map));
  for (const fit::OutlierNode& o : c.outliers)
    outliers.push_back({{"pose", o.pose}, {"where", o.where}, {"shift", o.shift}, {"unit", o.unit}});
  if (c.noise.revisits) {
    const criticism::tests::PureError& p = *c.noise.revisits;
    lack = {{"F", p.F}, {"p", std::pow(10.0, p.log10_p)}, {"model_nT", p.model_nT}, {"pairs", p.pairs}};
  }
  return {{"schema", "mgt.compare/1"},
          {"fits", c.fits},
          {"residual_nT", c.residual_nT},
          {"noise_nT", c.noise_nT},
          {"noise", to_json(c.noise)},
          {"axis_noise_nT", axes_json(c.axis_noise_nT)},
          {"axis_residual_nT", axes_json(c.axis_residual_nT)},
          {"chi2", c.chi2},
          {"dof", c.dof},
          {"p", c.log10_p ? json(std::pow(10.0, *c.log10_p)) : json()},
          {"log10_p", or_null(c.log10_p)},
          {"table_sd_deg", c.table_sd_deg},
          {"lack_of_fit", std::move(lack)},
          {"channels", std::move(channels)},
          {"alike", std::move(alike)},
          {"maps", std::move(maps)},
          {"outliers", std::move(outliers)}};
}

std::string to_text(const criticism::tests::Comparison& c, std::size_t width) {
  std::string out = noise_text(c) + "\n" + channel_table(c.channels, width);
  const auto to = std::back_inserter(out);
  for (const std::string& line : alike_text(c)) fmt::format_to(to, "  {}\n", line);
  for (const criticism::tests::ResidualChannel& channel : c.channels)
    fmt::format_to(to, "  {:<13} {}\n", channel.name, channel.meaning);
  fmt::format_to(to, "\n{:<26}  {:<12} {:>3} {:>8}\n", "map of the residual", "where", "k", "p");
  for (const criticism::tests::MapScore& m : c.maps)
    fmt::format_to(to, "{:<26}  {:<12} {:>3} {:>8}\n", m.map, m.where, m.k, stats::p_text(m.log10_p));
  for (const std::string& text : outlier_texts(c.outliers)) fmt::format_to(to, "left out: {}\n", text);
  out += c.fits ? "\nthe model fits to the noise\n" : "\nthe model does not fit: mgt explain asks why\n";
  return out;
}

}  // namespace mgtd::calib::report
