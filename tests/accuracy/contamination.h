// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <bitset>
#include <string>
#include <vector>

#include "proto/pose.h"
#include "tests/accuracy/campaign.h"

/// This measures how far gross readings of every kind, share and size get into the calibration, compared with
/// an estimator that is told which they are.
namespace mgtd::testing {

/// What is off, in the given share of the poses:
///   axis     one axis of the array, in poses scattered over the run, each reading up or down
///   sensor   the three axes of one sensor over one stretch of poses, by a constant
///   pose     all twelve readings, in poses scattered over the run, each up or down
///   stretch  all twelve over one stretch of poses, rising and falling like a source that passes
///   scattered_sensor  the three axes of one sensor, in scattered poses, each reading up or down
enum class Gross { axis, sensor, pose, stretch, scattered_sensor };
[[nodiscard]] std::string name(Gross kind);

struct Contamination {
  Gross kind{Gross::axis};
  double share{0};  ///< of the poses; one pose at least unless zero
  double size_nT{0};
};

/// A table and what was done to it.
struct Spoilt {
  PoseTable table;
  std::vector<std::bitset<12>> bad;  ///< by pose, by channel
};
[[nodiscard]] Spoilt spoilt(PoseTable table, const Contamination& what, std::uint64_t seed);

/// Runs with 0.05 nT of noise a pose mean, told by the dwells.
[[nodiscard]] Scene contaminated_scene();

struct Robustness {
  int runs{0};
  int refused{0};    ///< no calibration, or one that the checks do not accept
  double ratio{0};   ///< error of the tensor over the oracle's, rms over accepted runs and attitudes
  double worst{0};   ///< of one accepted run
  int at_an_end{0};  ///< accepted runs whose stretch begins or ends within three poses of an end of the run
  double away_ratio{0};     ///< `ratio` without those
  double good_left_out{0};  ///< good readings that were left out, share of all, accepted runs
};
[[nodiscard]] Robustness robustness(const Contamination& what, int runs);

}  // namespace mgtd::testing
