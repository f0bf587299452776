// SPDX-License-Identifier: Apache-2.0
#include "daemon/acquire/stuck_sensor.h"

#include <cmath>

namespace mgtd::daemon::acquire {
namespace {

constexpr double kStrange = 1e-3;
constexpr std::uint64_t kLong = 15;

/// Share of `of`, of which `seen` were so, as far as that is known.
double share(std::uint64_t seen, std::uint64_t of) {
  return (static_cast<double>(seen) + 0.5) / (static_cast<double>(of) + 1);
}

}  // namespace

bool StuckSensor::stands_still(const Eigen::Vector3d& y_nT) {
  const bool repeated = y_nT == last_nT_;
  last_nT_ = y_nT;
  if (repeated) {
    ++row_;
    if (rows_ == 0) return true;  // it was never seen to repeat itself and go on
    const double first = share(rows_, readings_), next = share(continued_, rows_ + continued_);
    return first * std::pow(next, static_cast<double>(row_ - 1)) < kStrange;
  }
  // A short row was the sensor's own way, whatever was thought of it; a long one was a standstill.
  if (row_ > 0 && row_ < kLong && readings_ > 1) {
    ++rows_;
    continued_ += row_ - 1;
  }
  ++readings_;
  row_ = 0;
  return false;
}

}  // namespace mgtd::daemon::acquire
