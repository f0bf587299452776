// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "calib/sensor/geometry.h"
#include "proto/error.h"

namespace mgtd::daemon::store {

/// A PlacedFile is a file together with the places of the sensors that it was made with.
struct PlacedFile {
  std::string name;
  calib::sensor::Geometry places;
};

/// same_array() refuses two files of different arrays: of more or fewer sensors, or of a sensor that stands
/// elsewhere (Geometry::agrees_with). The message names both.
[[nodiscard]] Result<void> same_array(const PlacedFile& a, const PlacedFile& b, const std::string& remedy);

}  // namespace mgtd::daemon::store
