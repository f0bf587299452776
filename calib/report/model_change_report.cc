// SPDX-License-Identifier: Apache-2.0
#include "calib/report/model_change_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "calib/report/residual_words.h"
#include "calib/report/text_bar.h"
#include "calib/stats/probability.h"
#include "proto/json_text.h"

namespace mgtd::calib::report {
namespace {

using nlohmann::json;

std::string lines(const char* what, double before, double after, const char* unit, std::size_t width) {
  constexpr std::size_t kBeforeBar = 46;
  const double top = std::max(before, after);
  const int room = bar_room(width, kBeforeBar);
  return fmt::format("{:<22} before {:>9.3f} {:<5} {}\n{:<22} after  {:>9.3f} {:<5} {}\n", what, before, unit,
                     bar(before, top, room), "", after, unit, bar(after, top, room));
}

const char* name_of(criticism::search::Veto veto) {
  switch (veto) {
    case criticism::search::Veto::held_out:
      return "poses left out get worse";
    case criticism::search::Veto::not_shown:
      return "not shown to be there";
    case criticism::search::Veto::price:
      return "price";
  }
  return "";
}

}  // namespace

json to_json(const criticism::search::ModelChange& c) {
  json coefficients = json::array();
  for (const calibration::EffectCoefficient& x : c.coefficients)
    coefficients.push_back({{"name", x.name}, {"value", x.value}, {"sd", x.sd}, {"unit", x.unit}});
  json vetoes = json::array(), reasons = json::array();
  for (const criticism::search::Veto veto : c.vetoes()) {
    vetoes.push_back(name_of(veto));
    reasons.push_back(to_text(c, veto));
  }
  return {{"schema", "mgt.model-change/1"},
          {"action", c.adding ? "add" : "drop"},
          {"effect", c.effect},
          {"spec", c.spec},
          {"model", c.model},
          {"coefficients", std::move(coefficients)},
          {"k", c.k},
          {c.adding ? "predicted_fall" : "predicted_rise", c.predicted},
          {c.adding ? "realised_fall" : "realised_rise", c.realised},
          {"log10_p", c.log10_p},
          {"residual_over_noise", c.birge_ratio},
          {"chi2_before", c.chi2_before},
          {"chi2_after", c.chi2_after},
          {"dof_before", c.dof_before},
          {"dof_after", c.dof_after},
          {"rms_before_nT", c.rms_before_nT},
          {"rms_after_nT", c.rms_after_nT},
          {"tensor_before_nT_per_m", c.tensor_before_nT_per_m},
          {"tensor_after_nT_per_m", c.tensor_after_nT_per_m},
          {"noise_nT", c.noise_nT},
          {"held_out_before_nT", or_null(c.held_out_before_nT)},
          {"held_out_after_nT", or_null(c.held_out_after_nT)},
          {"variance_price", {{"growth_of_sd", c.price.sd_ratio}, {"parameter", c.price.parameter}}},
          {"vetoes", std::move(vetoes)},
          {"veto_reasons", std::move(reasons)},
          {"vetoed", c.vetoed()}};
}

std::string to_text(const criticism::search::ModelChange& c, std::size_t width) {
  std::string out = fmt::format("{} {}\n", c.adding ? "with" : "without", c.spec);
  const auto to = std::back_inserter(out);
  out += lines("residual", c.rms_before_nT, c.rms_after_nT, "nT", width);
  if (c.held_out_before_nT && c.held_out_after_nT)
    out += lines("on poses held out", *c.held_out_before_nT, *c.held_out_after_nT, "nT", width);
  if (!std::isnan(c.tensor_after_nT_per_m))
    out += lines("tensor error, rms", c.tensor_before_nT_per_m, c.tensor_after_nT_per_m, "nT/m", width);
  fmt::format_to(to, "{:<29} {:>9.3f} nT\n(residual: {})\n", "noise of a pose mean", c.noise_nT, kResidualIs);
  fmt::format_to(to, "chi-square {} by {:.5g} where {:.5g} was predicted; chance alone: {}{}\n",
                 c.adding ? "fell" : "rose", c.realised, c.predicted, stats::p_phrase(c.log10_p),
                 c.birge_ratio > 1
                     ? fmt::format(" (what is left {} is {:.3g} times the noise, and so is a fall by chance)",
                                   c.adding ? "with it" : "before", c.birge_ratio)
                     : "");
  if (c.price.parameter.empty()) {
    out += "price: no standard deviation of the calibration is larger for it\n";
  } else {
    fmt::format_to(to, "price: the standard deviation of {} is {:.2f} times what it is without\n",
                   c.price.parameter, c.price.sd_ratio);
  }
  for (const calibration::EffectCoefficient& x : c.coefficients)
    fmt::format_to(to, "  {:<24} {:>+12.5g} +- {:<10.3g} {}\n", x.name, x.value, x.sd, x.unit);
  constexpr double kWeak_log10_p = -2;
  if (c.adding && c.log10_p > std::log10(criticism::search::kVetoChance)) {
    fmt::format_to(to, "it is not shown to be there: the limit is p = {}\n", criticism::search::kVetoChance);
  } else if (c.adding && c.log10_p > kWeak_log10_p) {
    out += "weak evidence: chance alone brings such a fall in more than one run of a hundred\n";
  }
  return out;
}

std::string to_text(const criticism::search::ModelChange& c, criticism::search::Veto veto) {
  switch (veto) {
    case criticism::search::Veto::held_out:
      return fmt::format("on poses left out the error rises from {:.4g} to {:.4g} nT",
                         c.held_out_before_nT.value_or(0), c.held_out_after_nT.value_or(0));
    case criticism::search::Veto::not_shown:
      return fmt::format("it is not shown to be there: chance alone has {}, and the limit is {}",
                         stats::p_phrase(c.log10_p), criticism::search::kVetoChance);
    case criticism::search::Veto::price:
      return fmt::format(
          "the standard deviation of {} would be {:.0f} times what it is without, and the "
          "limit is {:.0f}",
          c.price.parameter, c.price.sd_ratio, criticism::search::kVetoPrice);
  }
  return {};
}

}  // namespace mgtd::calib::report
