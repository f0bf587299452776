// SPDX-License-Identifier: Apache-2.0
#include "calib/report/experiment_design_report.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "calib/calibration/scale_gauge.h"
#include "calib/fit/checks/identifiability_text.h"
#include "calib/fit/joint/joint_setup.h"
#include "calib/report/column_blocks.h"
#include "calib/report/experiment_power_report.h"
#include "calib/report/json_number.h"
#include "calib/report/shown_number.h"
#include "calib/sensor/shown_parameters.h"
#include "proto/units.h"

namespace mgtd::calib::report {
namespace {

using nlohmann::json;

json tensor_components(const Gradient& g) {
  return {{"xx", number_or_null(g.xx)}, {"yy", number_or_null(g.yy)}, {"zz", number_or_null(g.zz)},
          {"xy", number_or_null(g.xy)}, {"xz", number_or_null(g.xz)}, {"yz", number_or_null(g.yz)}};
}

json angles_json(const TableAngles& a) {
  return {{"azimuth_deg", to_deg(a.azimuth_rad)},
          {"pitch_deg", to_deg(a.pitch_rad)},
          {"roll_deg", to_deg(a.roll_rad)}};
}

NamedRow tensor_row(const char* what, const Gradient& g) {
  NamedRow row{what, {}};
  for (const double sd : {g.xx, g.yy, g.zz, g.xy, g.xz, g.yz}) row.cells.push_back(shown_number(sd, 1, 3));
  return row;
}

std::string tensor_table(const design::DesignReport& r, std::size_t width) {
  return "standard error of the tensor, nT/m\n" +
         column_blocks({{"", {"xx", "yy", "zz", "xy", "xz", "yz"}},
                        tensor_row("by the calibration", r.tensor_sd_nT_per_m),
                        tensor_row("by the noise of one pose mean", r.noise_sd_nT_per_m)},
                       width);
}

/// Of an array that sees no gradient.
std::string field_table(const design::DesignReport& r) {
  return fmt::format("{:<39}each component\n{:<34}{:>19.3g}\n{:<34}{:>19.3g}\n",
                     "standard error of the field, nT", "by the calibration", r.field_sd_nT.value_or(0),
                     "by the noise of one pose mean", r.assumed.pose_noise_nT);
}

/// Scale factors in parts per million.
std::string amount(const design::Expected& e) {
  return e.unit.empty() ? fmt::format("{:.3g} ppm", 1e6 * e.sd) : fmt::format("{:.3g} {}", e.sd, e.unit);
}

std::string parameter_table(const design::DesignReport& r, std::size_t width) {
  std::vector<NamedRow> rows{{"standard error", {}}};
  for (std::size_t i = 1; i <= r.sensors; ++i) rows.front().cells.push_back(fmt::format("s{}", i));
  for (std::size_t p = 0; p < sensor::kSensorParameters; ++p) {
    NamedRow& row = rows.emplace_back(NamedRow{sensor::shown_parameters()[p].name, {}});
    for (std::size_t i = 0; i < r.sensors; ++i)
      row.cells.push_back(amount(r.parameters[i * sensor::kSensorParameters + p]));
  }
  std::string out = column_blocks(rows, width);
  for (std::size_t j = r.sensors * sensor::kSensorParameters; j < r.parameters.size(); ++j) {
    const design::Separation& s = r.separations[j - r.sensors * sensor::kSensorParameters];
    out +=
        fmt::format("{:<28}{:>18}   {:.2f} times what it would be alone; most like {} ({:.2f})\n",
                    r.parameters[j].name, amount(r.parameters[j]), s.inflation, s.alternative, s.correlation);
  }
  return out;
}

std::string weak_list(const design::DesignReport& r) {
  if (r.known.weak.empty()) return {};
  std::string out = "weakly known\n";
  for (const fit::joint::WeakDirection& w : r.known.weak) {
    out += fmt::format("  {}: {}\n", fit::checks::to_text(w), fit::checks::weak_sd_text(w.sd_nT));
  }
  out += fmt::format("  {}\n", fit::checks::to_text(r.known.coverage));
  return out;
}

std::string help_list(const design::DesignReport& r) {
  std::string out = "poses that would help most\n";
  if (!r.known.add.empty()) {
    for (const TableAngles& a : r.known.add) out += fmt::format("  {}\n", fit::checks::to_text(a));
    return out;
  }
  for (const design::DesignReport::Helpful& h : r.helpful) {
    out += fmt::format("  {:<38} takes {:.1f} % off the {}'s variance\n", fit::checks::to_text(h.angles),
                       100 * h.share, r.sees_gradient() ? "tensor" : "field");
  }
  return out;
}

std::string gauge_text(const fit::joint::Gauge& gauge) {
  std::string out;
  switch (gauge.angles) {
    case fit::joint::AngleCoverage::none:
      out = "the angles do not fix the platform frame: mean alpha = beta = gamma = 0 by convention";
      break;
    case fit::joint::AngleCoverage::one_axis:
      out = "the angles turn about one axis: mean gamma = 0 by convention";
      break;
    case fit::joint::AngleCoverage::full:
      out = "the table angles fix the platform frame";
      break;
  }
  return gauge.scale_known ? out : fmt::format("{}; no field is known: {}", out, calibration::kScaleIsFree);
}

std::string assumed_text(const design::DesignAssumptions& r) {
  const std::string field =
      r.scalar_sd_nT ? fmt::format("a scalar reference to {} nT", *r.scalar_sd_nT)
      : r.field_known
          ? fmt::format("known to {} nT", std::max(r.field_sd_nT, fit::joint::kCommonFieldSpread_nT))
          : std::string("not known");
  return fmt::format(
      "field {:.0f} nT, {}; inclination {:.1f} deg; noise {} nT of a pose mean; table {} deg; heads that "
      "warm "
      "by {} degC where the poses tell no temperature",
      r.f_nT, field, to_deg(r.inclination_rad), r.pose_noise_nT, to_deg(r.table_sd_rad), r.warming_degC);
}

}  // namespace

json to_json(const design::DesignReport& r) {
  json parameters = json::array(), separations = json::array(), weak = json::array(), add = json::array(),
       helpful = json::array();
  for (const design::Expected& e : r.parameters)
    parameters.push_back({{"name", e.name}, {"sd", e.sd}, {"unit", e.unit}});
  for (const design::Separation& s : r.separations) {
    separations.push_back({{"name", s.name},
                           {"inflation", s.inflation},
                           {"rival", s.alternative},
                           {"correlation", s.correlation}});
  }
  for (const fit::joint::WeakDirection& w : r.known.weak)
    weak.push_back({{"what", fit::checks::to_text(w)}, {"sd_nT", number_or_null(w.sd_nT)}});
  for (const TableAngles& a : r.known.add) add.push_back(angles_json(a));
  for (const design::DesignReport::Helpful& h : r.helpful) {
    helpful.push_back(angles_json(h.angles));
    helpful.back()["variance_share"] = h.share;
  }
  json out{{"schema", "mgt.plan/1"},
           {"poses", r.poses},
           {"determined", r.determined},
           {"assumed", assumed_text(r.assumed)},
           {"gauge", gauge_text(r.gauge)},
           {"parameters", std::move(parameters)},
           {"separations", std::move(separations)},
           {"tensor_sd_nT_per_m", tensor_components(r.tensor_sd_nT_per_m)},
           {"noise_sd_nT_per_m", tensor_components(r.noise_sd_nT_per_m)},
           {"field_sd_nT", r.field_sd_nT ? json(*r.field_sd_nT) : json()},
           {"weak", std::move(weak)},
           {"coverage", fit::checks::to_text(r.known.coverage)},
           {"add", std::move(add)},
           {"helpful", std::move(helpful)}};
  if (r.power) add_json(*r.power, out);
  return out;
}

std::string to_text(const design::DesignReport& r, std::size_t width) {
  std::string out = fmt::format("{} poses: {}\n", r.poses,
                                r.determined ? "every parameter would be determined"
                                             : "NOT ENOUGH, some parameters would stay unknown");
  out += fmt::format("assumed: {}\ngauge: {}\n", assumed_text(r.assumed), gauge_text(r.gauge));
  if (r.determined) {
    out += "\n" + (r.sees_gradient() ? tensor_table(r, width) : field_table(r)) + "\n" +
           parameter_table(r, width);
  }
  const std::string weak = weak_list(r);
  out += (weak.empty() ? "" : "\n" + weak) + "\n" + help_list(r);
  return r.power ? out + "\n" + to_text(*r.power) : out;
}

}  // namespace mgtd::calib::report
