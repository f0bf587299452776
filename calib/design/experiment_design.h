// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "calib/design/experiment_power.h"
#include "calib/effects/library/library.h"
#include "calib/fit/joint/identifiability.h"
#include "calib/sensor/geometry.h"
#include "calib/sensor/sensor_model.h"
#include "proto/pose.h"
#include "proto/tensor.h"
#include "proto/units.h"

/// evaluate_design() predicts what a list of poses would yield, before anything is measured: how well the
/// calibration would be known, and which missing effects would be seen and told apart (experiment_power.h).
///
/// The information of the joint fit is computed at the listed table angles and inverted (Cramer-Rao bound).
/// Readings play no part, so the answer holds for every rig similar to the given one. The noise and the
/// table's uncertainty are taken as known; a fit estimates them too.
namespace mgtd::calib::design {

struct DesignRequest {
  PoseTable poses;  ///< their angles, and what effects need to know of them; readings are not looked at
  double f_nT{50'000}, inclination_rad{to_rad(60)}, declination_rad{0};
  double pose_noise_nT{1};                                  ///< of a pose mean, each axis
  std::optional<double> scalar_sd_nT{kDefaultScalarSd_nT};  ///< of the scalar reference; empty: there is none
  bool field_known{false};  ///< without a scalar reference: the operator knows the field,
  double field_sd_nT{0};    ///< so well
  double table_sd_rad{to_rad(0.1)};
  sensor::Geometry geometry;
  PerSensor<sensor::SensorModel> sensors{};  ///< an earlier calibration, or nominal sensors
  std::vector<effects::EffectPtr> effects;
  double warming_degC{2};  ///< of the heads in the run, where the poses tell no temperature
  bool power{true};        ///< also say which effects would be seen and told apart
  std::vector<TableAngles> candidates{fit::joint::candidate_attitudes()};  ///< attitudes that may be proposed
};

struct Expected {
  std::string name;  ///< "s1 theta", "site.gradient Gxx"
  double sd{0};
  std::string unit;  ///< "deg", "nT", "" for scale factors
};

/// How well a coefficient of an effect is determined beside everything else in the model.
struct Separation {
  std::string name;
  double inflation{1};      ///< its standard error over the one it would have were all else known
  std::string alternative;  ///< the parameter it is most like
  double correlation{0};
};

/// Field, noise and table that the figures rest on: those of the request.
struct DesignAssumptions {
  double f_nT{0};
  std::optional<double> scalar_sd_nT{};
  bool field_known{false};
  double field_sd_nT{0};
  double inclination_rad{0};
  double pose_noise_nT{0};
  double table_sd_rad{0};
  double warming_degC{0};
};

struct DesignReport {
  int poses{0};
  std::size_t sensors{kSensorCount};
  bool determined{false};            ///< every parameter follows from the poses
  std::vector<Expected> parameters;  ///< standard errors; empty unless determined
  std::vector<Separation> separations;
  Gradient tensor_sd_nT_per_m;  ///< by the calibration alone, rms over attitudes; NaN unless determined
  Gradient noise_sd_nT_per_m;   ///< of a tensor from pose means, for comparison
  /// Of a component of the corrected field by the calibration alone, rms over sensors and attitudes; empty
  /// unless determined.
  std::optional<double> field_sd_nT;
  DesignAssumptions assumed;
  fit::joint::Gauge gauge;            ///< what holds the common rotation and the scale
  fit::joint::Identifiability known;  ///< weak directions, coverage, poses that would help
  /// The attitudes that lower the mean variance of the tensor most (of the field, where the array sees no
  /// gradient), each with the share of the variance it takes away.
  struct Helpful {
    TableAngles angles;
    double share{0};
  };
  std::vector<Helpful> helpful;
  std::optional<DesignPower> power;

  /// The array sees components of the gradient.
  [[nodiscard]] bool sees_gradient() const;
};

/// Refuses fewer poses than the fit would accept, and an effect that cannot act on them.
[[nodiscard]] Result<DesignReport> evaluate_design(const DesignRequest& request);

}  // namespace mgtd::calib::design
