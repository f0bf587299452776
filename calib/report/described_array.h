// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <utility>

#include "calib/sensor/geometry.h"
#include "proto/array_description.h"

namespace mgtd::calib::report {

/// described() gives the places and the capabilities of an array, as the stream and the status carry them.
[[nodiscard]] ArrayDescription described(const sensor::Geometry& array);

/// "the cross of four sensors, 0.4 m from arm to arm", "an array of 8 sensors".
[[nodiscard]] std::string array_name(const sensor::Geometry& array);

/// The names of two arrays that do not agree (Geometry::agrees_with). Where array_name() gives both the same,
/// the first place that differs tells them apart: "an array of 3 sensors with s2 at (0.3, 0, 0) m".
[[nodiscard]] std::pair<std::string, std::string> names_apart(const sensor::Geometry& a,
                                                              const sensor::Geometry& b);

/// Of chi-square of so many closure numbers: a good sample is beyond it once in a thousand. Wherever a
/// closure is shown, this is its limit.
[[nodiscard]] double closure_limit(double dof);

}  // namespace mgtd::calib::report
