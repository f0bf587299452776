// SPDX-License-Identifier: Apache-2.0
#include "calib/discovery/random_offset.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/unit/calib/discovery/discovery_scene.h"

namespace mgtd::calib::discovery {
namespace {

/// 2 ln E of walk and jumps on s2.x.
std::pair<double, double> evidence(const calib::testing::Hidden& hidden) {
  const auto s = testing::scene({.noise_nT = 0.05, .hidden = hidden}, 5);
  return {evidence_of(RandomOffset::walk, {3}, s->sums, s->fit.problem),
          evidence_of(RandomOffset::jumps, {3}, s->sums, s->fit.problem)};
}

/// The same number for the same pose, with unit variance.
double number_of(int pose) {
  std::mt19937_64 rng(static_cast<std::uint64_t>(pose) * 7919 + 3);
  return std::normal_distribution<double>()(rng);
}

TEST(RandomOffset, NoiseHasNeither) {
  const auto [walk, jumps] = evidence({});
  EXPECT_LT(walk, 3);
  EXPECT_LT(jumps, 3);
}

TEST(RandomOffset, JumpsAreToldFromAWalk) {
  const auto [walk, jumps] = evidence([](const Pose& p, int i, int a, const Eigen::Vector3d&) {
    return i == 1 && a == 0 ? 0.1 * number_of(p.number) : 0.0;
  });
  EXPECT_GT(jumps, 50);
  EXPECT_GT(jumps, walk + 30);
}

TEST(RandomOffset, AWalkIsToldFromJumps) {
  std::map<int, double> offset;
  double now = 0;
  for (int k = 0; k <= 200; ++k) offset[k] = now += 0.02 * number_of(k);
  const auto [walk, jumps] = evidence([offset](const Pose& p, int i, int a, const Eigen::Vector3d&) {
    return i == 1 && a == 0 ? offset.at(p.number) : 0.0;
  });
  EXPECT_GT(walk, 50);
  EXPECT_GT(walk, jumps + 10);
}

TEST(RandomOffset, AGradientOfTheSiteMayWalkToo) {
  std::map<int, double> gradient;
  double now = 0;
  for (int k = 0; k <= 200; ++k) gradient[k] = now += 0.1 * number_of(k);
  const auto of = [](const calib::testing::Hidden& hidden) {
    const auto s = testing::scene({.noise_nT = 0.05, .hidden = hidden}, 5);
    return evidence_of(RandomOffset::walk, Place{Place::Kind::gradient, 0}.channels(12), s->sums,
                       s->fit.problem);
  };
  EXPECT_LT(of({}), 3);
  // d B_z / d z of the site, seen by level and by tilted poses.
  const double walks = of([gradient](const Pose& p, int i, int a, const Eigen::Vector3d&) {
    const double along_x_m = i == 0 ? 0.2 : i == 2 ? -0.2 : 0;
    return a == 0 ? gradient.at(p.number) * along_x_m * std::cos(2 * *p.azimuth_rad) : 0.0;
  });
  EXPECT_GT(walks, 10);
}

/// What one axis shows is in the residual of the others through the field of the pose. Counted once it makes
/// no evidence for a walk of all.
TEST(RandomOffset, OneAxisIsNoWalkOfAll) {
  const auto s = testing::scene({.noise_nT = 0.05,
                                 .hidden =
                                     [](const Pose& p, int i, int a, const Eigen::Vector3d&) {
                                       return i == 1 && a == 0 ? 0.3 * std::sin(*p.t_s / 700) : 0.0;
                                     }},
                                5);
  std::vector<int> all;
  for (int c = 0; c < 12; ++c) all.push_back(c);
  const double one = evidence_of(RandomOffset::walk, {3}, s->sums, s->fit.problem);
  EXPECT_GT(one, 200);
  EXPECT_LT(evidence_of(RandomOffset::walk, all, s->sums, s->fit.problem), one);
}

}  // namespace
}  // namespace mgtd::calib::discovery
