// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/limits_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "calib/report/figures/plot.h"
#include "calib/report/figures/text_width.h"

namespace mgtd::calib::report::figures {
namespace {

constexpr double kLimitRow = 17, kCannotTell = 0.95;

/// Mean correlation between the members of two groups.
double likeness(const std::vector<std::vector<double>>& r, const std::vector<std::size_t>& a,
                const std::vector<std::size_t>& b) {
  double sum = 0;
  for (const std::size_t i : a)
    for (const std::size_t j : b) sum += std::isfinite(r[i][j]) ? r[i][j] : 0;
  return sum / static_cast<double>(a.size() * b.size());
}

}  // namespace

std::vector<std::size_t> order_by_likeness(const std::vector<std::vector<double>>& correlation) {
  std::vector<std::vector<std::size_t>> groups(correlation.size());
  for (std::size_t i = 0; i < groups.size(); ++i) groups[i] = {i};
  while (groups.size() > 1) {
    std::size_t a = 0, b = 1;
    double most = -1;
    for (std::size_t i = 0; i < groups.size(); ++i) {
      for (std::size_t j = i + 1; j < groups.size(); ++j) {
        const double like = likeness(correlation, groups[i], groups[j]);
        if (like > most + 1e-12) most = like, a = i, b = j;
      }
    }
    groups[a].insert(groups[a].end(), groups[b].begin(), groups[b].end());
    groups.erase(groups.begin() + static_cast<std::ptrdiff_t>(b));
  }
  return groups.empty() ? std::vector<std::size_t>{} : groups.front();
}

Figure detectable_figure(const DetectableValues& v) {
  std::vector<SmallestSize> sizes = v.sizes;
  std::stable_sort(sizes.begin(), sizes.end(), [](const SmallestSize& a, const SmallestSize& b) {
    return (a.ratio > 0 ? a.ratio : 1e300) < (b.ratio > 0 ? b.ratio : 1e300);
  });
  const auto rows = static_cast<double>(std::max<std::size_t>(1, sizes.size() + v.untestable.size()));
  double label = 120;
  std::vector<double> ratios{1};
  Axis names{.label = "", .range = {-rows + 0.5, 0.5}, .names = {{1e9, ""}}};
  const auto name_row = [&](std::size_t i, const std::string& text) {
    names.names.push_back({-static_cast<double>(i), text});
    label = std::max(label, text_width(text, kFontSize) + 20);
  };
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    name_row(i, sizes[i].effect);
    if (sizes[i].ratio > 0) ratios.push_back(sizes[i].ratio);
  }
  for (std::size_t i = 0; i < v.untestable.size(); ++i) name_row(sizes.size() + i, v.untestable[i]);
  label = std::min(label, 280.0);
  Range range = range_of(ratios, ScaleKind::log, 0.06);
  const double span = range.to / range.from;
  range.to *= std::pow(span, 0.4);  // room for the sizes as text
  Drawing drawing("detectable", 820, 24 + kLimitRow * rows + Plot::kBottom);
  Plot plot(drawing, {label, 24, 820 - label - 14, kLimitRow * rows},
            {.label = "smallest size that is seen, over the size that usually occurs",
             .range = range,
             .kind = ScaleKind::log},
            names);
  plot.rule_x(1, {.stroke = Tone::ink, .width = 1.1, .dash = "4 3"});
  std::size_t unseen = 0;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const double y = plot.y()(-static_cast<double>(i));
    if (!(sizes[i].ratio > 0)) {
      ++unseen;
      drawing.hatch(label + 1, y - 5,
                    plot.x()(ratios.empty() ? 1 : *std::max_element(ratios.begin(), ratios.end())) - label,
                    10);
      drawing.text_over({plot.x()(*std::max_element(ratios.begin(), ratios.end())) + 6, y + 4},
                        "at no size that occurs");
      continue;
    }
    const double end = plot.x()(sizes[i].ratio);
    unseen += sizes[i].ratio > 1 ? 1U : 0U;
    drawing.open({.fill = sizes[i].ratio > 1 ? Tone::vermilion : Tone::blue, .opacity = 0.85});
    drawing.rect(label, y - 5, std::max(1.0, end - label), 10);
    drawing.close();
    drawing.text_over({end + 5, y + 4}, sizes[i].text);
  }
  for (std::size_t i = 0; i < v.untestable.size(); ++i) {
    const double y = plot.y()(-static_cast<double>(sizes.size() + i));
    drawing.hatch(label + 1, y - 5, plot.box().width * 0.5, 10);
    drawing.text_over({label + plot.box().width * 0.5 + 7, y + 4}, "not testable", Anchor::start,
                      Tone::quiet);
  }
  drawing.text({plot.x()(1), 16}, "usual size", Anchor::middle, Tone::quiet);
  Figure out{
      .name = "detectable",
      .title = "What this run would not have seen",
      .svg = {},
      .caption =
          "Smallest size of each effect that is seen in 99 of 100 runs like this one, over the size at which "
          "it usually occurs. Orange: it may be there at its usual size, unseen. Hatched: not testable.",
      .good = fmt::format(
          "all bars end left of the dashed line, none is hatched. Here {} of {} effects may be there "
          "unseen at their usual size, and {} cannot be tested.",
          unseen, sizes.size(), v.untestable.size()),
      .data = {.head = {"effect", "smallest size (where)", "over the usual size"}, .rows = {}},
      .wide = true};
  for (const SmallestSize& s : sizes)
    out.data.rows.push_back(
        {s.effect, s.text, s.ratio > 0 ? short_number(s.ratio) : "at no size that occurs"});
  for (const std::string& u : v.untestable) out.data.rows.push_back({u, "not testable", ""});
  out.svg = drawing.finished(out.title, out.caption);
  return out;
}

Figure confusion_figure(const ConfusionValues& v) {
  const std::vector<std::size_t> order = order_by_likeness(v.correlation);
  const auto n = static_cast<double>(std::max<std::size_t>(1, order.size()));
  double label = 60;
  for (const std::string& e : v.effects) label = std::max(label, text_width(e, 10) + 12);
  label = std::min(label, 250.0);
  const double cell = std::min(20.0, (820 - label - 130) / n), top = 10, side = cell * n;
  const double foot = std::min(label, 190.0);
  Drawing drawing("confusion", 820, top + side + foot + 4);
  constexpr int kSteps = 8;
  for (int step = 1; step <= kSteps; ++step) {
    drawing.open(
        {.fill = Tone::blue, .opacity = 0.06 + 0.94 * std::pow(step / static_cast<double>(kSteps), 1.5)});
    for (std::size_t i = 0; i < order.size(); ++i) {
      for (std::size_t j = 0; j < order.size(); ++j) {
        const double r = v.correlation[order[i]][order[j]];
        if (i != j && std::isfinite(r) &&
            std::clamp(static_cast<int>(std::ceil(r * kSteps)), 1, kSteps) == step)
          drawing.rect(label + static_cast<double>(j) * cell, top + static_cast<double>(i) * cell, cell - 0.6,
                       cell - 0.6);
      }
    }
    drawing.close();
  }
  std::size_t pairs = 0, alike = 0;
  std::string worst;
  double largest = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    drawing.open({.fill = Tone::rule});
    drawing.rect(label + static_cast<double>(i) * cell, top + static_cast<double>(i) * cell, cell - 0.6,
                 cell - 0.6);
    drawing.close();
    drawing.text({label - 6, top + (static_cast<double>(i) + 0.5) * cell + 3.5}, v.effects[order[i]],
                 Anchor::end, Tone::ink, std::min(10.0, cell));
    for (std::size_t j = 0; j < i; ++j) {
      const double r = v.correlation[order[i]][order[j]];
      if (!std::isfinite(r)) continue;
      ++pairs;
      alike += r > kCannotTell ? 1U : 0U;
      if (r > largest) largest = r, worst = v.effects[order[j]] + " and " + v.effects[order[i]];
    }
  }
  drawing.open({.stroke = Tone::vermilion, .width = 1.6});
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = 0; j < order.size(); ++j)
      if (i != j && v.correlation[order[i]][order[j]] > kCannotTell)
        drawing.rect(label + static_cast<double>(j) * cell + 0.5, top + static_cast<double>(i) * cell + 0.5,
                     cell - 1.6, cell - 1.6);
  drawing.close();
  for (std::size_t j = 0; j < order.size(); ++j) {
    const std::string_view whole = v.effects[order[j]];
    drawing.text_down({label + (static_cast<double>(j) + 0.5) * cell - 3, top + side + 6}, whole,
                      std::min(10.0, cell));
  }
  const double key = label + side + 26;
  for (int step = 1; step <= kSteps; ++step) {
    drawing.open(
        {.fill = Tone::blue, .opacity = 0.06 + 0.94 * std::pow(step / static_cast<double>(kSteps), 1.5)});
    drawing.rect(key, top + 18 + (kSteps - step) * 14, 14, 14);
    drawing.close();
  }
  drawing.text({key, top + 10}, "correlation", Anchor::start, Tone::quiet);
  drawing.text({key + 20, top + 26}, "1", Anchor::start, Tone::quiet);
  drawing.text({key + 20, top + 18 + kSteps * 14}, "0", Anchor::start, Tone::quiet);
  drawing.open({.stroke = Tone::vermilion, .width = 1.6});
  drawing.rect(key, top + 18 + kSteps * 14 + 10, 14, 14);
  drawing.close();
  drawing.text({key + 20, top + 18 + kSteps * 14 + 21}, fmt::format("above {:.2f}", kCannotTell),
               Anchor::start, Tone::quiet);
  Figure out{
      .name = "confusion",
      .title = "What these poses cannot tell apart",
      .svg = {},
      .caption =
          "Correlation of the signatures of every two effects on these poses, calibration, attitude and "
          "field "
          "taken out. Framed: so much alike that a run like this does not split them.",
      .good = fmt::format("no frame off the diagonal. Here {} of {} pairs are framed{}.", alike, pairs,
                          worst.empty() ? "" : fmt::format("; most alike are {}, {:.2f}", worst, largest)),
      .data = {.head = {"effect", "with", "correlation"}, .rows = {}, .note = "Pairs above 0.5."},
      .wide = true};
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (v.correlation[order[i]][order[j]] > 0.5)
        out.data.rows.push_back({v.effects[order[j]], v.effects[order[i]],
                                 fmt::format("{:.3f}", v.correlation[order[i]][order[j]])});
  out.svg = drawing.finished(out.title, out.caption);
  return out;
}

}  // namespace mgtd::calib::report::figures
