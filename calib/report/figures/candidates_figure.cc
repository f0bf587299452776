// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/candidates_figure.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "calib/report/figures/plot.h"
#include "calib/report/figures/text_width.h"

namespace mgtd::calib::report::figures {
namespace {

constexpr double kCandidateRow = 20;
constexpr std::size_t kUntestableShown = 4;

std::set<std::size_t> alternatives_of(const CandidatesValues& v, std::size_t winner) {
  std::set<std::size_t> out;
  for (std::size_t j = 0; j < v.candidates.size(); ++j) {
    const auto& names = v.candidates[winner].could_also_be;
    if (j != winner && std::find(names.begin(), names.end(), v.candidates[j].effect) != names.end())
      out.insert(j);
  }
  return out;
}

/// A hatched bracket at the right of the rows that cannot be told apart.
void bracket(Drawing& drawing, const Plot& plot, std::size_t winner,
             const std::set<std::size_t>& alternatives) {
  if (alternatives.empty()) return;
  const double x = plot.box().x + plot.box().width - 16;
  const auto row = [&](std::size_t i) { return plot.y()(-static_cast<double>(i)); };
  const std::size_t first = std::min(winner, *alternatives.begin()),
                    last = std::max(winner, *alternatives.rbegin());
  drawing.hatch(x, row(first) - 6, 9, row(last) - row(first) + 12);
  drawing.open({.stroke = Tone::ink, .width = 1.2});
  for (const std::size_t i : alternatives) drawing.line({x - 7, row(i)}, {x, row(i)});
  drawing.line({x - 7, row(winner)}, {x, row(winner)});
  drawing.close();
}

std::string value_text(const Candidate& s) {
  return fmt::format("{:.1f}{}{}{}", s.d, s.size.empty() ? "" : " · ", s.size,
                     s.plausible ? "" : " · larger than occurs");
}

std::string good_text(const CandidatesValues& v) {
  if (v.candidates.empty()) return "nothing could be tested.";
  const auto beyond = std::count_if(v.candidates.begin(), v.candidates.end(),
                                    [&](const Candidate& s) { return s.d >= v.seen_d; });
  const Candidate& first = v.candidates.front();
  std::string out = fmt::format(
      "all bars are short of the dashed line. Here {} of {} reach it; the strongest is {}{}{}, d = {:.1f}, "
      "{}.",
      beyond, v.tried, first.effect, first.where.empty() ? "" : " at ", first.where, first.d, first.p);
  if (!first.could_also_be.empty())
    out += fmt::format(" These poses cannot tell it from {}.", fmt::join(first.could_also_be, ", "));
  return out;
}

}  // namespace

Figure candidates_figure(const CandidatesValues& v) {
  const std::size_t greyed = std::min(kUntestableShown, v.untestable.size());
  const auto rows = static_cast<double>(std::max<std::size_t>(1, v.candidates.size() + greyed));
  double label = 120, most = v.seen_d, room = 40;
  Axis names{.label = "", .range = {-rows + 0.5, 0.5}, .names = {}};
  for (std::size_t i = 0; i < v.candidates.size(); ++i) {
    const Candidate& s = v.candidates[i];
    const std::string text = s.where.empty() ? s.effect : s.effect + " · " + s.where;
    names.names.push_back({-static_cast<double>(i), text});
    label = std::max(label, text_width(text, kFontSize) + 20);
    most = std::max(most, s.d);
    room = std::max(room, text_width(value_text(s), kFontSize) + 42);
  }
  for (std::size_t i = 0; i < greyed; ++i) {
    names.names.push_back({-static_cast<double>(v.candidates.size() + i), v.untestable[i]});
    label = std::max(label, text_width(v.untestable[i], kFontSize) + 20);
  }
  label = std::min(label, 330.0);
  if (names.names.empty()) names.names.push_back({1e9, ""});
  const bool log = most > 5 * v.seen_d;
  const double bars = std::max(0.3, 1 - room / (820 - label - 14));  // share of the width
  const Axis d{.label = "size d, in units of its own uncertainty",
               .range = log ? Range{1, std::pow(most, 1 / bars)} : Range{0, most / bars},
               .kind = log ? ScaleKind::log : ScaleKind::linear};
  Drawing drawing("candidates", 820, 26 + kCandidateRow * rows + Plot::kBottom);
  Plot plot(drawing, {label, 26, 820 - label - 14, kCandidateRow * rows}, d, names);
  plot.rule_x(v.seen_d, {.stroke = Tone::ink, .width = 1.1, .dash = "4 3"});
  for (std::size_t i = 0; i < v.candidates.size(); ++i) {
    const Candidate& s = v.candidates[i];
    const double y = plot.y()(-static_cast<double>(i)), end = plot.x()(std::max(s.d, d.range.from));
    drawing.open({.fill = s.named ? Tone::vermilion : Tone::grey, .opacity = s.plausible ? 0.9 : 0.4});
    drawing.rect(label, y - 6, std::max(1.0, end - label), 12);
    drawing.close();
    drawing.text_over({end + 5, y + 4}, value_text(s));
  }
  for (std::size_t i = 0; i < greyed; ++i) {
    const double y = plot.y()(-static_cast<double>(v.candidates.size() + i));
    drawing.hatch(label + 1, y - 6, 90, 12);
    drawing.text_over({label + 98, y + 4}, "not testable in this run", Anchor::start, Tone::quiet);
  }
  drawing.text({plot.x()(v.seen_d), 18}, fmt::format("d = {:g}: seen in 99 of 100 runs", v.seen_d),
               plot.x()(v.seen_d) > 560 ? Anchor::end : Anchor::start, Tone::quiet);
  std::set<std::size_t> done;
  for (std::size_t i = 0; i < v.candidates.size(); ++i) {
    if (!v.candidates[i].named || done.contains(i)) continue;
    bracket(drawing, plot, i, alternatives_of(v, i));
    done.insert(i);
    break;  // one bracket: that of the first name
  }
  Figure out{.name = "candidates",
             .title = "What could be missing",
             .svg = {},
             .caption = fmt::format(
                 "Every effect of the library was tried on what the model leaves, with calibration, "
                 "attitude and field free; the {} strongest of {} are shown. Orange: named by the "
                 "verdict. A hatched bracket joins those that these poses cannot tell apart.",
                 v.candidates.size(), v.tried),
             .good = good_text(v),
             .data = {.head = {"effect", "where", "d", "p", "size", "could also be"}, .rows = {}},
             .wide = true};
  for (const Candidate& s : v.candidates)
    out.data.rows.push_back({s.effect, s.where, fmt::format("{:.1f}", s.d), s.p, s.size,
                             fmt::format("{}", fmt::join(s.could_also_be, ", "))});
  out.svg = drawing.finished(out.title, out.caption);
  return out;
}

}  // namespace mgtd::calib::report::figures
