// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "calib/report/figures/figure.h"
#include "calib/report/figures/plot.h"

/// lanes_figure() draws many lanes over one time axis, so that what happened at the same time is seen in one
/// look. Gaps are hatched in every lane, with their reason. A lane of more than kMostMarks values shows the
/// lowest, the highest and the mean of each column.
namespace mgtd::calib::report::figures {

struct Lane {
  std::string name{}, unit{};
  std::vector<Series> series{};   ///< x in hours
  std::optional<double> limit{};  ///< a dashed line
  std::string limit_text{};
  bool log{false};
  bool joined{false};  ///< values joined by a line: temperatures, currents
};

struct Gap {
  double from_h{0}, to_h{0};
  std::string why{};
};

struct LanesValues {
  std::string name{}, title{}, what{}, good{};
  std::vector<Lane> lanes{};
  std::vector<Gap> gaps{};
};

[[nodiscard]] Figure lanes_figure(const LanesValues& values);

}  // namespace mgtd::calib::report::figures
