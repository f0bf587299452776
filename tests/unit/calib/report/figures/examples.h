// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "calib/report/figures/accuracy_figure.h"
#include "calib/report/figures/candidates_figure.h"
#include "calib/report/figures/lanes_figure.h"
#include "calib/report/figures/law_figure.h"
#include "calib/report/figures/limits_figures.h"
#include "calib/report/figures/parameter_figures.h"
#include "calib/report/figures/residual_figure.h"
#include "calib/report/figures/scatter_figures.h"
#include "calib/report/figures/sky_figures.h"
#include "calib/report/figures/waterfall_figure.h"

/// One example of every figure, of the kind that a run with a warming sensor gives: made by formulas, the
/// same on every computer. `poses` of zero and one are the fewest there can be; of thousands, what a
/// recording has.
namespace mgtd::calib::report::figures::testing {

/// About normal and independent, by a fixed rule: four numbers of a splitmix64 sequence, summed.
inline double noise_at(std::size_t i) {
  double sum = 0;
  for (std::uint64_t k = 0; k < 4; ++k) {
    std::uint64_t z = (4 * i + k + 1) * 0x9e3779b97f4a7c15ULL;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    sum += static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53 - 0.5;
  }
  return sum * 1.732;
}

/// Spread evenly over the sphere.
inline Eigen::Vector3d direction_at(std::size_t i, std::size_t n) {
  const double z = 1 - 2 * (static_cast<double>(i) + 0.5) / static_cast<double>(n),
               turn = 2.399963229728653 * static_cast<double>(i);
  return {std::sqrt(1 - z * z) * std::cos(turn), std::sqrt(1 - z * z) * std::sin(turn), z};
}

inline ResidualValues residual_example(std::size_t n) {
  ResidualValues out{.name = "residual-temperature",
                     .title = "Residual against the temperature of sensor 3",
                     .x_label = "temperature of s3, °C",
                     .y_label = "residual, nT",
                     .what = "Reading less prediction of s3.z.",
                     .before = {.series = {}, .p_text = "p = 2e-64"},
                     .after = {.series = {}, .p_text = "p = 0.41"},
                     .stands_out = true};
  Series before{.name = "s3.z"}, after{.name = "s3.z"};
  for (std::size_t i = 0; i < n; ++i) {
    const double T = 18 + 3 * static_cast<double>(i) / static_cast<double>(n) + 0.1 * noise_at(i + 7);
    before.x.push_back(T), after.x.push_back(T);
    before.y.push_back(1.5 * (T - 19.5) + 0.2 * noise_at(i)), after.y.push_back(0.2 * noise_at(i));
    before.poses.push_back(static_cast<int>(i) + 1), after.poses.push_back(static_cast<int>(i) + 1);
  }
  if (n > 2) before.hollow.assign(n, false), before.hollow[2] = true;
  out.before.series = {before}, out.after.series = {after};
  return out;
}

inline QqValues qq_example(std::size_t n) {
  QqValues out{.before = {}, .after = {}, .left_out = 2};
  for (std::size_t i = 0; i < n; ++i) {
    const double share = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
    const double q =
        4.91 * (std::pow(share, 0.14) - std::pow(1 - share, 0.14));  // Tukey's lambda: near the normal
    const double half = 0.25 + 0.08 * q * q;
    for (QqView* v : {&out.before, &out.after})
      v->quantile.push_back(q), v->low.push_back(q - half), v->high.push_back(q + half);
    out.before.residual.push_back(q * (1 + 0.12 * q * q)), out.after.residual.push_back(q * 1.02);
  }
  return out;
}

inline AutocorrelationValues autocorrelation_example() {
  AutocorrelationValues out{
      .sensors = {"s1", "s2", "s3", "s4"}, .before = {}, .after = {}, .bound = 0.09, .rho = 0.05};
  for (std::size_t s = 0; s < 4; ++s) {
    std::vector<double> before, after;
    for (std::size_t k = 1; k <= 20; ++k) {
      before.push_back((s == 2 ? std::exp(-0.12 * static_cast<double>(k)) : 0) + 0.04 * noise_at(20 * s + k));
      after.push_back(0.04 * noise_at(20 * s + k + 3));
    }
    out.before.push_back(before), out.after.push_back(after);
  }
  return out;
}

inline SkiesValues skies_example(std::size_t n) {
  SkiesValues out{.skies = {}, .what = "|b| of each sensor less F.", .stands_out = true};
  for (std::size_t s = 0; s < 4; ++s) {
    Sky sky{.sensor = "s" + std::to_string(s + 1), .p_text = s == 2 ? "p = 1e-30" : "p = 0.3"};
    for (std::size_t i = 0; i < n; ++i) {
      const Eigen::Vector3d d = direction_at(i, n);
      sky.directions.push_back(d), sky.poses.push_back(static_cast<int>(i) + 1);
      sky.residual_nT.push_back((s == 2 ? 1.2 * d.y() : 0) + 0.1 * noise_at(100 * s + i));
      sky.after_nT.push_back(0.1 * noise_at(100 * s + i));
    }
    out.skies.push_back(std::move(sky));
  }
  return out;
}

inline WaterfallValues waterfall_example() {
  return {.effects = {"axis.offset.temperature@s3.z", "site.gradient"},
          .residual = {.unit = "nT",
                       .without = 0.605,
                       .with = 0.019,
                       .floor = 0.019,
                       .first_share = {0.596, 0.11},
                       .last_share = {0.59, 0.1},
                       .held_out = 0.0205},
          .tensor = FallValues{.unit = "nT/m",
                               .without = 1.9,
                               .with = 0.07,
                               .floor = 0.066,
                               .first_share = {1.88, 0.3},
                               .last_share = {1.87, 0.27},
                               .held_out = 0.081}};
}

inline CandidatesValues candidates_example() {
  return {
      .candidates =
          {{.effect = "axis.offset.temperature",
            .where = "s3.z",
            .d = 36.7,
            .p = "p = 2e-64",
            .size = "3.00 nT/°C",
            .could_also_be = {"axis.offset.drift"},
            .named = true},
           {.effect = "axis.offset.drift", .where = "s3.z", .d = 36.5, .p = "p = 9e-64", .size = "2.6 nT/h"},
           {.effect = "axis.scale.temperature",
            .where = "s3.z",
            .d = 11.2,
            .p = "p = 3e-12",
            .size = "40 ppm/°C"},
           {.effect = "site.gradient",
            .where = "site",
            .d = 4.1,
            .p = "p = 0.2",
            .size = "900 nT/m",
            .plausible = false}},
      .tried = 46,
      .untestable = {"axis.hysteresis", "platform.current"}};
}

inline EvidenceValues evidence_example(std::size_t n) {
  EvidenceValues out{.effect = "axis.offset.temperature",
                     .where = "s3.z",
                     .x_label = "signature of the effect, °C",
                     .slope_text = "3.00 ± 0.08 nT/°C",
                     .slope = 3,
                     .slope_sd = 0.08,
                     .largest_share = 0.04};
  for (std::size_t i = 0; i < n; ++i) {
    const double x = 0.4 * noise_at(i + 11);
    out.x.push_back(x), out.y.push_back(3 * x + 0.2 * noise_at(i)),
        out.poses.push_back(static_cast<int>(i) + 1);
  }
  return out;
}

inline CoverageValues coverage_example(std::size_t n) {
  CoverageValues out;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d d = direction_at(i, n);
    if (d.x() > 0.75 && d.z() > -0.2) {
      out.planned.push_back(d);
    } else {
      out.measured.push_back(d);
    }
  }
  return out;
}

inline AccuracyValues accuracy_example() {
  AccuracyValues out{.x_label = "minutes", .wanted_nT_per_m = 0.6};
  for (const int n : {24, 32, 43, 57, 76, 101, 134, 157}) {
    out.poses.push_back(n), out.x.push_back(0.9 * n);
    out.worst_nT_per_m.push_back(8 * std::pow(n / 24.0, -1.3));
  }
  return out;
}

inline DetectableValues detectable_example() {
  return {.sizes = {{"axis.offset.temperature", "s3.z", 0.02, "0.02 nT/°C (s3.z)"},
                    {"axis.hysteresis", "s1.x", 0.4, "0.6 nT (s1.x)"},
                    {"site.gradient", "Gxx", 3.1, "80 nT/m (Gxx)"},
                    {"table.wobble", "all", 0, ""}},
          .untestable = {"platform.current"}};
}

inline ConfusionValues confusion_example() {
  return {.effects = {"axis.offset.temperature", "site.gradient", "axis.offset.drift",
                      "axis.scale.temperature", "axis.scale.drift"},
          .correlation = {{1, 0.1, 0.99, 0.3, 0.28},
                          {0.1, 1, 0.12, 0.05, 0.07},
                          {0.99, 0.12, 1, 0.27, 0.31},
                          {0.3, 0.05, 0.27, 1, 0.97},
                          {0.28, 0.07, 0.31, 0.97, 1}}};
}

inline LanesValues lanes_example(std::size_t n) {
  LanesValues out{.name = "time",
                  .title = "One time axis",
                  .what = "What happened at the same time.",
                  .good = "nothing follows anything. Here the residual grows by 1 nT/h.",
                  .lanes = {},
                  .gaps = {{0.9, 1.1, "a car passed"}}};
  Lane residual{.name = "residual", .unit = "nT", .series = {{.name = "s3.z", .tone = Tone::green}}};
  Lane temperature{.name = "temperature", .unit = "°C", .joined = true};
  Lane closure{.name = "closure",
               .unit = "chi-square",
               .series = {{.name = "chi-square"}},
               .limit = 18.5,
               .limit_text = "1 of 1000",
               .log = true};
  for (std::size_t s = 0; s < 2; ++s)
    temperature.series.push_back({.name = "s" + std::to_string(s + 1), .tone = sensor_tone(s)});
  for (std::size_t i = 0; i < n; ++i) {
    const double t = 2.5 * static_cast<double>(i) / static_cast<double>(n);
    if (t > 0.9 && t < 1.1) continue;
    residual.series[0].x.push_back(t), residual.series[0].y.push_back(t - 1.2 + 0.2 * noise_at(i));
    closure.series[0].x.push_back(t),
        closure.series[0].y.push_back(4 * std::exp(0.8 * t + 0.5 * noise_at(i)));
    for (std::size_t s = 0; s < 2; ++s)
      temperature.series[s].x.push_back(t),
          temperature.series[s].y.push_back(18 + (s == 1 ? 1.2 * t : 0.3 * t));
  }
  out.lanes = {residual, temperature, closure};
  return out;
}

inline std::vector<std::string> parameters_example() {
  return {"alpha", "beta", "gamma", "cx", "cy", "cz", "axy", "axz", "ayz", "ix", "iy", "iz"};
}

inline HistoryValues history_example() {
  HistoryValues out{.sensors = {"s1", "s2", "s3", "s4"}, .parameters = parameters_example(), .points = {}};
  static const char* const kWhen[] = {"2026-02-03", "2026-03-17", "2026-05-11", "2026-08-02", "2026-11-20"};
  static constexpr double kDay[] = {0, 42, 97, 180, 290};
  for (std::size_t p = 0; p < 5; ++p) {
    HistoryPoint point{.when = kWhen[p], .day = kDay[p], .shifts = {}};
    for (std::size_t s = 0; s < 4; ++s) {
      std::vector<double> shifts;
      for (std::size_t k = 0; k < 12; ++k)
        shifts.push_back(p == 2 && s == 1 && k == 2 ? 9 : 0.9 * noise_at(60 * p + 12 * s + k));
      point.shifts.push_back(shifts);
    }
    out.points.push_back(std::move(point));
  }
  return out;
}

inline PriceValues price_example() {
  PriceValues out{.sensors = {"s1", "s2", "s3", "s4"},
                  .parameters = parameters_example(),
                  .sd_ratio = {},
                  .tensor_before_nT_per_m = 0.41,
                  .tensor_after_nT_per_m = 0.43};
  for (std::size_t s = 0; s < 4; ++s) {
    std::vector<double> sd_ratio;
    for (std::size_t k = 0; k < 12; ++k)
      sd_ratio.push_back(s == 2 && k == 11 ? 1.9 : 1 + 0.02 * std::abs(noise_at(12 * s + k)));
    out.sd_ratio.push_back(sd_ratio);
  }
  return out;
}

inline ImpactValues impact_example() {
  return {.rows = {{"site.gradient", "zz", 20},
                   {"axis.offset.temperature@s3.z", "xz", 4.1},
                   {"axis.hysteresis", "xx", 0.02}},
          .known_nT_per_m = 0.41};
}

/// A curve of the third power whose best formula is within the band and whose second is not.
inline LawValues law_example() {
  LawValues out{.x_label = "temperature, °C",
                .where = "s3.z",
                .x = {},
                .y_nT = {},
                .sd_nT = {},
                .simultaneous = 2.8,
                .formulas = {{.name = "T^3"}, {.name = "exp(T)"}}};
  for (int i = 0; i <= 40; ++i) {
    const double u = i / 20.0 - 1;
    out.x.push_back(21 + 3 * u);
    out.y_nT.push_back(2 * u * u * u + 0.05 * noise_at(static_cast<std::size_t>(i)));
    out.sd_nT.push_back(0.05 + 0.1 * u * u);
    out.formulas[0].y_nT.push_back(2 * u * u * u);
    out.formulas[1].y_nT.push_back(1.4 * std::exp(u) - 1.6);
  }
  return out;
}

/// Every figure that there is.
inline std::vector<Figure> examples(std::size_t poses) {
  return {residual_figure(residual_example(poses)),
          qq_figure(qq_example(poses)),
          autocorrelation_figure(autocorrelation_example()),
          skies_figure(skies_example(poses)),
          waterfall_figure(waterfall_example()),
          candidates_figure(candidates_example()),
          evidence_figure(evidence_example(poses)),
          coverage_figure(coverage_example(poses)),
          accuracy_figure(accuracy_example()),
          detectable_figure(detectable_example()),
          confusion_figure(confusion_example()),
          lanes_figure(lanes_example(poses)),
          history_figure(history_example()),
          price_figure(price_example()),
          impact_figure(impact_example()),
          law_figure(law_example())};
}

}  // namespace mgtd::calib::report::figures::testing
