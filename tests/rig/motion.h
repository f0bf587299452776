// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

/// A Motion moves an array that no table carries: by hand, in an aircraft, on a disc.
namespace mgtd::rig {

enum class MotionKind {
  hand,     ///< turned over and over: smooth random angular velocities about all axes
  flight,   ///< level legs, banked turns, full circles, and swings in roll, pitch and yaw on the legs
  level,    ///< to and fro about the platform's Z, level
  one_axis  ///< round and round about one axis, fixed to the platform and to the site, in a random direction
};

inline constexpr const char* kMotions = "hand, flight, level, one-axis";
/// False: there is none of that name.
[[nodiscard]] bool read_motion(std::string_view name, MotionKind& kind);
[[nodiscard]] std::string motion_name(MotionKind kind);

/// A Recording is one row for each sample of an array in motion.
struct Recording {
  MotionKind motion{MotionKind::hand};
  double duration_s{300};
  double rest_s{5};  ///< without motion, at the start and at the end
};

/// Platform frame at every time of a recording: R(t), site to platform. Between rests it is smooth, with
/// angular accelerations below 10 rad/s^2; it gets going, and comes to rest, within 2 s. The same script and
/// seed give the same motion.
class Motion {
 public:
  Motion(const Recording& script, std::uint64_t seed);
  /// Before the start and after the end it rests.
  [[nodiscard]] Eigen::Matrix3d attitude(double t_s) const;

 private:
  std::vector<Eigen::Quaterniond> path_;  ///< at equal steps from 0; of the matrix R itself
};

/// Time that a recording needs beside its rests, to get going and to come to rest.
inline constexpr double kLeastMotion_s = 5;

}  // namespace mgtd::rig
