// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/effects/site_record.h"

#include <algorithm>
#include <cmath>

namespace mgtd::rig {
namespace {

constexpr std::array<SiteRecord::Minute, 1440> kQuiet{{
#include "tests/rig/data/usgs_bou_quiet.inc"
}};
constexpr std::array<SiteRecord::Minute, 1440> kStorm{{
#include "tests/rig/data/usgs_bou_storm.inc"
}};
constexpr std::string_view kQuietName = "usgs-bou-2016-01-18", kStormName = "usgs-bou-2016-01-20";

Eigen::Vector3d nT(const SiteRecord::Minute& m) { return Eigen::Vector3d(m[0], m[1], m[2]) / 100; }

}  // namespace

std::optional<SiteRecord> SiteRecord::named(std::string_view name, double start_h) {
  if (name == kQuietName) return SiteRecord(name, kQuiet, start_h);
  if (name == kStormName) return SiteRecord(name, kStorm, start_h);
  return std::nullopt;
}

std::string SiteRecord::names() { return std::string(kQuietName) + ", " + std::string(kStormName); }

SiteRecord::SiteRecord(std::string_view name, std::span<const Minute> minutes, double start_h)
    : name_(name), minutes_(minutes), start_h_(start_h), start_nT_(at(60 * start_h)) {}

/// Through the four minutes around it, with a continuous slope (Catmull and Rom).
Eigen::Vector3d SiteRecord::at(double minute) const {
  const auto last = static_cast<double>(minutes_.size() - 1);
  const double turned = std::fmod(std::max(0.0, minute), 2 * last);
  const double m = turned <= last ? turned : 2 * last - turned;
  const double whole = std::min(std::floor(m), last - 1), s = m - whole;
  const auto point = [&](double k) {
    return nT(minutes_[static_cast<std::size_t>(std::clamp(whole + k, 0.0, last))]);
  };
  const Eigen::Vector3d a = point(-1), b = point(0), c = point(1), d = point(2);
  return b + 0.5 * s * (c - a + s * (2 * a - 5 * b + 4 * c - d + s * (3 * (b - c) + d - a)));
}

Eigen::Vector3d SiteRecord::site_nT(double t_s, const Eigen::Vector3d&) const {
  return at(60 * start_h_ + t_s / 60) - start_nT_;
}

}  // namespace mgtd::rig
