// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/rotation_consistency.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "calib/sensor/sensor_equations.h"

namespace mgtd::daemon::run {
namespace {

constexpr std::size_t kRemembered = 30;  ///< poses that a new one is held against, spread over the run
constexpr int kDirections = 600;         ///< tried for n: 5 deg apart
constexpr double kFinest_rad = 2e-3;
/// 15 deg: a pair that is off by more says no more than that it is wrong.
constexpr double kGross_rad = 0.26;

double angle(double cosine) { return std::acos(std::clamp(cosine, -1.0, 1.0)); }

/// A pair of poses: how far the field turned, and the rotation that the angles say.
struct Pair {
  Eigen::Matrix3d R;
  double turn_rad;
  [[nodiscard]] double miss(const Eigen::Vector3d& n) const { return angle(n.dot(R * n)) - turn_rad; }
};

double misfit(const std::vector<Pair>& pairs, const Eigen::Vector3d& n) {
  double sum = 0;
  for (const Pair& pair : pairs) sum += std::min(pair.miss(n) * pair.miss(n), kGross_rad * kGross_rad);
  return sum;
}

/// Evenly over the sphere.
Eigen::Vector3d direction(int k) {
  const double golden = std::numbers::pi * (3 - std::sqrt(5.0));
  const double z = 1 - (2 * k + 1.0) / kDirections, r = std::sqrt(1 - z * z);
  return {r * std::cos(golden * k), r * std::sin(golden * k), z};
}

/// The direction of the field that explains the pairs best.
Eigen::Vector3d best_direction(const std::vector<Pair>& pairs) {
  Eigen::Vector3d best = direction(0);
  double least = std::numeric_limits<double>::infinity();
  const auto try_one = [&](const Eigen::Vector3d& n) {
    const double sum = misfit(pairs, n);
    if (!(sum < least)) return false;
    least = sum;
    best = n;
    return true;
  };
  for (int k = 0; k < kDirections; ++k) try_one(direction(k));
  for (double step = 0.05; step > kFinest_rad;) {
    bool better = false;
    const Eigen::Vector3d at = best, e = at.unitOrthogonal(), f = at.cross(e);
    for (const Eigen::Vector3d& way : {e, f}) {
      better = try_one((at + step * way).normalized()) || better;
      better = try_one((at - step * way).normalized()) || better;
    }
    if (!better) step /= 2;
  }
  return best;
}

}  // namespace

RotationConsistency::Seen RotationConsistency::seen(const Pose& pose) {
  const TableAngles a = pose.angles().value_or(TableAngles{});
  Seen out{.number = pose.number,
           .R = calib::sensor::table_rotation(a.azimuth_rad, a.pitch_rad, a.roll_rad, 0.0, 0.0),
           .u = PerSensor<Eigen::Vector3d>(pose.y_nT.size())};
  for (std::size_t i = 0; i < out.u.size(); ++i) out.u[i] = pose.y_nT[i].normalized();
  return out;
}

void RotationConsistency::add(const Pose& pose) {
  if (pose.angles()) poses_.push_back(seen(pose));
}

void RotationConsistency::remove(int number) {
  std::erase_if(poses_, [&](const Seen& s) { return s.number == number; });
}

RotationFinding RotationConsistency::judge(const Pose& pose) const {
  RotationFinding out;
  if (!pose.angles() || poses_.empty()) return out;
  const Seen now = seen(pose);
  std::vector<const Seen*> before;
  const std::size_t n = std::min(kRemembered, poses_.size());
  for (std::size_t i = 0; i < n; ++i)
    before.push_back(&poses_[n < 2 ? 0 : i * (poses_.size() - 1) / (n - 1)]);
  const auto pair_of = [](const Seen& a, const Seen& b) {
    double cosine = 0;
    for (std::size_t i = 0; i < a.u.size(); ++i)
      cosine += a.u[i].dot(b.u[i]) / static_cast<double>(a.u.size());
    return Pair{a.R.transpose() * b.R, angle(cosine)};
  };
  std::vector<Pair> pairs;
  for (const Seen* const s : before) pairs.push_back(pair_of(*s, now));
  for (std::size_t i = 0; i < before.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) pairs.push_back(pair_of(*before[j], *before[i]));
  const Eigen::Vector3d field = best_direction(pairs);
  std::vector<double> misses;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const double miss = pairs[i].miss(field);
    misses.push_back(std::abs(miss));
    if (i > 0 && std::abs(miss) <= *std::max_element(misses.begin(), misses.end() - 1)) continue;
    out.against = before[i]->number;
    out.measured_rad = pairs[i].turn_rad;
    out.entered_rad = pairs[i].turn_rad + miss;
  }
  const auto middle = misses.begin() + static_cast<std::ptrdiff_t>(misses.size() / 2);
  std::nth_element(misses.begin(), middle, misses.end());
  out.agrees = *middle <= kLimit_rad;
  return out;
}

}  // namespace mgtd::daemon::run
