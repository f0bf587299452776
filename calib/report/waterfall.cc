// SPDX-License-Identifier: Apache-2.0
#include "calib/report/waterfall.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "calib/calibration/tensor.h"
#include "calib/report/text_bar.h"

namespace mgtd::calib {
namespace {

using nlohmann::json;

struct ErrorLevel {
  double nT{0}, nT_per_m{0};
};

ErrorLevel level_of(const JointErrors& e) {
  return {e.residual_nT, tensor_rms(e.summary.tensor_rmse_nT_per_m)};
}

double beyond(double without, double with) {
  return std::sqrt(std::max(0.0, without * without - with * with));
}

Result<ErrorLevel> level_with(const PoseTable& table, const ModelStage& whole,
                              const std::vector<EffectPtr>& effects) {
  const auto fit = fit_under_same_weights(table, whole, effects);
  if (!fit) return tl::unexpected(fit.error());
  return level_of(joint_errors(fit->problem, fit->state, FixedBlock::fitted));
}

/// Of the tensor when every corrected component has the noise of its pose means.
double tensor_floor(const JointFit& fit) {
  const auto rows = gradient_rows(fit.problem.geometry);
  double sum = 0;
  for (int c = 0; c < kChannels; ++c)
    sum += rows.col(c).squaredNorm() * std::pow(fit.pose_noise_nT(c / 3, c % 3), 2);
  return std::sqrt(sum / 6);
}

constexpr int kBarWidth = 24;

}  // namespace

Result<Waterfall> waterfall(const PoseTable& table, const FitOptions& options) {
  const auto whole = model_stage(table, options);
  if (!whole) return tl::unexpected(whole.error());
  const auto& effects = whole->options.effects;
  const ErrorLevel with = level_of(whole->errors);
  const auto without = level_with(table, *whole, {});
  if (!without) return tl::unexpected(without.error());
  Waterfall out{.without_nT = without->nT,
                .without_nT_per_m = without->nT_per_m,
                .with_nT = with.nT,
                .with_nT_per_m = with.nT_per_m,
                .floor_nT = whole->fit.noise_nT(),
                .floor_nT_per_m = tensor_floor(whole->fit)};
  for (std::size_t i = 0; i < effects.size(); ++i) {
    std::vector<EffectPtr> others = effects;
    others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
    const auto alone = level_with(table, *whole, {effects[i]});
    if (!alone) return tl::unexpected(alone.error());
    const auto missing = level_with(table, *whole, others);
    if (!missing) return tl::unexpected(missing.error());
    out.steps.push_back({.effect = std::string(effects[i]->name()),
                         .spec = effects[i]->spec(),
                         .first_nT = beyond(without->nT, alone->nT),
                         .first_nT_per_m = beyond(without->nT_per_m, alone->nT_per_m),
                         .last_nT = beyond(missing->nT, with.nT),
                         .last_nT_per_m = beyond(missing->nT_per_m, with.nT_per_m)});
  }
  std::stable_sort(out.steps.begin(), out.steps.end(),
                   [](const WaterfallStep& a, const WaterfallStep& b) { return a.last_nT > b.last_nT; });
  return out;
}

json to_json(const Waterfall& w) {
  json steps = json::array();
  for (const WaterfallStep& s : w.steps) {
    steps.push_back({{"effect", s.effect},
                     {"spec", s.spec},
                     {"added_first_nT", s.first_nT},
                     {"added_first_nT_per_m", s.first_nT_per_m},
                     {"dropped_last_nT", s.last_nT},
                     {"dropped_last_nT_per_m", s.last_nT_per_m}});
  }
  return {{"steps", std::move(steps)},
          {"without_nT", w.without_nT},
          {"without_nT_per_m", w.without_nT_per_m},
          {"with_nT", w.with_nT},
          {"with_nT_per_m", w.with_nT_per_m},
          {"noise_floor_nT", w.floor_nT},
          {"noise_floor_nT_per_m", w.floor_nT_per_m}};
}

std::string to_text(const Waterfall& w) {
  std::string out;
  const auto to = std::back_inserter(out);
  double top = w.without_nT;
  for (const WaterfallStep& s : w.steps) top = std::max({top, s.first_nT, s.last_nT});
  const auto total = [&](const char* what, double nT, double nT_per_m) {
    fmt::format_to(to, "{:<40} {:>9.3f} {:>9.3f}  {}\n", what, nT, nT_per_m, bar(nT, top, kBarWidth));
  };
  fmt::format_to(to, "{:<40} {:>9} {:>9}\n", "what each effect takes out", "nT", "nT/m");
  total("without any effect", w.without_nT, w.without_nT_per_m);
  for (const WaterfallStep& s : w.steps) {
    fmt::format_to(to, "  {}\n", s.spec);
    total("    added first takes out", s.first_nT, s.first_nT_per_m);
    total("    dropped last brings back", s.last_nT, s.last_nT_per_m);
  }
  total("with all of them", w.with_nT, w.with_nT_per_m);
  total("noise", w.floor_nT, w.floor_nT_per_m);
  out += "nT: the residual; nT/m: error of the tensor, rms of its six components; parts add up in squares\n";
  return out;
}

}  // namespace mgtd::calib
