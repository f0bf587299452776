// SPDX-License-Identifier: Apache-2.0
#include "calib/report/formula_report.h"

#include <fmt/format.h>

#include <iterator>
#include <nlohmann/json.hpp>

#include "calib/stats/probability.h"

namespace mgtd::calib::report {

nlohmann::json to_json(const criticism::tests::FormulaExamination& x) {
  nlohmann::json alike = nlohmann::json::array(), coefficients = nlohmann::json::array();
  for (const criticism::tests::Collinearity& r : x.alike)
    alike.push_back({{"effect", r.effect}, {"correlation", r.correlation}});
  for (const calibration::EffectCoefficient& c : x.coefficients)
    coefficients.push_back({{"name", c.name}, {"value", c.value}, {"sd", c.sd}, {"unit", c.unit}});
  return {{"name", x.name},
          {"where", x.where},
          {"expression", x.expression},
          {"absorbed", x.absorbed},
          {"k", x.k},
          {"rank", x.rank},
          {"d", x.d()},
          {"log10_p", x.log10_p},
          {"coefficients", std::move(coefficients)},
          {"detectable_above", {{"value", x.detectable}, {"unit", x.unit}}},
          {"resembles", std::move(alike)},
          {"signature", {{"pose", x.signature.pose}, {"x", x.signature.x}, {"y", x.signature.y}}}};
}

std::string to_text(const criticism::tests::FormulaExamination& x) {
  std::string out = fmt::format("{} at {}: {}\n", x.name, x.where, x.expression);
  const auto to = std::back_inserter(out);
  if (x.wholly_absorbed()) {
    out +=
        "the calibration absorbs it whole: offsets, scales, angles, attitudes and field of these poses take "
        "up "
        "every trace of it, so no residual can show it, and adding it changes nothing but the parameters\n";
    return out;
  }
  fmt::format_to(to, "{:.1f} % of it (in squares) is already absorbed by calibration, attitude and field\n",
                 100 * x.absorbed);
  if (x.rank < x.k) fmt::format_to(to, "of its {} coefficients these poses can tell {}\n", x.k, x.rank);
  fmt::format_to(to, "seen in 99 of 100 runs like this from {:.3g} {}\n", x.detectable, x.unit);
  if (x.alike.empty()) out += "no effect of the library looks like it\n";
  for (const criticism::tests::Collinearity& r : x.alike) {
    fmt::format_to(
        to, "{} {:.1f} % the same as {}{}\n",
        r.correlation == x.alike.front().correlation ? "it is" : "     ", 100 * r.correlation, r.effect,
        r.correlation > criticism::tests::kTheSame ? ": no run like this can tell them apart" : "");
  }
  fmt::format_to(to, "on this run, by the score test: d {:.1f}, {}\n", x.d(), stats::p_phrase(x.log10_p));
  for (const calibration::EffectCoefficient& c : x.coefficients)
    fmt::format_to(to, "  {:<24} {:>+12.5g} +- {:<10.3g} {}\n", c.name, c.value, c.sd, c.unit);
  return out;
}

}  // namespace mgtd::calib::report
