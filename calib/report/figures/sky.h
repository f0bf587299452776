// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <numbers>
#include <optional>
#include <span>
#include <vector>

/// These functions map the sphere of directions to paper and find the holes between directions on it.
namespace mgtd::calib::report::figures {

/// Of the Mollweide projection; x within 2√2 either side of the middle, y within √2.
struct SkyPoint {
  double x{0}, y{0};
};
inline constexpr double kSkyHalfWidth = 2 * std::numbers::sqrt2, kSkyHalfHeight = std::numbers::sqrt2;

/// Mollweide's equal-area projection: with 2θ + sin 2θ = π sin φ,
///     x = (2√2 / π) λ cos θ,   y = √2 sin θ
/// so that equal areas of the unit sphere are equal areas of the map. Longitude λ within ±π, latitude φ
/// within ±π/2. [Snyder, Map Projections: A Working Manual, USGS 1395, pp. 249-252]
[[nodiscard]] SkyPoint sky_point(double longitude_rad, double latitude_rad);
/// λ = atan2(y, x), φ = asin(z / |d|). The zero vector has none: NaN.
[[nodiscard]] SkyPoint sky_point(const Eigen::Vector3d& direction);

/// The small circle of directions at `radius_rad` from `centre`, `steps` + 1 points, the first again at the
/// end.
[[nodiscard]] std::vector<Eigen::Vector3d> circle_around(const Eigen::Vector3d& centre, double radius_rad,
                                                         int steps);

/// The direction farthest from all of these, and how far it is from the nearest: over a grid of about 2
/// degrees.
struct LargestHole {
  Eigen::Vector3d centre{0, 0, 1};
  double radius_rad{std::numbers::pi};
};
[[nodiscard]] LargestHole largest_hole(std::span<const Eigen::Vector3d> directions);

/// The same while directions come one after the other: one more costs as little as the first.
class HoleSearch {
 public:
  HoleSearch();
  void add(const Eigen::Vector3d& direction);
  /// Nothing without directions.
  [[nodiscard]] std::optional<LargestHole> largest() const;

 private:
  std::vector<double> nearest_;  ///< of each place of the grid: cosine of the way to the nearest direction
  bool any_{false};
};

/// A part of the sphere between two latitudes and two longitudes. All cells of one call have the same area.
struct SkyCell {
  double from_longitude_rad{0}, to_longitude_rad{0}, from_latitude_rad{0}, to_latitude_rad{0};
};
[[nodiscard]] std::vector<SkyCell> sky_cells(int rows, int columns);
/// Of sky_cells(rows, columns): the one that a direction lies in.
[[nodiscard]] std::size_t sky_cell_of(const Eigen::Vector3d& direction, int rows, int columns);

}  // namespace mgtd::calib::report::figures
