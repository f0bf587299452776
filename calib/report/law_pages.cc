// SPDX-License-Identifier: Apache-2.0
#include "calib/report/law_pages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "calib/effects/where.h"
#include "calib/report/figures/law_figure.h"
#include "calib/stats/probability.h"

namespace mgtd::calib::report {
namespace {

using nlohmann::json;

constexpr std::size_t kFormulasShown = 12, kNamesShown = 4;

std::string shares_text(const json& shares) {
  std::vector<std::string> out;
  for (const json& share : shares)
    if (out.size() < kNamesShown)
      out.push_back(
          fmt::format("{} {:.2f}", share.at("name").get<std::string>(), share.at("P").get<double>()));
  return fmt::format("{}", fmt::join(out, ", "));
}

/// The word, and the formula where one is believed.
std::string title_of(const std::string& word, const json& law, std::size_t number, std::size_t laws) {
  const json& first = law.at("formulas").at(0);
  const bool believed = word != "SHAPE-ONLY" && word != "NOISE-LIKE";
  const std::string where = first.at("where"), formula = first.at("formula");
  const std::string what =
      believed ? fmt::format("{}: {} at {}", word, formula, where) : fmt::format("{} on {}", word, where);
  return laws > 1 ? fmt::format("{} ({} of {})", what, number, laws) : what;
}

figures::DataTable formulas_of(const json& law) {
  figures::DataTable out{
      .head = {"formula", "where", "P", "fall of chi-square", "coefficients", "size, nT", "in the library"},
      .rows = {}};
  const json& all = law.at("formulas");
  for (const json& f : all) {
    if (out.rows.size() == kFormulasShown) break;
    out.rows.push_back({f.at("formula"), f.at("where"), fmt::format("{:.2f}", f.at("P").get<double>()),
                        fmt::format("{:.1f}", f.at("chi2_fall").get<double>()),
                        fmt::format("{}", f.at("k").get<int>()),
                        fmt::format("{:.3g}", f.at("size_nT").get<double>()),
                        f.at("library").is_null() ? std::string() : f.at("library").get<std::string>()});
  }
  return out;
}

/// What a law depends on, with its unit; a column's name has it already.
std::string axis_label(const std::string& covariate) {
  if (covariate == "t_h") return "time since the start, h";
  if (covariate.ends_with("_deg")) return covariate.substr(0, covariate.size() - 4) + ", deg";
  if (covariate.ends_with("T_degC"))
    return covariate == "T_degC" ? "temperature, °C" : "temperature of " + covariate.substr(0, 2) + ", °C";
  if (effects::Where::parse(covariate)) return "reading of " + covariate + " without its offset, nT";
  return covariate;
}

std::optional<figures::Figure> curve_of(const json& law, std::size_t number) {
  if (!law.contains("curve") || law.at("curve").is_null()) return std::nullopt;
  const json& curve = law.at("curve");
  figures::LawValues out{.name = fmt::format("law-{}", number),
                         .x_label = axis_label(curve.at("covariate")),
                         .where = curve.at("where"),
                         .of_gain = curve.at("of_gain"),
                         .x = curve.at("x"),
                         .y_nT = curve.at("y_nT"),
                         .sd_nT = {},
                         .simultaneous = curve.at("simultaneous_sd")};
  const std::vector<double> high = curve.at("hi_nT");
  for (std::size_t i = 0; i < high.size(); ++i) out.sd_nT.push_back((high[i] - out.y_nT.at(i)) / 1.96);
  for (const json& f : curve.at("formulas")) out.formulas.push_back({f.at("formula"), f.at("y_nT")});
  const auto fits = [&](const std::vector<double>& values) { return values.size() == out.x.size(); };
  if (out.x.empty() || !fits(out.y_nT) || !fits(out.sd_nT) ||
      !std::all_of(out.formulas.begin(), out.formulas.end(),
                   [&](const figures::LawFormulaValues& f) { return fits(f.y_nT); }))
    return std::nullopt;
  return figures::law_figure(out);
}

std::vector<std::string> notes_of(const json& law) {
  std::vector<std::string> out{
      fmt::format("The whole search finds as much in noise with p {}; d = {:.1f}.",
                  stats::p_text(law.at("log10_p_search").get<double>()), law.at("d").get<double>()),
      fmt::format("Depends on {}; acts on {}.", shares_text(law.at("covariates")),
                  shares_text(law.at("where")))};
  const json& all = law.at("formulas");
  const std::size_t more =
      all.size() - std::min(kFormulasShown, all.size()) + law.at("formulas_more").get<std::size_t>();
  if (more > 0)
    out.push_back(fmt::format("The set that holds the true formula with 99 % has {} more.", more));
  const json& random = law.at("stochastic");
  if (!random.at("beside").get<bool>())
    out.push_back(
        fmt::format("No formula at all: an offset that walks {:.2f}, jumps from pose to pose {:.2f}.",
                    random.at("walk_P").get<double>(), random.at("jumps_P").get<double>()));
  const json& first = law.at("formulas").at(0);
  if (!first.at("halves_ratio").is_null())
    out.push_back(fmt::format("One half of the poses shows {:.2f} times the size that the other half shows.",
                              first.at("halves_ratio").get<double>()));
  if (!first.at("held_out_chi2_fall").is_null()) {
    const double fall = first.at("held_out_chi2_fall");
    out.push_back(fmt::format("On poses that took no part in the search chi-square {} by {:.0f}.",
                              fall > 0 ? "falls" : "rises", std::abs(fall)));
  }
  return out;
}

}  // namespace

Result<std::vector<LawPage>> law_pages(const json& discovery) {
  std::vector<LawPage> out;
  try {
    if (discovery.at("schema") != "mgt.discover/1")
      return fail(ErrorCode::bad_input, "what was discovered has another schema",
                  "search again with this version: mgt discover RUN --keep");
    const std::string word = discovery.at("verdict");
    const json& laws = discovery.at("laws");
    std::size_t shown = 0;
    for (const json& law : laws) shown += law.at("stands_out").get<bool>() ? 1U : 0U;
    if (word == "PASS") return out;
    for (const json& law : laws) {
      if (!law.at("stands_out").get<bool>()) continue;
      const std::size_t number = out.size() + 1;
      out.push_back({.title = title_of(word, law, number, shown),
                     .formulas = formulas_of(law),
                     .curve = curve_of(law, number),
                     .notes = notes_of(law)});
    }
  } catch (const json::exception&) {
    return fail(ErrorCode::bad_input, "what was discovered on this run cannot be read",
                "search again with this version: mgt discover RUN --keep");
  }
  return out;
}

}  // namespace mgtd::calib::report
