// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/accuracy_figure.h"

#include <fmt/format.h>

#include <cmath>

#include "calib/report/figures/plot.h"

namespace mgtd::calib::report::figures {

std::string good_accuracy(double last_nT_per_m, int poses, const std::optional<double>& wanted_nT_per_m) {
  return fmt::format(
      "the curve has reached what was wanted{}, and falls as 1/√n. Here it ends at {} nT/m after {} poses.",
      wanted_nT_per_m ? fmt::format(", {} nT/m", short_number(*wanted_nT_per_m)) : "",
      short_number(last_nT_per_m), poses);
}

Figure accuracy_figure(const AccuracyValues& v) {
  Drawing drawing("accuracy", 410, 250);
  std::vector<double> ys = v.worst_nT_per_m;
  if (v.wanted_nT_per_m) ys.push_back(*v.wanted_nT_per_m);
  const Axis x{.label = v.x_label, .range = range_of(v.x, ScaleKind::log), .kind = ScaleKind::log};
  const Axis y{
      .label = "standard error, nT/m", .range = range_of(ys, ScaleKind::log, 0.08), .kind = ScaleKind::log};
  Plot plot(drawing, {Plot::kLeft + 6, 20, 410 - Plot::kLeft - 6 - Plot::kRight, 250 - 20 - Plot::kBottom}, x,
            y);
  Figure out{
      .name = "accuracy",
      .title = "The tensor's standard error while poses were measured",
      .svg = {},
      .caption =
          "Worst component of the tensor, by the calibration alone. Thin line: what 1/√n makes of the last "
          "value; above it, a pose still taught more than its share.",
      .good = {},
      .data = {.head = {v.x_label, "poses", "worst component, nT/m"}, .rows = {}}};
  if (v.x.empty()) {
    plot.message("the poses do not determine the parameters");
    out.good = "the curve reaches what was wanted. Here there is none.";
  } else {
    std::vector<double> guide;
    const double n = v.poses.back(), last = v.worst_nT_per_m.back();
    for (const int p : v.poses) guide.push_back(last * std::sqrt(n / p));
    plot.line(v.x, guide, {.stroke = Tone::quiet, .width = 1, .dash = "2 3"});
    plot.line(v.x, v.worst_nT_per_m, {.stroke = Tone::blue, .width = 1.8});
    plot.marks({.name = "", .x = v.x, .y = v.worst_nT_per_m, .tone = Tone::blue});
    if (v.wanted_nT_per_m)
      plot.rule_y(*v.wanted_nT_per_m, {.stroke = Tone::green, .width = 1.4, .dash = "5 3"});
    if (v.wanted_nT_per_m)
      drawing.text_over({plot.box().x + 6, plot.y()(*v.wanted_nT_per_m) - 5}, "wanted", Anchor::start,
                        Tone::green);
    out.good = good_accuracy(last, v.poses.back(), v.wanted_nT_per_m);
    out.stands_out = v.wanted_nT_per_m && last > *v.wanted_nT_per_m;
  }
  for (std::size_t i = 0; i < v.x.size(); ++i)
    out.data.rows.push_back(
        {short_number(v.x[i]), fmt::format("{}", v.poses[i]), short_number(v.worst_nT_per_m[i])});
  out.svg = drawing.finished(out.title, out.caption);
  return out;
}

}  // namespace mgtd::calib::report::figures
