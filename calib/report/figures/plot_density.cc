// SPDX-License-Identifier: Apache-2.0
// Of Plot: what is drawn in place of thousands of marks.
#include <algorithm>
#include <array>
#include <cmath>

#include "calib/report/figures/density.h"
#include "calib/report/figures/plot.h"

namespace mgtd::calib::report::figures {

/// Bins of one count are one group, so that the text stays short.
void Plot::density(std::span<const Series> all) {
  constexpr double kBin = 5;
  const int columns = std::max(1, static_cast<int>(box_.width / kBin)),
            rows = std::max(1, static_cast<int>(box_.height / kBin));
  std::vector<double> u, v, x, y;
  for (const Series& s : all) {
    for (std::size_t i = 0; i < s.x.size(); ++i) {
      if (!holds(s.x[i], s.y[i])) continue;
      x.push_back(s.x[i]), y.push_back(s.y[i]);
      u.push_back((x_(s.x[i]) - box_.x) / box_.width), v.push_back((y_(s.y[i]) - box_.y) / box_.height);
    }
  }
  const BinCounts bins = bin_counts(u, v, columns, rows);
  constexpr int kSteps = 7;
  const double w = box_.width / columns, h = box_.height / rows;
  for (int step = 1; step <= kSteps; ++step) {
    drawing_.open({.fill = Tone::blue, .opacity = 0.1 + 0.8 * step / kSteps}, "density");
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        const int count = bins.counts[static_cast<std::size_t>(row * columns + column)];
        if (count == 0) continue;
        const double share = std::log1p(count) / std::log1p(bins.most);
        if (std::clamp(static_cast<int>(std::ceil(share * kSteps)), 1, kSteps) == step)
          drawing_.rect(box_.x + column * w, box_.y + row * h, w, h);
      }
    }
    drawing_.close();
  }
  constexpr std::array kShares{0.1, 0.5, 0.9};
  const RunningQuantiles q = running_quantiles(x, y, kShares);
  line(q.centres, q.values[0], {.stroke = Tone::ink, .width = 1, .dash = "3 2"});
  line(q.centres, q.values[2], {.stroke = Tone::ink, .width = 1, .dash = "3 2"});
  line(q.centres, q.values[1], {.stroke = Tone::ink, .width = 1.6});
}

}  // namespace mgtd::calib::report::figures
