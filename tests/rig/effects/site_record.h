// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "tests/rig/effect.h"

namespace mgtd::rig {

/// This replays a day of the real field, minute by minute, north, east and down: what it changes from the
/// start of the run is added to the field of the site. Data: Boulder observatory, U.S. Geological Survey
/// (data/README.md).
class SiteRecord final : public EffectOf<SiteRecord> {
 public:
  using Minute = std::array<std::int16_t, 3>;  ///< hundredths of nT

  /// "usgs-bou-2016-01-18", a quiet day, or "usgs-bou-2016-01-20", a magnetic storm; the run starts at
  /// `start_h` of it (UT) and turns back at the end of the day. Empty when there is no such record.
  [[nodiscard]] static std::optional<SiteRecord> named(std::string_view name, double start_h);
  [[nodiscard]] static std::string names();

  [[nodiscard]] Eigen::Vector3d site_nT(double t_s, const Eigen::Vector3d& x_m) const override;
  [[nodiscard]] nlohmann::json truth() const override {
    return {{"effect", "site-record"}, {"record", name_}, {"start_h", start_h_}};
  }

 private:
  SiteRecord(std::string_view name, std::span<const Minute> minutes, double start_h);
  [[nodiscard]] Eigen::Vector3d at(double minute) const;

  std::string name_;
  std::span<const Minute> minutes_;
  double start_h_;
  Eigen::Vector3d start_nT_{0, 0, 0};
};

}  // namespace mgtd::rig
