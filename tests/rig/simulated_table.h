// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proto/pose.h"
#include "tests/rig/scenario.h"
#include "tests/rig/survey.h"

/// This makes a run straight from the physics, without ports or daemon: the table goes its real way from pose
/// to pose, and what the dwells would have given is written down. For the many runs of a benchmark:
///
///     auto scenario = parse_scenario(text, "s.toml");            // or a Scenario made in memory ...
///     scenario->effects.push_back(*effect_of("name = 'axis.cubic'\nwhere = 's2.x'\nnT_at_F0 = 12"));
///     const PoseTable run = simulated_table(*scenario, run_of_157({}, 1), 1);
namespace mgtd::rig {

struct PlannedPose {
  std::array<double, 3> angles_deg{};  ///< azimuth, pitch, roll of the table
  std::string set{"random"};
  double dwell_s{4};
  int sense{0};       ///< of the azimuth's approach: +1, -1; 0: the short way
  int mount{1};       ///< which of Design::mounts
  double pause_s{0};  ///< waited before the table sets off
  double wait_s{0};   ///< from its stop to the dwell, beyond what it takes to settle
  /// The table stands still, and a cage makes this field, platform frame.
  std::optional<Eigen::Vector3d> cage_nT{};
};

struct Design {
  std::vector<PlannedPose> poses;
  /// How the array is put on the table: table frame to platform frame. The recorded angles are those of the
  /// platform, mounting included.
  std::vector<Eigen::Matrix3d> mounts{Eigen::Matrix3d::Identity()};
  double settle_s{1};      ///< from the stop to the dwell
  bool record_path{true};  ///< where the table was while it moved, as a run file keeps it
  double begin_s{0};       ///< of the world's time, when the run starts; the table stands at zero then
};

struct DesignOptions {
  bool standard{true};  ///< the 36 level azimuths
  std::size_t random{121};
  std::size_t revisits{24};  ///< of the random ones, at random later times
  std::vector<double> dwells_s{4, 8};
  double tilt_limit_deg{180};
  bool senses{false};  ///< random approach sense; else the short way
  double pause_s{0};
  /// Only attitudes that show this direction (site frame) to the platform between its positive axes;
  /// tilts of 90 degrees or more must be allowed.
  std::optional<Eigen::Vector3d> octant{};
};

/// 36 level azimuths, 18 out in steps of 20 degrees and 18 back between them, then attitudes uniform over the
/// rotations, some visited again.
[[nodiscard]] Design run_of_157(const DesignOptions& options, std::uint64_t seed);

/// 20 degree steps about Z, Y and X; the 18 level azimuths are the standard set.
[[nodiscard]] Design grid_of_5832();

/// A table with one axis: `azimuths` equal steps in a random order for each of the mountings.
[[nodiscard]] Design remounted_turns(const std::vector<Eigen::Matrix3d>& mounts, std::size_t azimuths,
                                     std::uint64_t seed);

/// The poses of a list as `mgt next -o` writes it: azimuth_deg, pitch_deg and roll_deg, and where it has them
/// set, sense, dwell_s and since_stop_s. Empty, with a reason, where it is no such list.
struct ListedDesign {
  Design design;
  std::string error{};
};
[[nodiscard]] ListedDesign listed_design(const std::string& csv);

/// One field after the other; the array stands still.
[[nodiscard]] Design cage_fields(const Cage& cage, std::uint64_t seed);

enum class Sampling {
  means,   ///< physics at five instants of a dwell (Gauss and Legendre), noise of the mean from its
           ///< distribution
  samples  ///< sample by sample, as the digitisers would have read
};

/// `seed` replaces that of the scenario: noise, the table's errors and random effects, not the parameters.
[[nodiscard]] Survey simulated_survey(Scenario scenario, const Design& design, std::uint64_t seed,
                                      Sampling sampling = Sampling::means);
/// The same as the programs hold it.
[[nodiscard]] PoseTable simulated_table(Scenario scenario, const Design& design, std::uint64_t seed,
                                        Sampling sampling = Sampling::means);

/// The table angles that stand for an attitude, site to platform.
[[nodiscard]] TableAngles recorded_angles_of(const Eigen::Matrix3d& attitude);

}  // namespace mgtd::rig
