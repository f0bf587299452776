// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

/// A Place says where a law acts: on one axis; on the three axes of a sensor or all axes of the array, each
/// with coefficients of its own; or as a gradient of the site's field with five of them.
namespace mgtd::calib::discovery {

struct Place {
  enum class Kind { axis, sensor, array, gradient };
  Kind kind{Kind::axis};
  int at{0};  ///< channel of an axis, sensor of a sensor

  [[nodiscard]] std::string name() const;  ///< "s3.z", "s3", "each-axis", "site gradient"
  /// Of ChannelSums.
  [[nodiscard]] std::vector<int> channels(int of_readings) const;
  /// Places of this kind.
  [[nodiscard]] int alike(int channels) const;
  bool operator==(const Place&) const = default;
};

/// Every place of an array, axes first.
[[nodiscard]] std::vector<Place> places(int channels, bool gradient);

}  // namespace mgtd::calib::discovery
