// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/density.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace mgtd::calib::report::figures {
namespace {

/// Indices of the finite points, by x, in equally filled bins.
std::vector<std::vector<std::size_t>> equal_bins(std::span<const double> x, std::span<const double> y,
                                                 int bins) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < x.size(); ++i)
    if (std::isfinite(x[i]) && std::isfinite(y[i])) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return x[a] < x[b]; });
  std::vector<std::vector<std::size_t>> out;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool full = !out.empty() && out.back().size() * static_cast<std::size_t>(bins) >= order.size();
    if (out.empty() || (full && x[order[k]] > x[order[k - 1]])) out.emplace_back();
    out.back().push_back(order[k]);
  }
  return out;
}

double mean_of(std::span<const double> values, const std::vector<std::size_t>& at) {
  double sum = 0;
  for (const std::size_t i : at) sum += values[i];
  return sum / static_cast<double>(at.size());
}

}  // namespace

BinCounts bin_counts(std::span<const double> x, std::span<const double> y, int columns, int rows) {
  BinCounts out{columns, rows, std::vector<int>(static_cast<std::size_t>(columns * rows), 0), 0};
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!(x[i] >= 0 && x[i] <= 1 && y[i] >= 0 && y[i] <= 1)) continue;
    const int column = std::min(columns - 1, static_cast<int>(x[i] * columns)),
              row = std::min(rows - 1, static_cast<int>(y[i] * rows));
    out.most = std::max(out.most, ++out.counts[static_cast<std::size_t>(row * columns + column)]);
  }
  return out;
}

BinnedMeans binned_means(std::span<const double> x, std::span<const double> y, int bins) {
  BinnedMeans out;
  for (const auto& bin : equal_bins(x, y, bins)) {
    const auto n = static_cast<double>(bin.size());
    const double mean = mean_of(y, bin);
    double squares = 0;
    for (const std::size_t i : bin) squares += std::pow(y[i] - mean, 2);
    out.centres.push_back(mean_of(x, bin));
    out.means.push_back(mean);
    out.standard_errors.push_back(n > 1 ? std::sqrt(squares / (n - 1) / n)
                                        : std::numeric_limits<double>::quiet_NaN());
    out.counts.push_back(bin.size());
  }
  return out;
}

RunningQuantiles running_quantiles(std::span<const double> x, std::span<const double> y,
                                   std::span<const double> shares, int bins) {
  RunningQuantiles out;
  out.values.resize(shares.size());
  for (const auto& bin : equal_bins(x, y, bins)) {
    std::vector<double> sorted;
    for (const std::size_t i : bin) sorted.push_back(y[i]);
    std::sort(sorted.begin(), sorted.end());
    out.centres.push_back(mean_of(x, bin));
    for (std::size_t s = 0; s < shares.size(); ++s) {
      const double place = shares[s] * static_cast<double>(sorted.size() - 1);
      const auto below = static_cast<std::size_t>(place);
      const std::size_t above = std::min(below + 1, sorted.size() - 1);
      out.values[s].push_back(sorted[below] +
                              (place - static_cast<double>(below)) * (sorted[above] - sorted[below]));
    }
  }
  return out;
}

}  // namespace mgtd::calib::report::figures
