// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "calib/calibration/calibration.h"
#include "calib/effects/level_terms.h"
#include "calib/sensor/channels.h"
#include "calib/sensor/geometry.h"
#include "calib/sensor/sensor_model.h"

/// An ArrayModel turns readings back into fields, with the sensors and the effects of a model: it is the
/// inverse of what the fit predicts. An effect whose inputs were not measured at a pose (Effect::missing) is
/// not removed there.
namespace mgtd::calib::calibration {

class ArrayModel {
 public:
  /// `coefficients` of all effects one after the other.
  ArrayModel(const PerSensor<sensor::SensorModel>& sensors, const sensor::Geometry& geometry,
             const std::vector<effects::EffectPtr>& effects, Eigen::VectorXd coefficients);

  /// Refuses an effect that is not in the library or has other coefficients there.
  [[nodiscard]] static Result<ArrayModel> of(const Calibration& calibration);

  /// Fields at the sensors, platform frame, with axis and platform effects removed. Effects of the site are
  /// real field and stay in. `R` (site to platform) is used by effects that know where down is; without it
  /// they see no gravity. The inverse is a fixed point: exact to 1e-9 nT for effects that change a reading by
  /// less than a tenth of itself.
  [[nodiscard]] sensor::FieldVector correct(const effects::Conditions& at, const sensor::FieldVector& y_nT,
                                            const std::optional<Eigen::Matrix3d>& R) const;
  /// What the site's effects add to a uniform field at each sensor, platform frame.
  [[nodiscard]] sensor::FieldVector site_field(const effects::Conditions& at, const Eigen::Matrix3d& R) const;
  [[nodiscard]] bool has_site_effects() const { return !site_.empty(); }
  [[nodiscard]] bool has_instrument_effects() const { return !axis_.empty() || has_platform_effects(); }
  /// They alone of the instrument's effects know where down is.
  [[nodiscard]] bool has_platform_effects() const { return !platform_.empty(); }
  /// Site to platform as the table truly stood, for recorded angles.
  [[nodiscard]] Eigen::Matrix3d attitude(const effects::Conditions& at) const;
  /// Derivative of the corrected field by the parameters of all sensors and then by all coefficients,
  /// readings held, to first order in the effects. `site_removed`: of the corrected field less site_field.
  [[nodiscard]] Eigen::MatrixXd derivative(const effects::Conditions& at, const sensor::FieldVector& b_P_nT,
                                           const std::optional<Eigen::Matrix3d>& R, bool site_removed) const;

 private:
  [[nodiscard]] int sensors() const { return static_cast<int>(sensors_.size()); }
  std::vector<effects::EffectPtr> effects_;  ///< kept alive for the terms
  PerSensor<sensor::SensorModel> sensors_;
  PerSensor<Eigen::Matrix3d> gain_;  ///< R (CA)^-1
  PerSensor<Eigen::Vector3d> offset_nT_;
  PerSensor<Eigen::Vector3d> positions_P_m_;
  effects::LevelTerms table_, site_, platform_, axis_;
  Eigen::VectorXd coefficients_;
};

}  // namespace mgtd::calib::calibration
