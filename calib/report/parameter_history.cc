// SPDX-License-Identifier: Apache-2.0
#include "calib/report/parameter_history.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "calib/report/change_report.h"
#include "calib/report/diff_report.h"
#include "calib/report/figures/parameter_figures.h"
#include "calib/sensor/sensor_model.h"
#include "proto/time.h"

namespace mgtd::calib::report {
namespace {

/// Days since 1970; empty where the text is no time.
std::optional<double> day_of(const std::string& t_utc) {
  const auto t = parse_utc(t_utc);
  if (!t) return std::nullopt;
  constexpr double kNsPerDay = 86400e9;
  return static_cast<double>(t->ns) / kNsPerDay;
}

std::size_t sensors_of(const ParameterMoves& moves) { return moves.diff.change.others_log10_p.size(); }

/// Of one parameter of one sensor; null where it is not among those compared.
const validity::ParameterChange* change_of(const ParameterMoves& moves, std::size_t sensor,
                                           std::string_view parameter) {
  const std::string name = fmt::format("s{} {}", sensor + 1, parameter);
  const auto& all = moves.diff.change.parameters;
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& p) { return p.name == name; });
  return found == all.end() ? nullptr : &*found;
}

/// In standard errors of the difference; NaN where that is not known.
double shift_of(const validity::ParameterChange& p) {
  return p.moved_sd > 0 ? p.moved / p.moved_sd : std::nan("");
}

struct Kind {
  const char* heading;
  std::array<std::string_view, 3> parameters;
  double factor;  ///< from the unit of the change to that of the heading
  int width;
};
constexpr std::array<Kind, 4> kKinds{{{"offset, nT", {"ix", "iy", "iz"}, 1, 18},
                                      {"scale, ppm", {"cx", "cy", "cz"}, 1e6, 16},
                                      {"axes, mdeg", {"theta", "phi", "psi"}, 1e3, 21},
                                      {"turn, mdeg", {"alpha", "beta", "gamma"}, 1e3, 21}}};

/// "iz +0.8 ± 0.2": as many decimals as show one digit of the standard error.
std::string largest_of(const ParameterMoves& moves, std::size_t sensor, const Kind& kind) {
  const validity::ParameterChange* most = nullptr;
  std::string_view name;
  for (const std::string_view parameter : kind.parameters) {
    const validity::ParameterChange* const p = change_of(moves, sensor, parameter);
    if (p == nullptr || !std::isfinite(shift_of(*p))) continue;
    if (most == nullptr || std::abs(shift_of(*p)) > std::abs(shift_of(*most))) most = p, name = parameter;
  }
  if (most == nullptr) return "not told";
  const double sd = kind.factor * most->moved_sd;
  const int decimals = std::clamp(-static_cast<int>(std::floor(std::log10(sd))), 0, 9);
  return fmt::format("{} {:+.{}f} ± {:.{}f}", name, kind.factor * most->moved, decimals, sd, decimals);
}

std::string row_of(std::string heading, const std::array<std::string, kKinds.size()>& cells) {
  for (std::size_t k = 0; k < kKinds.size(); ++k)
    heading += fmt::format(" {:<{}}", cells.at(k), kKinds.at(k).width - 1);
  return heading.substr(0, heading.find_last_not_of(' ') + 1) + '\n';
}

}  // namespace

ParameterMoves moves_between(const calibration::Calibration& from, const calibration::Calibration& to) {
  return {from.id, to.id, to.reference.t_utc, validity::diff(from, to)};
}

std::vector<ParameterMoves> moves_among(std::vector<calibration::Calibration> all) {
  std::erase_if(all, [](const calibration::Calibration& c) { return !day_of(c.reference.t_utc); });
  std::stable_sort(all.begin(), all.end(), [](const auto& a, const auto& b) {
    return *day_of(a.reference.t_utc) < *day_of(b.reference.t_utc);
  });
  std::vector<ParameterMoves> out;
  if (all.empty()) return out;
  const sensor::Geometry array = all.back().geometry;
  std::erase_if(all, [&](const auto& c) { return !c.geometry.agrees_with(array); });
  for (std::size_t i = 1; i < all.size(); ++i) out.push_back(moves_between(all[i - 1], all[i]));
  return out;
}

nlohmann::json to_json(const ParameterMoves& moves) {
  return {{"from", moves.from},
          {"to", moves.to},
          {"t_utc", moves.t_utc},
          {"changed", moves.diff.changed},
          {"conclusion", conclusion_text(moves.diff)},
          {"remarks", remarks_of(moves.diff)},
          {"text", moves_text(moves)},
          {"parameters", to_json(moves.diff.change).at("parameters")}};
}

std::string moves_text(const ParameterMoves& moves) {
  std::string out = fmt::format("{} -> {}, measured {:.16}Z\n{}\n", moves.from, moves.to, moves.t_utc,
                                conclusion_text(moves.diff));
  std::array<std::string, kKinds.size()> cells;
  std::transform(kKinds.begin(), kKinds.end(), cells.begin(), [](const Kind& kind) { return kind.heading; });
  out += row_of("    ", cells);
  for (std::size_t s = 0; s < sensors_of(moves); ++s) {
    std::transform(kKinds.begin(), kKinds.end(), cells.begin(),
                   [&](const Kind& kind) { return largest_of(moves, s, kind); });
    out += row_of(fmt::format("s{:<3}", s + 1), cells);
  }
  for (const std::string& remark : remarks_of(moves.diff)) out += "note: " + remark + '\n';
  return out;
}

std::optional<figures::Figure> history_of(const std::vector<ParameterMoves>& moves) {
  if (moves.empty()) return std::nullopt;
  figures::HistoryValues v{.sensors = {},
                           .parameters = {sensor::kParameterNames.begin(), sensor::kParameterNames.end()}};
  for (std::size_t s = 0; s < sensors_of(moves.back()); ++s) v.sensors.push_back(fmt::format("s{}", s + 1));
  constexpr double kDays = 4;  // within fewer a date alone tells little
  const double first = day_of(moves.front().t_utc).value_or(0), last = day_of(moves.back().t_utc).value_or(0);
  for (const ParameterMoves& m : moves) {
    std::string when = m.t_utc.substr(0, last - first < kDays ? 16 : 10);
    std::replace(when.begin(), when.end(), 'T', ' ');
    figures::HistoryPoint point{.when = std::move(when), .day = day_of(m.t_utc).value_or(0), .shifts = {}};
    for (std::size_t s = 0; s < v.sensors.size(); ++s) {
      std::vector<double>& row = point.shifts.emplace_back();
      for (const std::string& parameter : v.parameters) {
        const validity::ParameterChange* const p = change_of(m, s, parameter);
        row.push_back(p == nullptr ? std::nan("") : shift_of(*p));
      }
    }
    v.points.push_back(std::move(point));
  }
  return figures::history_figure(v);
}

nlohmann::json to_json(const figures::Figure& figure) {
  return {{"name", figure.name},
          {"title", figure.title},
          {"svg", figure.svg},
          {"caption", figure.caption},
          {"good", figure.good}};
}

}  // namespace mgtd::calib::report
