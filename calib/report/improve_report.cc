// SPDX-License-Identifier: Apache-2.0
#include "calib/report/improve_report.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "calib/report/explain_note_text.h"
#include "calib/report/fit_report_json.h"
#include "calib/report/residual_words.h"
#include "calib/report/text_bar.h"
#include "calib/stats/probability.h"
#include "proto/json_text.h"

namespace mgtd::calib::report {
namespace {

using nlohmann::json;

constexpr std::size_t kNumbers = 47;  ///< columns behind the name, with the gap before the bar

json round_json(const criticism::search::ImproveRound& r) {
  return {{"added", r.added.effect},
          {"spec", r.added.spec},
          {"where", r.added.where},
          {"d", r.added.d},
          {"log10_p", r.added.log10_p},
          {"possible", r.possible},
          {"rms_before_nT", r.rms_before_nT},
          {"rms_after_nT", r.rms_after_nT},
          {"held_out_before_nT", or_null(r.held_out_before_nT)},
          {"held_out_after_nT", or_null(r.held_out_after_nT)},
          {"predicted_fall", r.predicted_fall},
          {"realised_fall", r.realised_fall},
          {"variance_price", {{"growth_of_sd", r.price.sd_ratio}, {"parameter", r.price.parameter}}}};
}

std::string stop_text(const criticism::search::ImproveReport& r) {
  switch (r.stopped) {
    case criticism::search::ImproveStop::nothing_stands_out:
      return "nothing stands out any more";
    case criticism::search::ImproveStop::no_effect_looks_like_it:
      return "something is left that no effect of the library looks like";
    case criticism::search::ImproveStop::bad_data:
      return "the data contradict themselves";
    case criticism::search::ImproveStop::round_limit:
      return "the number of rounds is reached";
    case criticism::search::ImproveStop::nothing_can_be_added:
      return "a misfit remains, but no effect that could be added explains it";
    case criticism::search::ImproveStop::held_out_error_rises:
      return fmt::format("{} was not added: on poses left out the error rises from {:.4g} to {:.4g} nT",
                         r.refused->spec, r.refused->held_out_before_nT, r.refused->held_out_after_nT);
  }
  return "";
}

std::string held_out(const std::optional<double>& x) { return x ? fmt::format("{:.3f}", *x) : "-"; }

/// A line for each round. A name that is too long for its column stands above its line.
std::string rounds_table(const criticism::search::ImproveReport& r, std::size_t width) {
  constexpr std::size_t kLeast = 12, kMost = 34;
  const std::size_t column = std::clamp(width, kNumbers + kLeast, kNumbers + kMost) - kNumbers;
  const double top = r.rounds.empty() ? r.fit.residual_nT : r.rounds.front().rms_before_nT;
  const int room = bar_room(width, column + kNumbers);
  std::string out;
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "{:<{}} {:>8} {:>8} {:>9} {:>9} {:>6}\n", "added", column, "d", "p", "residual",
                 "held out", "price");
  const auto before = r.rounds.empty() ? r.fit.held_out_residual_nT : r.rounds.front().held_out_before_nT;
  fmt::format_to(to, "{:<{}} {:>8} {:>8} {:>9.3f} {:>9} {:>6}  {}\n", "(nothing)", column, "", "", top,
                 held_out(before), "", bar(top, top, room));
  for (const criticism::search::ImproveRound& x : r.rounds) {
    std::string name = x.added.spec;
    if (name.size() > column) fmt::format_to(to, "{}\n", std::exchange(name, {}));
    fmt::format_to(to, "{:<{}} {:>8.1f} {:>8} {:>9.3f} {:>9} {:>6.2f}  {}\n", name, column, x.added.d,
                   stats::p_text(x.added.log10_p), x.rms_after_nT, held_out(x.held_out_after_nT),
                   x.price.sd_ratio, bar(x.rms_after_nT, top, room));
    if (!x.possible.empty()) fmt::format_to(to, "    could also be {}\n", fmt::join(x.possible, ", "));
  }
  return out;
}

}  // namespace

json to_json(const criticism::search::ImproveReport& r) {
  json rounds = json::array();
  for (const criticism::search::ImproveRound& round : r.rounds) rounds.push_back(round_json(round));
  const json fit = to_json(r.fit);
  return {{"schema", "mgt.improve/1"},
          {"rounds", std::move(rounds)},
          {"verdict", to_string(r.finding)},
          {"stopped", stop_text(r)},
          {"notes", note_texts(r.notes)},
          {"effects", fit["effects"]},
          {"fit", fit}};
}

std::string to_text(const criticism::search::ImproveReport& r, std::size_t width) {
  std::string out = rounds_table(r, width);
  const auto to = std::back_inserter(out);
  fmt::format_to(to, "residual: nT, {}\n", kResidualIs);
  fmt::format_to(to,
                 "held out: nT, the same on poses that the fit had not seen, a tenth of the run at a time\n");
  if (!r.rounds.empty())
    out +=
        "d: size of the effect in its own standard deviations; price: growth of the standard deviation of "
        "that parameter of the sensors that loses most\n";
  fmt::format_to(to, "noise of a pose mean: {:.3g} nT\n", r.fit.noise_nT);
  fmt::format_to(to, "stopped: {}\n", stop_text(r));
  for (const std::string& note : note_texts(r.notes)) fmt::format_to(to, "note: {}\n", note);
  return out;
}

}  // namespace mgtd::calib::report
