// SPDX-License-Identifier: Apache-2.0
#include "calib/report/figures/sky.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <limits>

namespace mgtd::calib::report::figures {
namespace {

constexpr double kPi = std::numbers::pi;

/// θ of 2θ + sin 2θ = π sin φ. At the poles its slope vanishes.
double auxiliary_angle(double latitude_rad) {
  constexpr double kPole = kPi / 2;
  if (!(std::abs(latitude_rad) < kPole - 1e-9)) return std::clamp(latitude_rad, -kPole, kPole);
  const double target = kPi * std::sin(latitude_rad);
  const auto above = [&](double theta) { return 2 * theta + std::sin(2 * theta) - target; };
  const auto near = [](double low, double high) { return high - low < 1e-13; };
  std::uintmax_t most = 60;
  const auto [low, high] = boost::math::tools::toms748_solve(above, -kPole, kPole, near, most);
  return 0.5 * (low + high);
}

Eigen::Vector3d unit_at(double longitude_rad, double sin_latitude) {
  const double across = std::sqrt(std::max(0.0, 1 - sin_latitude * sin_latitude));
  return {across * std::cos(longitude_rad), across * std::sin(longitude_rad), sin_latitude};
}

constexpr int kHoleRows = 60, kHoleColumns = 120;

const std::vector<Eigen::Vector3d>& hole_grid() {
  static const std::vector<Eigen::Vector3d> grid = [] {
    std::vector<Eigen::Vector3d> out;
    for (int row = 0; row < kHoleRows; ++row)
      for (int column = 0; column < kHoleColumns; ++column)
        out.push_back(
            unit_at(-kPi + 2 * kPi * (column + 0.5) / kHoleColumns, -1 + 2 * (row + 0.5) / kHoleRows));
    return out;
  }();
  return grid;
}

}  // namespace

SkyPoint sky_point(double longitude_rad, double latitude_rad) {
  const double theta = auxiliary_angle(latitude_rad);
  return {2 * std::numbers::sqrt2 / kPi * longitude_rad * std::cos(theta),
          std::numbers::sqrt2 * std::sin(theta)};
}

SkyPoint sky_point(const Eigen::Vector3d& direction) {
  const double length = direction.norm();
  if (!(length > 0))
    return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
  return sky_point(std::atan2(direction.y(), direction.x()),
                   std::asin(std::clamp(direction.z() / length, -1.0, 1.0)));
}

std::vector<Eigen::Vector3d> circle_around(const Eigen::Vector3d& centre, double radius_rad, int steps) {
  const Eigen::Vector3d n = centre.normalized(), u = n.unitOrthogonal(), v = n.cross(u);
  std::vector<Eigen::Vector3d> out;
  for (int i = 0; i <= steps; ++i) {
    const double turn = 2 * kPi * i / steps;
    out.emplace_back(std::cos(radius_rad) * n +
                     std::sin(radius_rad) * (std::cos(turn) * u + std::sin(turn) * v));
  }
  return out;
}

HoleSearch::HoleSearch() : nearest_(static_cast<std::size_t>(kHoleRows) * kHoleColumns, -1) {}

void HoleSearch::add(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d d = direction.normalized();
  any_ = true;
  for (std::size_t i = 0; i < nearest_.size(); ++i)
    nearest_[i] = std::max(nearest_[i], hole_grid()[i].dot(d));
}

std::optional<LargestHole> HoleSearch::largest() const {
  if (!any_) return std::nullopt;
  const auto at = std::min_element(nearest_.begin(), nearest_.end());
  return LargestHole{.centre = hole_grid()[static_cast<std::size_t>(at - nearest_.begin())],
                     .radius_rad = std::acos(std::clamp(*at, -1.0, 1.0))};
}

LargestHole largest_hole(std::span<const Eigen::Vector3d> directions) {
  HoleSearch search;
  for (const Eigen::Vector3d& d : directions) search.add(d);
  return search.largest().value_or(LargestHole{});
}

std::vector<SkyCell> sky_cells(int rows, int columns) {
  std::vector<SkyCell> out;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      out.push_back({-kPi + 2 * kPi * column / columns, -kPi + 2 * kPi * (column + 1) / columns,
                     std::asin(-1 + 2.0 * row / rows),
                     std::asin(std::min(1.0, -1 + 2.0 * (row + 1) / rows))});
    }
  }
  return out;
}

std::size_t sky_cell_of(const Eigen::Vector3d& direction, int rows, int columns) {
  const double sine = std::clamp(direction.normalized().z(), -1.0, 1.0),
               turn = std::atan2(direction.y(), direction.x());
  const int row = std::clamp(static_cast<int>(std::floor((sine + 1) / 2 * rows)), 0, rows - 1);
  const int column =
      std::clamp(static_cast<int>(std::floor((turn + kPi) / (2 * kPi) * columns)), 0, columns - 1);
  return static_cast<std::size_t>(row * columns + column);
}

}  // namespace mgtd::calib::report::figures
