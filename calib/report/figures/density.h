// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <span>
#include <vector>

/// These functions reduce the many points of a plot to a few numbers.
namespace mgtd::calib::report::figures {

/// Points that fell into the squares of a grid over 0..1 x 0..1.
struct BinCounts {
  int columns{0}, rows{0};
  std::vector<int> counts{};  ///< row by row
  int most{0};
};
[[nodiscard]] BinCounts bin_counts(std::span<const double> x, std::span<const double> y, int columns,
                                   int rows);

/// Means of y over equally filled bins of x, with their standard errors, at the mean x of each bin. Equal x
/// stay together.
struct BinnedMeans {
  std::vector<double> centres{}, means{}, standard_errors{};
  std::vector<std::size_t> counts{};
};
[[nodiscard]] BinnedMeans binned_means(std::span<const double> x, std::span<const double> y, int bins = 8);

/// Quantiles of y over the same kind of bins; `shares` in 0..1, one row for each of them.
struct RunningQuantiles {
  std::vector<double> centres{};
  std::vector<std::vector<double>> values{};
};
[[nodiscard]] RunningQuantiles running_quantiles(std::span<const double> x, std::span<const double> y,
                                                 std::span<const double> shares, int bins = 24);

}  // namespace mgtd::calib::report::figures
