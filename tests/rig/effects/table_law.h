// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cmath>

#include "tests/rig/effect.h"
#include "tests/rig/rotations.h"

/// Effects of the table's azimuth axis.
namespace mgtd::rig {

/// azimuth += e1 cos az + e2 sin az
class TableEccentricity final : public Effect {
 public:
  TableEccentricity(double cos_deg, double sin_deg) : cos_deg_(cos_deg), sin_deg_(sin_deg) {}
  [[nodiscard]] std::unique_ptr<Effect> fresh() const override {
    return std::make_unique<TableEccentricity>(*this);
  }
  [[nodiscard]] double azimuth_deg(const TableContext& c) const override {
    return cos_deg_ * std::cos(c.angle_deg[0] * kDeg) + sin_deg_ * std::sin(c.angle_deg[0] * kDeg);
  }
  [[nodiscard]] nlohmann::json truth() const override {
    return {{"effect", "table.eccentricity"}, {"cos_deg", cos_deg_}, {"sin_deg", sin_deg_}};
  }

 private:
  double cos_deg_, sin_deg_;
};

/// azimuth += 1e-6 kappa azimuth
class TableAngleScale final : public Effect {
 public:
  explicit TableAngleScale(double ppm) : ppm_(ppm) {}
  [[nodiscard]] std::unique_ptr<Effect> fresh() const override {
    return std::make_unique<TableAngleScale>(*this);
  }
  [[nodiscard]] double azimuth_deg(const TableContext& c) const override {
    return 1e-6 * ppm_ * c.angle_deg[0];
  }
  [[nodiscard]] nlohmann::json truth() const override {
    return {{"effect", "table.angle-scale"}, {"ppm", ppm_}};
  }

 private:
  double ppm_;
};

/// azimuth += beta sense
class TableBacklash final : public Effect {
 public:
  explicit TableBacklash(double deg) : deg_(deg) {}
  [[nodiscard]] std::unique_ptr<Effect> fresh() const override {
    return std::make_unique<TableBacklash>(*this);
  }
  [[nodiscard]] double azimuth_deg(const TableContext& c) const override { return deg_ * c.sense[0]; }
  [[nodiscard]] nlohmann::json truth() const override {
    return {{"effect", "table.backlash"}, {"deg", deg_}};
  }

 private:
  double deg_;
};

}  // namespace mgtd::rig
