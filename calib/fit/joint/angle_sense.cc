// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/angle_sense.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <array>
#include <numbers>
#include <optional>

#include "calib/sensor/sensor_equations.h"
#include "proto/units.h"

namespace mgtd::calib::fit::joint {
namespace {

const double kFarOff_rad = to_rad(1);
constexpr double kMuchLess = 0.2;
const double kStandsSo_rad = to_rad(60);

constexpr std::array kAngles{"azimuth", "pitch", "roll"};
constexpr std::array kAxes{"X", "Y", "Z"};
/// Platform axis, half a turn about which the sensors would stand if it were the other angle.
constexpr std::size_t half_turn_axis(std::size_t one, std::size_t other) { return one + other - 1; }

/// With the azimuth of the other sign.
JointProblem azimuth_backwards(JointProblem problem) {
  for (JointPose& pose : problem.poses)
    if (const auto angles = pose.pose->angles())
      pose.T = sensor::table_rotation(-angles->azimuth_rad, angles->pitch_rad, angles->roll_rad, 0.0, 0.0);
  return problem;
}

/// The angle with which sensor 1 stands nearest to the platform's axes. `Q`: how it stands if the azimuth is
/// counted backwards.
std::optional<std::size_t> counted_backwards(const Eigen::Matrix3d& Q) {
  for (std::size_t i = 0; i < kAngles.size(); ++i) {
    Eigen::Matrix3d stands = Q;
    if (i > 0) {
      const auto axis = Eigen::Vector3d::Unit(static_cast<Eigen::Index>(half_turn_axis(0, i)));
      stands = Eigen::AngleAxisd(std::numbers::pi, axis).toRotationMatrix() * Q;
    }
    if (Eigen::AngleAxisd(stands).angle() < kStandsSo_rad) return i;
  }
  return std::nullopt;
}

std::string remedy(std::optional<std::size_t> which) {
  constexpr const char* kMap = "in a column map of mgt import: sign = -1";
  if (!which)
    return fmt::format(
        "change the sign of the angle whose scale counts backwards, azimuth_deg, pitch_deg or roll_deg, in "
        "every pose ({}); how the sensors stand on the platform does not say which",
        kMap);
  std::string others;
  for (std::size_t i = 0; i < kAngles.size(); ++i)
    if (i != *which)
      others += fmt::format("{} about {} {}_deg", others.empty() ? "" : ", and",
                            kAxes.at(half_turn_axis(*which, i)), kAngles.at(i));
  return fmt::format(
      "change the sign of {}_deg in every pose ({}); if the sensors were mounted half a turn round, it would "
      "be{}",
      kAngles.at(*which), kMap, others);
}

}  // namespace

Result<void> check_angle_sense(const JointProblem& problem, const std::vector<Eigen::Vector3d>& u,
                               const ReferencePlacement& placement) {
  if (placement.misfit_rad < kFarOff_rad) return {};
  const ReferencePlacement other = place_beside(azimuth_backwards(problem), u);
  if (other.misfit_rad > kMuchLess * placement.misfit_rad) return {};
  const auto which = counted_backwards(other.Q);
  return fail(ErrorCode::refused,
              fmt::format("{} against the vector reference: by the angles as they stand the directions of "
                          "the sensors and of the reference are {:.3g} deg apart (rms; limit {:.0f} deg), "
                          "with {} of the other sign {:.2g} deg",
                          which ? fmt::format("the table's {} turns", kAngles.at(*which))
                                : "one of the table's angles turns",
                          to_deg(placement.misfit_rad), to_deg(kFarOff_rad),
                          which ? "that angle" : "one angle", to_deg(other.misfit_rad)),
              remedy(which));
}

}  // namespace mgtd::calib::fit::joint
