// SPDX-License-Identifier: Apache-2.0
#include "calib/report/discovery_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "calib/effects/effect_spec.h"
#include "calib/report/discovery_reason.h"
#include "calib/report/json_number.h"
#include "calib/stats/probability.h"
#include "proto/shell_word.h"

namespace mgtd::calib::report {
namespace {

using discovery::DiscoveryReport;
using discovery::FoundFormula;
using discovery::FoundLaw;
using discovery::LawFinding;
using nlohmann::json;

constexpr std::size_t kFormulasListed = 8, kSharesShown = 4, kCoefficientsShown = 4;
/// Of extrapolation_spread, above which formulas disagree outside the run.
constexpr double kDisagree = 0.3;

json optional_number(const std::optional<double>& x) { return x ? number_or_null(*x) : json(); }

/// An effect as `mgt define` takes it; one of the site has no scale.
struct Definition {
  std::string spec, name, level, scale, unit, formula;
};
std::vector<Definition> definitions(const FoundFormula& f) {
  std::vector<Definition> out;
  for (const std::string& text : f.specs) {
    const auto spec = effects::EffectSpec::parse(text);
    if (!spec || spec->find("expr") == nullptr) continue;
    out.push_back({text, spec->name, *spec->find("level"), spec->where ? spec->where->text() : "",
                   *spec->find("unit"), *spec->find("expr")});
  }
  return out;
}

json define_json(const FoundFormula& f) {
  json out = json::array();
  for (const Definition& d : definitions(f))
    out.push_back({{"spec", d.spec},
                   {"name", d.name},
                   {"level", d.level},
                   {"scale", d.scale},
                   {"unit", d.unit},
                   {"formula", d.formula}});
  return out;
}

json formula_json(const FoundFormula& f, const FoundLaw& law, bool first) {
  json coefficients = json::array();
  for (const discovery::LawCoefficient& c : f.coefficients)
    coefficients.push_back({{"where", c.where}, {"value", c.value}, {"sd", c.sd}, {"unit", c.unit}});
  return {{"formula", f.formula},
          {"where", f.where},
          {"covariates", f.covariates},
          {"P", f.P},
          {"chi2_fall", f.S},
          {"k", f.k},
          {"symbols", f.symbols},
          {"class", f.same_as},
          {"size_nT", f.size_nT},
          {"needed_nT", number_or_null(f.needed_nT)},
          {"library", f.library.empty() ? json() : json(f.library)},
          {"inner", f.inner ? json{{"value", *f.inner}, {"unit", f.inner_unit}} : json()},
          {"coefficients", std::move(coefficients)},
          {"define", define_json(f)},
          {"held_out_chi2_fall", first ? optional_number(law.held_out_fall) : json()},
          {"halves_ratio", first ? optional_number(law.halves_ratio) : json()}};
}

json shares_json(const std::vector<discovery::Share>& shares) {
  json out = json::array();
  for (const discovery::Share& share : shares) out.push_back({{"name", share.name}, {"P", share.P}});
  return out;
}

json law_json(const FoundLaw& law) {
  json formulas = json::array(), as_well = json::array();
  for (const discovery::LibraryEffect& effect : law.as_well)
    as_well.push_back({{"effect", effect.name}, {"where", effect.where}});
  for (std::size_t i = 0; i < law.formulas.size(); ++i)
    formulas.push_back(formula_json(law.formulas[i], law, i == 0));
  json out{{"log10_p_search", law.log10_p},
           {"stands_out", law.stands_out},
           {"d", law.d},
           {"covariates", shares_json(law.covariates)},
           {"where", shares_json(law.where)},
           {"formulas", std::move(formulas)},
           {"formulas_more", law.more},
           {"library_as_well", std::move(as_well)},
           {"stochastic",
            {{"walk_P", law.walk_P},
             {"jumps_P", law.jumps_P},
             {"two_ln_over_walk", number_or_null(law.over_walk)},
             {"two_ln_over_jumps", number_or_null(law.over_jumps)},
             {"beside", law.random_beside},
             {"two_ln_over_nothing_beside", number_or_null(law.over_nothing_beside)},
             {"where", law.random_where}}},
           {"extrapolation_spread", optional_number(law.extrapolation_spread)}};
  if (law.shape) {
    const discovery::LawShape& s = *law.shape;
    std::vector<double> low, high;
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      low.push_back(s.y_nT[i] - 1.96 * s.sd_nT[i]);
      high.push_back(s.y_nT[i] + 1.96 * s.sd_nT[i]);
    }
    json drawn = json::array();
    for (const auto& f : s.formulas) drawn.push_back({{"formula", f.formula}, {"y_nT", f.y_nT}});
    out["curve"] = {{"covariate", s.covariate},
                    {"where", s.where},
                    {"of_gain", s.of_gain},
                    {"x", s.x},
                    {"y_nT", s.y_nT},
                    {"lo_nT", low},
                    {"hi_nT", high},
                    {"simultaneous_sd", s.simultaneous},
                    {"formulas", std::move(drawn)}};
  }
  return out;
}

/// The commands that put what leads into the model.
std::vector<std::string> commands(const DiscoveryReport& r, const std::string& searched,
                                  const CommandsToModel& to_model, const std::vector<std::string>& kept) {
  std::vector<std::string> out;
  if (!r.accounts_for_everything()) return out;
  const std::string& run = to_model.run.empty() ? searched : to_model.run;
  for (const std::string& name : kept) out.push_back(fmt::format("mgt add {} {}", name, shell_word(run)));
  for (const FoundLaw& law : kept.empty() ? r.laws : std::vector<FoundLaw>{}) {
    for (const Definition& d : definitions(law.formulas.front())) {
      out.push_back(fmt::format("mgt define {} {} {} {}", shell_word(run), d.name, shell_word(d.formula),
                                d.scale.empty() ? fmt::format("--level {} --unit {}", d.level, d.unit)
                                                : fmt::format("--scale {}", d.scale)));
      out.push_back(fmt::format("mgt add {} {}", d.name, shell_word(run)));
    }
  }
  if (!out.empty()) out.insert(out.begin(), to_model.commands.begin(), to_model.commands.end());
  return out;
}

std::string headline(const DiscoveryReport& r) {
  const FoundLaw* law = r.laws.empty() ? nullptr : &r.laws.front();
  const FoundFormula* first = law == nullptr ? nullptr : &law->formulas.front();
  switch (r.finding) {
    case LawFinding::pass:
      return "PASS: no formula stands out from noise.";
    case LawFinding::law:
      return r.laws.size() == 1 ? fmt::format("LAW: {} at {}.", first->formula, first->where)
                                : fmt::format("LAW: {} formulas, each told from every other.", r.laws.size());
    case LawFinding::law_set:
      if (r.reason.law == 0)
        return fmt::format("LAW-SET: {} at {}, or one of {} others that these poses do not exclude.",
                           first->formula, first->where, law->formulas.size() + law->more - 1);
      return fmt::format(
          "LAW-SET: {} at {}, and beside it one of {} formulas that these poses do not exclude.",
          first->formula, first->where, r.laws[r.reason.law].formulas.size() + r.laws[r.reason.law].more);
    case LawFinding::library:
      return fmt::format("LIBRARY: {} at {} describes it.", first->formula, first->where);
    case LawFinding::shape_only:
      return fmt::format("SHAPE-ONLY: something acts on {}, and no formula accounts for it.",
                         law == nullptr ? r.left_on : first->where);
    case LawFinding::noise_like:
      if (law == nullptr || !law->stands_out)
        return fmt::format("NOISE-LIKE: {} scatters more than its noise, and nothing recorded goes with it.",
                           r.left_on);
      return law->over_jumps < law->over_walk
                 ? "NOISE-LIKE: jumps from pose to pose, unrelated to anything recorded."
                 : fmt::format("NOISE-LIKE: {} describes it better than any formula.", walk_text(*law));
  }
  return {};
}

std::string shares_text(const std::vector<discovery::Share>& shares) {
  std::vector<std::string> out;
  for (std::size_t i = 0; i < std::min(kSharesShown, shares.size()); ++i)
    out.push_back(fmt::format("{} {:.2f}", shares[i].name, shares[i].P));
  return fmt::format("{}", fmt::join(out, ", "));
}

void tell_coefficients(const FoundFormula& f, std::string& out) {
  const auto to = std::back_inserter(out);
  const std::size_t n = std::min(kCoefficientsShown, f.coefficients.size());
  for (std::size_t i = 0; i < n; ++i) {
    const discovery::LawCoefficient& c = f.coefficients[i];
    fmt::format_to(to, "     {} {:.4g} +- {:.2g} {} per unit of the formula\n", c.where, c.value, c.sd,
                   c.unit);
  }
  if (f.coefficients.size() > n) fmt::format_to(to, "     and {} more\n", f.coefficients.size() - n);
}

/// Five points of the curve.
std::string shape_text(const discovery::LawShape& s) {
  std::vector<std::string> points;
  double widest = 0;
  const std::size_t step = std::max<std::size_t>(1, (s.x.size() - 1) / 4);
  for (std::size_t i = 0; i < s.x.size(); i += step) {
    points.push_back(fmt::format("{:+.2g} nT at {:.4g}", s.y_nT[i], s.x[i]));
    widest = std::max(widest, s.simultaneous * s.sd_nT[i]);
  }
  return fmt::format(
      "the shape of {} over {}, up to a constant{}: {}; the whole curve lies within {:.2g} nT of it "
      "with 95 %",
      s.where, s.covariate, s.of_gain ? " and at a reading of 50 000 nT" : "", fmt::join(points, ", "),
      widest);
}

void tell_law(const FoundLaw& law, std::size_t number, std::size_t laws, std::string& out) {
  const auto to = std::back_inserter(out);
  out += "\n";
  if (laws > 1) fmt::format_to(to, "law {} of {}\n", number, laws);
  fmt::format_to(to, "d = {:.1f}; chance that the whole search finds as much in noise: p {}\n", law.d,
                 stats::p_text(law.log10_p));
  out += "depends on " + shares_text(law.covariates) + "\n";
  out += "acts on " + shares_text(law.where) + "\n";
  fmt::format_to(to, "\n{:>2}  {:<42} {:<9} {:>5} {:>8} {:>2} {:>2}\n", "", "formula", "where", "P", "fall",
                 "k", "C");
  for (std::size_t i = 0; i < std::min(kFormulasListed, law.formulas.size()); ++i) {
    const FoundFormula& f = law.formulas[i];
    fmt::format_to(to, "{:>2}  {:<42} {:<9} {:>5.2f} {:>8.1f} {:>2} {:>2}\n", i + 1, f.formula, f.where, f.P,
                   f.S, f.k, f.symbols);
    if (!f.library.empty() && f.library != f.formula)
      fmt::format_to(to, "     in the library: {}\n", f.library);
    if (i == 0) tell_coefficients(f, out);
  }
  if (const std::size_t all = law.formulas.size() + law.more; all > kFormulasListed)
    fmt::format_to(to, "    and {} more in the 99 % set\n", all - kFormulasListed);
  if (number == 1)
    fmt::format_to(to, "    {}: offset walks {:.2f}, jumps from pose to pose {:.2f}\n",
                   law.random_beside ? "beside it" : "no formula", law.walk_P, law.jumps_P);
  out += "P: probability; fall: of chi-square; k: coefficients; C: symbols\n";
  std::vector<std::size_t> alike;
  for (std::size_t i = 1; i < law.formulas.size(); ++i)
    if (law.formulas[i].same_as == law.formulas.front().same_as) alike.push_back(i + 1);
  if (!alike.empty()) {
    double needed = 0;
    for (std::size_t i = 1; i < law.formulas.size(); ++i)
      if (law.formulas[i].same_as == law.formulas.front().same_as)
        needed = std::max(needed, law.formulas[i].needed_nT);
    alike.resize(std::min(kFormulasListed, alike.size()));
    std::string told = fmt::format("cannot be told from 1 on these poses: {}", fmt::join(alike, ", "));
    if (std::isfinite(needed) && needed > 0) {
      told += fmt::format("; all of them could at {:.3g} nT rms (it has {:.2g})", needed,
                          law.formulas.front().size_nT);
    } else {
      told += "; some are the same on these poses, however large";
    }
    out += "\n" + told + "\n";
  }
  if (law.shape) out += shape_text(*law.shape) + "\n";
  if (law.halves_ratio)
    fmt::format_to(to, "one half of the poses shows {:.2f} times the size that the other half shows\n",
                   *law.halves_ratio);
  if (law.held_out_fall)
    fmt::format_to(to, "on poses that took no part in the search chi-square {} by {:.0f}\n",
                   *law.held_out_fall > 0 ? "falls" : "RISES", std::abs(*law.held_out_fall));
  if (law.extrapolation_spread && *law.extrapolation_spread > kDisagree)
    fmt::format_to(to, "OUTSIDE what the run covered the formulas disagree by {:.0f} %: do not extrapolate\n",
                   100 * *law.extrapolation_spread);
}

}  // namespace

json to_json(const DiscoveryReport& r, const std::string& run, const CommandsToModel& to_model,
             const std::vector<std::string>& kept) {
  json laws = json::array();
  for (const FoundLaw& law : r.laws) laws.push_back(law_json(law));
  json out{{"schema", "mgt.discover/1"},
           {"verdict", std::string(discovery::to_string(r.finding))},
           {"reason",
            {{"rule", std::string(rule_name(r.reason.rule))},
             {"measured", number_or_null(r.reason.measured)},
             {"limit", number_or_null(r.reason.limit)},
             {"law", r.reason.law},
             {"text", reason_text(r)}}},
           {"poses", r.poses},
           {"poses_searched", r.searched},
           {"hypotheses", r.hypotheses},
           {"grammar", {{"formulas", r.formulas}, {"hash", r.grammar_hash}}},
           {"questions", r.questions},
           {"draws", r.draws},
           {"chi2", r.chi2},
           {"dof", r.dof},
           {"noise_nT", r.noise_nT},
           {"residual_nT", r.residual_nT},
           {"rho", r.rho},
           {"wanders", r.wanders},
           {"may_be_drift", r.may_be_drift},
           {"log10_p_left", r.log10_p_left},
           {"left", {{"where", r.left_on}, {"sigmas", r.left_sigmas}}},
           {"laws", laws},
           {"after", json()},
           {"next", json::array({what_next(r, run, kept)})},
           {"commands", commands(r, run, to_model, kept)},
           {"text", to_text(r, run, to_model, kept)}};
  // The strongest law once more, where a reader of one law looks for it.
  const json first = laws.empty() ? json::object() : laws.front();
  for (const char* key : {"log10_p_search", "stands_out", "d", "covariates", "where", "formulas",
                          "formulas_more", "stochastic", "curve", "extrapolation_spread"})
    out[key] = first.contains(key) ? first[key] : json();
  if (r.after)
    out["after"] = {{"residual_nT", r.after->residual_nT},
                    {"unseen_before_nT", optional_number(r.after->unseen_before_nT)},
                    {"unseen_after_nT", optional_number(r.after->unseen_after_nT)}};
  return out;
}

std::string to_text(const DiscoveryReport& r, const std::string& run, const CommandsToModel& to_model,
                    const std::vector<std::string>& kept) {
  std::string out = headline(r) + "\n";
  const auto to = std::back_inserter(out);
  fmt::format_to(
      to, "residual {:.3g} nT, noise {:.3g} nT; {} formulas (grammar {}), {} questions with their places\n",
      r.residual_nT, r.noise_nT, r.formulas, r.grammar_hash, r.hypotheses);
  if (r.searched < r.poses)
    fmt::format_to(to, "{} of the {} poses are searched, evenly chosen: a search takes no more\n", r.searched,
                   r.poses);
  if (r.wanders) out += "the offsets of this run wander: slow laws are held against that\n";
  const bool show = r.finding != LawFinding::pass && !r.laws.empty() && r.laws.front().stands_out;
  // Of what is not believed the first says enough.
  const std::size_t shown = r.finding == LawFinding::noise_like ? 1 : r.laws.size();
  for (std::size_t i = 0; show && i < shown; ++i) tell_law(r.laws[i], i + 1, shown, out);
  if (show && shown == r.laws.size())
    fmt::format_to(to, "left after {}: p {}; most on {}, {:.1f} standard deviations of chi-square\n",
                   r.laws.size() == 1 ? "it" : "them", stats::p_text(r.log10_p_left), r.left_on,
                   r.left_sigmas);
  if (r.after) {
    fmt::format_to(to, "a fit with {}: residual {:.3g} -> {:.3g} nT", r.laws.size() == 1 ? "it" : "them",
                   r.residual_nT, r.after->residual_nT);
    if (r.after->unseen_before_nT && r.after->unseen_after_nT)
      fmt::format_to(to, "; on poses held out {:.3g} -> {:.3g} nT", *r.after->unseen_before_nT,
                     *r.after->unseen_after_nT);
    out += "\n";
  }
  out += "\n";
  if (const std::string reason = reason_text(r); !reason.empty()) out += "why: " + reason + "\n";
  if (!kept.empty()) fmt::format_to(to, "kept in {}: {}\n", run, fmt::join(kept, ", "));
  out += "next: " + what_next(r, run, kept) + "\n";
  for (const std::string& command : commands(r, run, to_model, kept)) out += "  " + command + "\n";
  return out;
}

}  // namespace mgtd::calib::report
