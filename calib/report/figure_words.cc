// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figure_words.h"

#include <nlohmann/json.hpp>

#include "calib/criticism/tests/residual_shape.h"
#include "proto/number.h"

namespace mgtd::calib::report {

using nlohmann::json;

namespace {

/// A number as a number, which tables write with the typesetter's minus.
json cell_json(const std::string& cell) {
  constexpr std::string_view kMinus = "\u2212";
  const std::string plain = cell.starts_with(kMinus) ? "-" + cell.substr(kMinus.size()) : cell;
  if (const auto whole = parse_integer(plain)) return *whole;
  const auto number = parse_number(plain);
  return number ? json(*number) : json(cell);
}

}  // namespace

json words_json(const figures::Figure& f) {
  return {{"name", f.name},
          {"title", f.title},
          {"caption", f.caption},
          {"good", f.good},
          {"stands_out", f.stands_out}};
}

json words_by_name(const std::vector<figures::Figure>& figures) {
  json out = json::object();
  for (const figures::Figure& f : figures) out[f.name] = words_json(f);
  return out;
}

json figures_json(const std::vector<figures::Figure>& figures) {
  json out = words_by_name(figures);
  for (const figures::Figure& f : figures) {
    json rows = json::array();
    for (const std::vector<std::string>& row : f.data.rows) {
      json& cells = rows.emplace_back(json::array());
      for (const std::string& cell : row) cells.push_back(cell_json(cell));
    }
    out[f.name]["svg"] = f.svg;
    out[f.name]["points"] = {{"head", f.data.head}, {"rows", std::move(rows)}, {"note", f.data.note}};
  }
  return out;
}

json panels_json(const PanelModel& model) {
  json words = json::array();
  for (const figures::Figure& figure : panel_figures(model, nullptr)) words.push_back(words_json(figure));
  const auto q = criticism::tests::residual_quantiles(*model.comparison.fit);
  const auto memory = criticism::tests::residual_autocorrelation(*model.comparison.fit);
  return {{"panels", std::move(words)},
          {"quantiles",
           {{"n", q.n},
            {"quantile", q.quantile},
            {"residual", q.residual},
            {"low", q.low},
            {"high", q.high},
            {"pose", q.pose}}},
          {"autocorrelation", {{"by_sensor", memory.by_sensor}, {"bound", memory.bound}}}};
}

}  // namespace mgtd::calib::report
