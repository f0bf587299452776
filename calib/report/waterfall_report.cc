// SPDX-License-Identifier: Apache-2.0
#include "calib/report/waterfall_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>

#include "calib/report/shown_number.h"
#include "calib/report/text_bar.h"

namespace mgtd::calib::report {
namespace {

using nlohmann::json;

constexpr int kBarWidth = 24;

}  // namespace

json to_json(const criticism::search::Waterfall& w) {
  json steps = json::array();
  for (const criticism::search::WaterfallStep& s : w.steps) {
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

std::string to_text(const criticism::search::Waterfall& w, std::size_t width) {
  constexpr std::size_t kBeforeBar = 62;
  const int room = bar_room(width, kBeforeBar, kBarWidth);
  std::string out;
  const auto to = std::back_inserter(out);
  double top = w.without_nT;
  for (const criticism::search::WaterfallStep& s : w.steps) top = std::max({top, s.first_nT, s.last_nT});
  const bool tensor = !std::isnan(w.without_nT_per_m);
  const auto total = [&](const char* what, double nT, double nT_per_m) {
    fmt::format_to(to, "{:<40} {:>9.3f}{}  {}\n", what, nT, tensor ? " " + shown_number(nT_per_m, 9, 3) : "",
                   bar(nT, top, room));
  };
  fmt::format_to(to, "{:<40} {:>9}{}\n", "what each effect takes out", "nT", tensor ? "      nT/m" : "");
  total("without any effect", w.without_nT, w.without_nT_per_m);
  for (const criticism::search::WaterfallStep& s : w.steps) {
    fmt::format_to(to, "  {}\n", s.spec);
    total("    added first takes out", s.first_nT, s.first_nT_per_m);
    total("    dropped last brings back", s.last_nT, s.last_nT_per_m);
  }
  total("with all of them", w.with_nT, w.with_nT_per_m);
  total("noise", w.floor_nT, w.floor_nT_per_m);
  out += fmt::format(
      "nT: the residual; {}parts add up in squares\n",
      tensor ? "nT/m: error of the tensor, rms of the components that the array determines; " : "");
  return out;
}

}  // namespace mgtd::calib::report
