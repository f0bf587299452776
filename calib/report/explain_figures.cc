// SPDX-License-Identifier: Apache-2.0
#include "calib/report/explain_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/effects/library/effect_family.h"
#include "calib/fit/joint/joint_report.h"
#include "calib/fit/joint/tensor_uncertainty.h"
#include "calib/report/figures/candidates_figure.h"
#include "calib/report/figures/limits_figures.h"
#include "calib/report/figures/parameter_figures.h"
#include "calib/report/figures/scatter_figures.h"
#include "calib/report/figures/waterfall_figure.h"
#include "calib/report/size_text.h"
#include "calib/report/verdict_text.h"
#include "calib/stats/probability.h"

namespace mgtd::calib::report {
namespace {

/// As figures write it: "+2.999 ± 0.082 nT/°C".
std::string typeset(std::string text) {
  for (const auto& [plain, set] :
       {std::pair<std::string_view, std::string_view>{"+-", "±"}, {"degC", "°C"}, {"^2", "²"}})
    for (std::size_t at = text.find(plain); at != std::string::npos; at = text.find(plain, at + set.size()))
      text.replace(at, plain.size(), set);
  return text;
}

constexpr std::size_t kCandidatesDrawn = 12;

std::vector<std::string> parameter_names() {
  return {sensor::kParameterNames.begin(), sensor::kParameterNames.end()};
}

std::vector<std::string> numbered(std::size_t sensors) {
  std::vector<std::string> out;
  for (std::size_t s = 1; s <= sensors; ++s) out.push_back(fmt::format("s{}", s));
  return out;
}

double worst_sd(const fit::joint::JointFit& fit) {
  const Gradient sd = fit::joint::calibration_tensor_sd(fit.state.sensors, fit.problem.geometry,
                                                        fit.covariance, fit::joint::mean_field(fit));
  double worst = 0;
  for (const double x : components(sd)) worst = std::fmax(worst, x);
  return worst;
}

}  // namespace

figures::Figure candidates_of(const criticism::search::ExplainReport& report) {
  figures::CandidatesValues v{
      .candidates = {}, .tried = report.candidates.size(), .seen_d = criticism::tests::kSeen};
  for (std::size_t i = 0; i < std::min(kCandidatesDrawn, report.candidates.size()); ++i) {
    const criticism::tests::Candidate& c = report.candidates[i];
    figures::Candidate s{.effect = c.effect,
                         .where = c.where,
                         .d = c.d,
                         .p = stats::p_phrase(c.log10_p),
                         .size = typeset(size_text(c))};
    for (const auto& other : c.alternatives)
      if (other.possible) s.could_also_be.push_back(other.effect);
    s.named = std::find(report.named.begin(), report.named.end(), c.effect) != report.named.end();
    s.plausible = c.plausible;
    v.candidates.push_back(std::move(s));
  }
  for (const auto& u : report.untestable) v.untestable.push_back(u.effect);
  return figures::candidates_figure(v);
}

figures::Figure detectable_of(const std::vector<criticism::tests::Detectable>& detectable,
                              const std::vector<criticism::tests::Untestable>& untestable) {
  figures::DetectableValues v;
  for (const auto& d : detectable) {
    const effects::library::EffectFamily* const family = effects::library::find_family(d.effect);
    const bool beyond = d.value >= criticism::tests::kAtNoSize ||
                        (family != nullptr && family->bound > 0 && d.value > family->bound);
    const double usual = family == nullptr ? 0 : family->typical;
    v.sizes.push_back({.effect = d.effect,
                       .where = d.where,
                       .ratio = usual > 0 && !beyond ? d.value / usual : 0,
                       .text = typeset(detectable_text(d))});
  }
  for (const auto& u : untestable) v.untestable.push_back(u.effect);
  return figures::detectable_figure(v);
}

figures::Figure waterfall_of(const criticism::search::Waterfall& w, std::optional<double> held_out_nT) {
  figures::WaterfallValues v{.effects = {},
                             .short_names = {},
                             .residual = {.unit = "nT",
                                          .without = w.without_nT,
                                          .with = w.with_nT,
                                          .floor = w.floor_nT,
                                          .first_share = {},
                                          .last_share = {},
                                          .held_out = held_out_nT},
                             .tensor = {}};
  if (!std::isnan(w.without_nT_per_m))
    v.tensor = {.unit = "nT/m",
                .without = w.without_nT_per_m,
                .with = w.with_nT_per_m,
                .floor = w.floor_nT_per_m,
                .first_share = {},
                .last_share = {},
                .held_out = {}};
  for (const auto& s : w.steps) {
    v.effects.push_back(s.spec.empty() ? s.effect : s.spec);
    v.short_names.push_back(s.effect);
    v.residual.first_share.push_back(s.first_nT), v.residual.last_share.push_back(s.last_nT);
    if (!v.tensor) continue;
    v.tensor->first_share.push_back(s.first_nT_per_m), v.tensor->last_share.push_back(s.last_nT_per_m);
  }
  return figures::waterfall_figure(v);
}

figures::Figure evidence_of(const criticism::search::Evidence& e) {
  figures::EvidenceValues v{.effect = e.candidate.effect,
                            .where = e.candidate.where,
                            .x_label = "what the effect makes of the pose, in units of the noise",
                            .y_label = "left there, in units of the noise",
                            .slope_text = typeset(size_text(e.candidate)),
                            .slope = e.added.slope,
                            .slope_sd = e.added.slope_sd,
                            .poses = e.added.pose,
                            .largest_share = e.candidate.largest_pose};
  v.x = e.added.x, v.y = e.added.y;
  return figures::evidence_figure(v);
}

figures::Figure confusion_of(const criticism::tests::ConfusionMatrix& c) {
  figures::ConfusionValues v{.effects = c.effects};
  const auto n = static_cast<Eigen::Index>(c.effects.size());
  for (Eigen::Index i = 0; i < n; ++i) {
    std::vector<double>& row = v.correlation.emplace_back();
    // Of the two directions the worse: an effect with many coefficients holds one with few.
    for (Eigen::Index j = 0; j < n; ++j) row.push_back(std::max(c.correlation(i, j), c.correlation(j, i)));
  }
  return figures::confusion_figure(v);
}

figures::Figure price_of(const fit::joint::JointFit& narrow, const fit::joint::JointFit& wide) {
  const auto sensors = static_cast<std::size_t>(wide.problem.sensors());
  figures::PriceValues v{.sensors = numbered(sensors),
                         .parameters = parameter_names(),
                         .sd_ratio = {},
                         .tensor_before_nT_per_m = worst_sd(narrow),
                         .tensor_after_nT_per_m = worst_sd(wide)};
  for (std::size_t s = 0; s < sensors; ++s) {
    std::vector<double>& row = v.sd_ratio.emplace_back();
    for (std::size_t k = 0; k < v.parameters.size(); ++k) {
      const auto slot = static_cast<Eigen::Index>(s * v.parameters.size() + k);
      row.push_back(std::sqrt(wide.covariance(slot, slot) / narrow.covariance(slot, slot)));
    }
  }
  return figures::price_figure(v);
}

figures::Figure impact_of(const std::vector<std::pair<std::string, fit::joint::EffectImpact>>& impacts,
                          const fit::joint::JointFit& fit) {
  figures::ImpactValues v{.rows = {}, .known_nT_per_m = worst_sd(fit)};
  for (const auto& [effect, impact] : impacts) v.rows.push_back({effect, impact.component, impact.nT_per_m});
  return figures::impact_figure(v);
}

}  // namespace mgtd::calib::report
