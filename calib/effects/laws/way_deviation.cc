// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/way_deviation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "proto/units.h"

namespace mgtd::calib::effects::laws {
namespace {

/// A table that settles swings back by less.
constexpr double kTurnsBack_rad = to_rad(1);

/// An axis that stands is read as if it moved by less; a motor that holds its axis moves it by less.
constexpr double kStands_rad = to_rad(0.01), kMoves_rad = to_rad(0.1);
constexpr double kHalfway = 0.5;  // of an axis that does not move

constexpr std::array kAngles{&TableAngles::azimuth_rad, &TableAngles::pitch_rad, &TableAngles::roll_rad};

double step_rad(std::span<const PathPoint> way, std::size_t k, std::size_t axis) {
  const auto angle = kAngles[axis];
  return std::remainder(way[k].angles.*angle - way[k - 1].angles.*angle, 2 * std::numbers::pi);
}

/// Where an axis turns back: where it was last at its furthest. It may have waited there for another axis.
void add_turns(std::span<const PathPoint> way, std::size_t axis, std::vector<std::size_t>& turns) {
  struct Extreme {
    double rad{0};
    std::size_t k{0};
  } low, high;  // since the last turn
  double rad = 0;
  for (std::size_t k = 1; k < way.size(); ++k) {
    rad += step_rad(way, k, axis);
    if (rad < low.rad + kStands_rad) low = {std::min(rad, low.rad), k};
    if (rad > high.rad - kStands_rad) high = {std::max(rad, high.rad), k};
    const Extreme first = low.k < high.k ? low : high, last = low.k < high.k ? high : low;
    const bool went = std::abs(last.rad - first.rad) > kTurnsBack_rad;
    if (!went || std::abs(rad - last.rad) < kTurnsBack_rad) continue;
    turns.push_back(last.k);
    (low.k < high.k ? low : high) = {rad, k};
  }
}

/// 0 to 1: how far an axis has got at each point from `first` to `last`; empty where it does not move.
std::vector<double> progress(std::span<const PathPoint> way, std::size_t first, std::size_t last,
                             std::size_t axis) {
  std::vector<double> out{0};
  for (std::size_t k = first + 1; k <= last; ++k)
    out.push_back(out.back() + std::abs(step_rad(way, k, axis)));
  const double all_rad = out.back();
  if (all_rad < kMoves_rad) return {};
  for (double& share : out) share /= all_rad;
  return out;
}

/// Between two points of the way whose deviations are there already.
void fill_between(std::span<const PathPoint> way, std::size_t first, std::size_t last,
                  std::vector<AngleDeviation>& out) {
  const AngleDeviation from = out[first], to = out[last];
  std::array<std::vector<double>, kAngles.size()> progress_of;
  for (std::size_t axis = 0; axis < kAngles.size(); ++axis)
    progress_of[axis] = progress(way, first, last, axis);
  for (std::size_t k = first + 1; k < last; ++k) {
    Eigen::Array3d share;
    for (std::size_t axis = 0; axis < kAngles.size(); ++axis)
      share[static_cast<Eigen::Index>(axis)] =
          progress_of[axis].empty() ? kHalfway : progress_of[axis][k - first];
    const Eigen::Matrix3d S = share.matrix().asDiagonal(), L = (1 - share).matrix().asDiagonal();
    out[k].mean_rad = L * from.mean_rad + S * to.mean_rad;
    out[k].covariance = L * from.covariance * L + S * to.covariance * S + L * S;
  }
}

}  // namespace

std::vector<AngleDeviation> way_deviations(std::span<const PathPoint> way, const AngleDeviation& before,
                                           const AngleDeviation& after) {
  if (way.empty()) return {};
  std::vector<AngleDeviation> out(way.size());
  std::vector<std::size_t> nodes{0, way.size() - 1};
  for (std::size_t axis = 0; axis < kAngles.size(); ++axis) add_turns(way, axis, nodes);
  std::sort(nodes.begin(), nodes.end());
  out.front() = before, out.back() = after;
  for (std::size_t i = 1; i < nodes.size(); ++i) fill_between(way, nodes[i - 1], nodes[i], out);
  return out;
}

}  // namespace mgtd::calib::effects::laws
