// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/motion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

#include "tests/rig/rotations.h"

namespace mgtd::rig {
namespace {

constexpr double kStep_s = 0.05;  ///< of the path
constexpr double kGetGoing_s = 2;

constexpr std::array kNames{"hand", "flight", "level", "one-axis"};

/// Hand and level turn: noise through two filters of this time constant.
constexpr double kSmooth_s = 0.6;
constexpr double kHand_rad_per_s = 0.5;  ///< of each axis, rms
constexpr double kLevel_rad_per_s = 0.5;
constexpr double kOneAxis_rad_per_s = 36 * kDeg;

constexpr double kGravityBySpeed_rad_per_s = 9.81 / 45;  ///< of an aircraft at 45 m/s
constexpr double kRoll_in_s = 3;                         ///< into a bank, and out of it
constexpr double kSwing_s = 5;                           ///< one of three periods
constexpr double kRough_deg = 0.4;                       ///< rms of roll and pitch in rough air

/// 0 to 1, smoothly, while x goes from 0 to 1.
double rise(double x) { return 0.5 * (1 - std::cos(std::numbers::pi * std::clamp(x, 0.0, 1.0))); }

/// How much of the motion there is: none at rest.
double share(const Recording& r, double t_s) {
  return rise((t_s - r.rest_s) / kGetGoing_s) * rise((r.duration_s - r.rest_s - t_s) / kGetGoing_s);
}

/// White noise through two equal filters; rms 1.
class Smooth {
 public:
  double next(std::mt19937_64& random, std::normal_distribution<double>& normal) {
    const double a = std::exp(-kStep_s / kSmooth_s);
    first_ = a * first_ + std::sqrt(1 - a * a) * normal(random);
    second_ += (1 - a) * (first_ - second_);
    return second_ * kGain;
  }

 private:
  static constexpr double kGain = std::numbers::sqrt2;  ///< the second filter leaves half of the variance
  double first_{0}, second_{0};
};

struct Course {
  std::mt19937_64 random;
  std::normal_distribution<double> normal{};
  std::vector<Eigen::Quaterniond> path{};
  void stand(const Eigen::Matrix3d& R) { path.emplace_back(R); }
};

void hand(Course& course, const Recording& script, std::size_t steps) {
  std::array<Smooth, 3> turning;
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  for (std::size_t k = 0; k < steps; ++k) {
    course.path.push_back(q);
    Eigen::Vector3d omega(0, 0, 0);
    for (std::size_t a = 0; a < 3; ++a)
      omega[static_cast<Eigen::Index>(a)] =
          kHand_rad_per_s * turning.at(a).next(course.random, course.normal);
    omega *= share(script, kStep_s * static_cast<double>(k)) * kStep_s;
    if (omega.norm() > 0) q = (Eigen::Quaterniond(turned_by(omega)) * q).normalized();
  }
}

void level(Course& course, const Recording& script, std::size_t steps) {
  Smooth turning;
  double heading_rad = 0;
  for (std::size_t k = 0; k < steps; ++k) {
    course.stand(about_z(heading_rad / kDeg));
    heading_rad += kLevel_rad_per_s * turning.next(course.random, course.normal) *
                   share(script, kStep_s * static_cast<double>(k)) * kStep_s;
  }
}

void one_axis(Course& course, const Recording& script, std::size_t steps) {
  const auto direction = [&]() -> Eigen::Vector3d {
    const double x = course.normal(course.random), y = course.normal(course.random);
    return Eigen::Vector3d(x, y, course.normal(course.random)).normalized();
  };
  const Eigen::Vector3d axis = direction();
  const Eigen::Vector3d about = direction();
  const Eigen::Matrix3d start = turned_by(about * 2);
  double angle_rad = 0;
  for (std::size_t k = 0; k < steps; ++k) {
    course.stand(turned_by(angle_rad * axis) * start);
    angle_rad += kOneAxis_rad_per_s * share(script, kStep_s * static_cast<double>(k)) * kStep_s;
  }
}

/// Of a flight: so long, with this bank or these swings.
struct Leg {
  double length_s{0}, bank_deg{0};
  double roll_deg{0}, pitch_deg{0}, yaw_deg{0};  ///< amplitudes
};

/// Banked until the heading has changed so far; the bank counts half while it comes and goes.
Leg turn(double by_deg, double bank_deg) {
  const double rate_rad_per_s = kGravityBySpeed_rad_per_s * std::tan(bank_deg * kDeg);
  return {std::abs(by_deg) * kDeg / rate_rad_per_s + kRoll_in_s, by_deg < 0 ? -bank_deg : bank_deg};
}

/// A square of four legs with swings on each, then a full circle at a small bank; and again, the other way
/// round by chance.
std::vector<Leg> legs(std::mt19937_64& random, double length_s) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Leg> out;
  for (double t_s = 0; t_s < length_s;) {
    const std::size_t before = out.size();
    const double sense = unit(random) < 0.5 ? -1 : 1;
    for (int side = 0; side < 4; ++side) {
      out.push_back({.length_s = 8 + 7 * unit(random)});
      out.push_back({.length_s = 3 * kSwing_s, .roll_deg = 10});
      out.push_back({.length_s = 3 * kSwing_s, .pitch_deg = 5});
      out.push_back({.length_s = 3 * kSwing_s, .yaw_deg = 5});
      const double bank_deg = 25 + 10 * unit(random);
      out.push_back(turn(sense * (80 + 20 * unit(random)), bank_deg));
    }
    out.push_back(turn(-sense * 360, 15));
    for (std::size_t k = before; k < out.size(); ++k) t_s += out[k].length_s;
  }
  return out;
}

void flight(Course& course, const Recording& script, std::size_t steps) {
  const std::vector<Leg> plan = legs(course.random, script.duration_s);
  std::array<Smooth, 2> rough;
  std::size_t which = 0;
  double begun_s = script.rest_s, heading_rad = 0;
  for (std::size_t k = 0; k < steps; ++k) {
    const double t_s = kStep_s * static_cast<double>(k);
    while (which + 1 < plan.size() && t_s >= begun_s + plan[which].length_s)
      begun_s += plan[which++].length_s;
    const Leg& leg = plan[which];
    const double since_s = std::max(0.0, t_s - begun_s), left_s = std::max(0.0, leg.length_s - since_s);
    const double in = rise(since_s / kRoll_in_s) * rise(left_s / kRoll_in_s);
    const double swing = in * std::sin(2 * std::numbers::pi * since_s / kSwing_s);
    const double much = share(script, t_s);
    const double rough_roll = rough[0].next(course.random, course.normal);
    const double rough_pitch = rough[1].next(course.random, course.normal);
    const double bank_deg = much * in * leg.bank_deg;
    const double roll_deg = bank_deg + much * (swing * leg.roll_deg + kRough_deg * rough_roll);
    const double pitch_deg = much * (swing * leg.pitch_deg + kRough_deg * rough_pitch);
    const double yaw_deg = much * swing * leg.yaw_deg;
    course.stand(about_x(roll_deg) * about_y(pitch_deg) * about_z(heading_rad / kDeg + yaw_deg));
    heading_rad += kGravityBySpeed_rad_per_s * std::tan(bank_deg * kDeg) * kStep_s;
  }
}

}  // namespace

bool read_motion(std::string_view name, MotionKind& kind) {
  const auto* const found = std::find(kNames.begin(), kNames.end(), name);
  if (found == kNames.end()) return false;
  kind = static_cast<MotionKind>(found - kNames.begin());
  return true;
}

std::string motion_name(MotionKind kind) { return kNames.at(static_cast<std::size_t>(kind)); }

Motion::Motion(const Recording& script, std::uint64_t seed) {
  Course course{.random = std::mt19937_64(seed ^ 0x94d049bb133111ebU)};
  const auto steps = static_cast<std::size_t>(std::ceil(script.duration_s / kStep_s)) + 2;
  course.path.reserve(steps);
  if (script.motion == MotionKind::hand) hand(course, script, steps);
  if (script.motion == MotionKind::flight) flight(course, script, steps);
  if (script.motion == MotionKind::level) level(course, script, steps);
  if (script.motion == MotionKind::one_axis) one_axis(course, script, steps);
  path_ = std::move(course.path);
}

Eigen::Matrix3d Motion::attitude(double t_s) const {
  const double last = static_cast<double>(path_.size() - 1);
  const double at = std::clamp(t_s / kStep_s, 0.0, last);
  const auto k = static_cast<std::size_t>(std::min(at, last - 1));
  return path_[k].slerp(at - static_cast<double>(k), path_[k + 1]).normalized().toRotationMatrix();
}

}  // namespace mgtd::rig
