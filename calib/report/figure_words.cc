// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figure_words.h"

#include <nlohmann/json.hpp>

#include "calib/criticism/tests/residual_shape.h"

namespace mgtd::calib::report {

using nlohmann::json;

json words_json(const figures::Figure& f) {
  return {{"name", f.name},
          {"title", f.title},
          {"caption", f.caption},
          {"good", f.good},
          {"stands_out", f.stands_out}};
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
