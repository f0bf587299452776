// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <variant>

#include "proto/flags.h"
#include "proto/reading.h"
#include "proto/time.h"

/// An Epoch holds the readings of all sensors at one instant; a Gap says that they are missing, and why.
namespace mgtd {

struct Epoch {
  std::uint64_t seq{0};  ///< counts epochs of the stream, gaps included
  Stamp t;               ///< when the field was what it was (device latency removed as far as known)
  PerSensor<Eigen::Vector3d> y_nT{no_readings()};
  /// Latest head temperature; NaN where never measured.
  PerSensor<double> T_degC = PerSensor<double>(kSensorCount, std::numeric_limits<double>::quiet_NaN());
  double skew_bound_s{0};  ///< no two of the samples differ in true time by more than this
  Flags flags;
};

/// Epochs from_seq .. to_seq, both included, were not measured.
struct Gap {
  std::uint64_t from_seq{0};
  std::uint64_t to_seq{0};
  Stamp at;
  std::string why;
};

using EpochOrGap = std::variant<Epoch, Gap>;

}  // namespace mgtd
