// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/report/figures/figure.h"

/// These figures show what a run cannot see, and what it cannot tell apart.
namespace mgtd::calib::report::figures {

/// Smallest size of each effect that would have been seen, over the size at which it usually occurs.
struct SmallestSize {
  std::string effect{}, where{};
  double ratio{0};     ///< smallest size seen over usual size; not above zero: at no size that occurs
  std::string text{};  ///< "0.02 nT/°C (s3.z)"
};
struct DetectableValues {
  std::vector<SmallestSize> sizes{};
  std::vector<std::string> untestable{};
};
[[nodiscard]] Figure detectable_figure(const DetectableValues& values);

/// Correlation of the signatures of every two effects on these poses: of 1 no run like this can tell them
/// apart. Effects are ordered so that those which look alike stand together.
struct ConfusionValues {
  std::vector<std::string> effects{};
  std::vector<std::vector<double>> correlation{};  ///< 0..1, symmetric
};
[[nodiscard]] Figure confusion_figure(const ConfusionValues& values);

/// An order in which similar ones are neighbours: by joining the two most similar groups until one is left.
[[nodiscard]] std::vector<std::size_t> order_by_likeness(const std::vector<std::vector<double>>& correlation);

}  // namespace mgtd::calib::report::figures
