// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/improve_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

#include "calib/criticism/sentence.h"
#include "calib/fit/fit_report_json.h"

namespace mgtd::calib {
namespace {

using nlohmann::json;

constexpr double kBar_characters = 40;

json maybe(const std::optional<double>& x) { return x ? json(*x) : json(); }

json round_json(const ImproveRound& r) {
  return {{"added", r.added.effect},
          {"spec", r.added.spec},
          {"where", r.added.where},
          {"d", r.added.d},
          {"log10_p", r.added.log10_p},
          {"possible", r.possible},
          {"rms_before_nT", r.rms_before_nT},
          {"rms_after_nT", r.rms_after_nT},
          {"held_out_before_nT", maybe(r.held_out_before_nT)},
          {"held_out_after_nT", maybe(r.held_out_after_nT)},
          {"predicted_fall", r.predicted_fall},
          {"realised_fall", r.realised_fall},
          {"variance_price", {{"growth_of_sd", r.price.growth}, {"parameter", r.price.parameter}}}};
}

std::string held_out(const std::optional<double>& x) { return x ? fmt::format("{:.3f}", *x) : "-"; }

}  // namespace

json to_json(const ImproveReport& r) {
  json rounds = json::array();
  for (const ImproveRound& round : r.rounds) rounds.push_back(round_json(round));
  const json fit = to_json(r.fit);
  return {{"schema", "mgt.improve/1"}, {"rounds", std::move(rounds)}, {"verdict", to_string(r.finding)},
          {"stopped", r.stopped},      {"effects", fit["effects"]},   {"fit", fit}};
}

std::string to_text(const ImproveReport& r) {
  std::string out;
  const auto to = std::back_inserter(out);
  const double top = r.rounds.empty() ? 1 : r.rounds.front().rms_before_nT;
  const auto bar = [&](double rms) {
    return std::string(static_cast<std::size_t>(std::clamp(rms / top, 0.0, 1.0) * kBar_characters), '#');
  };
  fmt::format_to(to, "{:<34} {:>8} {:>8}  {:>8} {:>8} {:>6}\n", "added", "d", "p", "rms nT", "held out",
                 "price");
  if (!r.rounds.empty()) {
    fmt::format_to(to, "{:<34} {:>8} {:>8}  {:>8.3f} {:>8} {:>6}  {}\n", "(nothing)", "", "", top,
                   held_out(r.rounds.front().held_out_before_nT), "", bar(top));
  }
  for (const ImproveRound& x : r.rounds) {
    fmt::format_to(to, "{:<34} {:>8.1f} {:>8}  {:>8.3f} {:>8} {:>6.2f}  {}\n", x.added.spec, x.added.d,
                   p_text(x.added.log10_p), x.rms_after_nT, held_out(x.held_out_after_nT), x.price.growth,
                   bar(x.rms_after_nT));
    if (!x.possible.empty()) fmt::format_to(to, "    could also be {}\n", fmt::join(x.possible, ", "));
  }
  if (!r.rounds.empty())
    out += "price: growth of the standard deviation of that parameter of the sensors that loses most\n";
  fmt::format_to(to, "stopped: {}\n", r.stopped);
  return out;
}

}  // namespace mgtd::calib
