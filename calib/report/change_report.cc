// SPDX-License-Identifier: Apache-2.0
#include "calib/report/change_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>

#include "calib/report/column_blocks.h"
#include "calib/report/json_number.h"
#include "calib/stats/probability.h"
#include "proto/units.h"

namespace mgtd::calib::report {
namespace {

using nlohmann::json;

json parameter_json(const validity::ParameterChange& p) {
  json out{{"name", p.name},
           {"change", number_or_null(p.change)},
           {"sd", number_or_null(p.sd)},
           {"unit", p.unit},
           {"sigmas", p.sigmas},
           {"log10_p", p.log10_p}};
  if (p.moved_sd > 0) {
    out["moved"] = number_or_null(p.moved);
    out["moved_sd"] = number_or_null(p.moved_sd);
  }
  if (p.seen > 0 && std::isfinite(p.seen)) out["smallest_seen"] = p.seen;
  return out;
}

/// Scale factors are written in parts per million, where their changes live.
std::string amount(double value, const std::string& unit, bool sign) {
  const double shown = unit.empty() ? 1e6 * value : value;
  return fmt::format("{}{:.3g} {}", sign && value > 0 ? "+" : "", shown, unit.empty() ? "ppm" : unit);
}

}  // namespace

json to_json(const validity::Change& c) {
  json sensors = json::array(), named = json::array(), parameters = json::array();
  for (std::size_t i = 0; i < c.others_log10_p.size(); ++i)
    sensors.push_back({{"sensor", fmt::format("s{}", i + 1)}, {"others_log10_p", c.others_log10_p[i]}});
  for (const validity::ParameterChange& p : c.named) named.push_back(parameter_json(p));
  for (const validity::ParameterChange& p : c.parameters) parameters.push_back(parameter_json(p));
  return {{"chi2", c.chi2},
          {"dof", c.dof},
          {"log10_p", c.log10_p},
          {"log10_p_single", c.log10_p_single},
          {"p", c.p()},
          {"sensors", std::move(sensors)},
          {"named", std::move(named)},
          {"parameters", std::move(parameters)}};
}

std::string figures_text(const validity::Change& c) {
  return fmt::format("{}; chi-square {:.1f} for {:.0f} directions", stats::p_phrase(std::log10(c.p())),
                     c.chi2, c.dof);
}

std::string named_text(const validity::Change& change) {
  std::string out;
  for (const validity::ParameterChange& n : change.named) {
    out += fmt::format("{}{} by {} ({:.1f} sigma)", out.empty() ? "" : ", ", n.name,
                       amount(n.change, n.unit, true), std::abs(n.sigmas));
  }
  return out;
}

std::string turn_text(const validity::CommonTurn& turn) {
  const auto rounded = [](double deg) { return std::round(deg * 1e4) / 1e4 + 0.0; };  // no sign of a zero
  std::string out = "turn of the whole array, which is no change of its calibration:";
  for (int axis = 0; axis < 3; ++axis) {
    out += fmt::format("{} {:.4f} ± {:.4f}", axis == 0 ? "" : ",", rounded(to_deg(turn.about_rad[axis])),
                       to_deg(turn.sd_rad[axis]));
  }
  return out + " deg about X, Y, Z";
}

std::string change_table(const validity::Change& change, std::size_t rows, std::size_t width) {
  const PerSensor<double>& others = change.others_log10_p;
  std::string out =
      others.size() == 1
          ? "alpha, beta and gamma are not judged: of one sensor they are the turn of the whole array"
          : "if only this sensor had changed, would the others still agree?";
  for (std::size_t i = 0; others.size() > 1 && i < others.size(); ++i)
    out += fmt::format("   s{} {}", i + 1, stats::p_phrase(others[i]));
  std::vector<NamedRow> table{{"if only it had changed", {"by", "sd", "sigmas", "smallest to be seen"}}};
  for (std::size_t j = 0; j < std::min(rows, change.parameters.size()); ++j) {
    const validity::ParameterChange& p = change.parameters[j];
    table.push_back(
        {p.name,
         {amount(p.change, p.unit, true), amount(p.sd, p.unit, false), fmt::format("{:.1f}", p.sigmas),
          std::isfinite(p.seen) ? amount(p.seen, p.unit, false) : "none"}});
  }
  return out + "\n\n" + column_blocks(table, width);
}

std::string seen_text(const validity::Change& change) {
  struct Kind {
    const char* what;
    const char* keys;
    std::string unit;
    std::optional<double> worst{};
  };
  std::array<Kind, 4> kinds{{{"offset", " ix iy iz ", "nT"},
                             {"scale factor", " cx cy cz ", ""},
                             {"angle between axes", " theta phi psi ", "deg"},
                             {"turn of a sensor", " alpha beta gamma ", "deg"}}};
  for (const validity::ParameterChange& p : change.parameters) {
    const std::size_t space = p.name.find(' ');  // "s10 ix"
    if (p.name[0] != 's' || space == std::string::npos) continue;
    for (Kind& kind : kinds) {
      if (std::string_view(kind.keys).find(p.name.substr(space) + " ") != std::string_view::npos)
        kind.worst = std::max(kind.worst.value_or(0), p.seen);
    }
  }
  std::string out;
  for (const Kind& kind : kinds) {
    out += fmt::format(
        "{}{} {}", out.empty() ? "" : ", ", kind.what,
        kind.worst && std::isfinite(*kind.worst) ? amount(*kind.worst, kind.unit, false) : "not at all");
  }
  return out;
}

}  // namespace mgtd::calib::report
