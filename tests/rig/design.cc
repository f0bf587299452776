// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <random>

#include "tests/rig/rotations.h"
#include "tests/rig/simulated_table.h"

namespace mgtd::rig {
namespace {

std::size_t below(std::mt19937_64& random, std::size_t n) {
  return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
}

void add_standard(Design& design) {
  for (int k = 0; k < 18; ++k) design.poses.push_back({.angles_deg = {20.0 * k, 0, 0}, .set = "standard"});
  design.poses.front().sense = 1;  // the table stands there already, and has come from nowhere
  for (int k = 17; k >= 0; --k)
    design.poses.push_back({.angles_deg = {20.0 * k + 10, 0, 0}, .set = "standard"});
}

std::array<double, 3> attitude(std::mt19937_64& random, double tilt_limit_deg) {
  std::uniform_real_distribution<double> unit(0, 1);
  std::array<double, 3> out{360 * unit(random), std::asin(2 * unit(random) - 1) / kDeg,
                            360 * unit(random) - 180};
  for (std::size_t axis : {1U, 2U}) out.at(axis) = std::clamp(out.at(axis), -tilt_limit_deg, tilt_limit_deg);
  return out;
}

/// Drawn until it is one that is wanted.
std::array<double, 3> attitude(std::mt19937_64& random, const DesignOptions& options) {
  for (;;) {
    const auto deg = attitude(random, options.tilt_limit_deg);
    if (!options.octant) return deg;
    const Eigen::Vector3d seen = about_z(deg[0]) * about_y(deg[1]) * about_x(deg[2]) * *options.octant;
    if (seen.minCoeff() > 0) return deg;
  }
}

/// Which of the random poses are revisits: never the first two.
std::vector<bool> revisits(std::size_t poses, std::size_t count, std::mt19937_64& random) {
  std::vector<bool> out(poses, false);
  for (std::size_t k = 0; k < std::min(count, poses - std::min<std::size_t>(poses, 2)); ++k)
    out[poses - 1 - k] = true;
  std::shuffle(out.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(2, poses)), out.end(), random);
  return out;
}

}  // namespace

Design run_of_157(const DesignOptions& options, std::uint64_t seed) {
  std::mt19937_64 random(seed ^ 0x9e3779b97f4a7c15U);
  Design out;
  if (options.standard) add_standard(out);
  const std::size_t first = out.poses.size();
  const std::vector<bool> again = revisits(options.random, options.revisits, random);
  for (std::size_t k = 0; k < options.random; ++k) {
    PlannedPose pose;
    pose.angles_deg =
        again[k] ? out.poses.at(first + below(random, k - 1)).angles_deg : attitude(random, options);
    pose.dwell_s = options.dwells_s.at(below(random, options.dwells_s.size()));
    if (options.senses) pose.sense = below(random, 2) == 0 ? -1 : 1;
    pose.pause_s = options.pause_s;
    out.poses.push_back(std::move(pose));
  }
  return out;
}

Design grid_of_5832() {
  Design out;
  out.record_path = false;
  for (int r = 0; r < 18; ++r) {
    for (int p = 0; p < 18; ++p) {
      for (int a = 0; a < 18; ++a)
        out.poses.push_back({.angles_deg = {20.0 * a, 20.0 * p, 20.0 * r},
                             .set = r == 0 && p == 0 ? "standard" : "random",
                             .dwell_s = 0});
    }
  }
  return out;
}

Design cage_fields(const Cage& cage, std::uint64_t seed) {
  constexpr double kGolden_deg =
      137.50776405003785;  // 360 (3 - sqrt 5)/2: a spiral that fills a sphere evenly
  std::mt19937_64 random(seed ^ 0xbf58476d1ce4e5b9U);
  std::uniform_real_distribution<double> unit(0, 1);
  Design out;
  out.record_path = false;
  for (std::uint64_t k = 0; k < cage.poses; ++k) {
    const double of_all = (static_cast<double>(k) + 0.5) / static_cast<double>(cage.poses);
    const double z = 2 * (cage.sphere ? of_all : unit(random)) - 1;
    const double around_deg = cage.sphere ? kGolden_deg * static_cast<double>(k) : 360 * unit(random);
    const double share = cage.sphere ? static_cast<double>(k % 4 + 1) / 4 : unit(random);
    const double across = std::sqrt(1 - z * z);
    const Eigen::Vector3d u(across * std::cos(around_deg * kDeg), across * std::sin(around_deg * kDeg), z);
    out.poses.push_back({.set = "cage", .cage_nT = (k == 0 ? 0 : share * cage.max_nT) * u});
  }
  return out;
}

Design remounted_turns(const std::vector<Eigen::Matrix3d>& mounts, std::size_t azimuths, std::uint64_t seed) {
  std::mt19937_64 random(seed ^ 0xd1b54a32d192ed03U);
  Design out;
  out.mounts = mounts;
  for (std::size_t m = 0; m < mounts.size(); ++m) {
    std::vector<std::size_t> order(azimuths);
    for (std::size_t k = 0; k < azimuths; ++k) order[k] = k;
    std::shuffle(order.begin(), order.end(), random);
    for (const std::size_t k : order)
      out.poses.push_back(
          {.angles_deg = {360.0 * static_cast<double>(k) / static_cast<double>(azimuths), 0, 0},
           .set = m == 0 ? "standard" : "random",
           .mount = static_cast<int>(m) + 1});
  }
  return out;
}

}  // namespace mgtd::rig
