// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "proto/epoch.h"
#include "proto/input_value.h"
#include "proto/tensor.h"

/// LaneHistory keeps the history of the stream for the lanes of the page: mean, least and greatest value of
/// every channel in bins of time, for a day, in bounded memory; decimated here, so that a page gets no more
/// columns than it draws. Spikes stay visible as the range of their bin.
///
///     bins of 2 s for 6 h, bins of 10 s for 24 h; each begins at a multiple of its length since 1970
///
/// Channels: the components of the gradient, the field (bx, by, bz, f), chi2 of the closure, T1 .. TN of the
/// heads, and the auxiliary inputs under their own names. Least and greatest are kept as floats relative to
/// the mean: a float alone has steps of 4 pT in the field. Time is that of the samples, UTC. Pure.
namespace mgtd::daemon::serve::console {

/// Of one channel over a window. Columns without a sample are NaN.
struct Lane {
  double from_s{0};  ///< UTC, seconds since 1970: left edge of the first column
  double step_s{0};  ///< width of a column
  std::vector<double> mean, least, greatest;
};

struct LaneGap {
  double from_s{0}, to_s{0};  ///< UTC
  std::string why;
};

class LaneHistory {
 public:
  void add(const TensorSample& sample, const PerSensor<double>& T_degC, std::span<const InputValue> inputs);
  void add(const Gap& gap);

  [[nodiscard]] std::vector<std::string> channels() const;
  /// The last `window_s` seconds in at most `columns` columns; nothing for a channel that there is not.
  [[nodiscard]] std::optional<Lane> lane(std::string_view channel, double window_s,
                                         std::size_t columns) const;
  /// Those of the window, the latest few hundred at most.
  [[nodiscard]] std::vector<LaneGap> gaps(double window_s) const;

 private:
  struct Sum {
    double sum{0};
    float least{0}, greatest{0};  ///< less the first value of the bin
    double first{0};
    std::uint32_t count{0};
  };
  struct Bin {
    std::int64_t number{0};  ///< since 1970
    std::vector<Sum> sums;   ///< by channel
  };
  struct Level {
    double bin_s;
    std::size_t most;
    std::deque<Bin> bins{};
  };

  [[nodiscard]] std::size_t channel(std::string_view name);
  void put(Level& level, double t_s, const std::vector<std::pair<std::size_t, double>>& values);

  std::vector<std::string> names_;
  std::vector<Level> levels_{{2, 10'800}, {10, 8'640}};
  std::deque<LaneGap> gaps_;
  double last_s_{0};                                    ///< time of the latest sample
  bool in_gap_{false};                                  ///< the latest gap has not been ended by a sample
  std::vector<std::pair<std::size_t, double>> values_;  ///< reused
};

}  // namespace mgtd::daemon::serve::console
