// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/sensor/channels.h"
#include "calib/sensor/geometry.h"
#include "calib/sensor/sensor_model.h"
#include "proto/check.h"
#include "proto/error.h"

/// A Calibration is the result of a run: an immutable value that is complete in itself. Its id is the hash of
/// its content, so that two calibrations with one id are the same; every streamed sample names the one it
/// used.
namespace mgtd::calib::calibration {

inline constexpr int kArrayParameters = kSensors * sensor::kSensorParameters;  ///< of the cross: 48
/// One number per sensor (row) and axis (column), nT.
using AxisNoise = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor, kMostSensors, 3>;

/// Over all axes.
[[nodiscard]] double root_mean_square(const AxisNoise& noise_nT);

/// The conditions under which the parameters hold.
struct Reference {
  PerSensor<std::optional<double>> T_degC;   ///< mean head temperature during the run
  std::string t_utc;                         ///< start of the run; empty when unknown
  std::optional<double> f_nT;                ///< mean total field
  std::map<std::string, double> currents_A;  ///< means of the columns ending in _A
};

/// A coefficient of an effect as it was fitted.
struct EffectCoefficient {
  std::string name;  ///< "Gxx", "s3.z"
  double value{0}, sd{0};
  std::string unit;
};

/// An effect that is part of the calibration, by its name in the library.
struct CalibratedEffect {
  std::string effect;
  std::vector<EffectCoefficient> coefficients;
  /// What leaving it out changes in the corrected components (sensor by sensor), rms over the poses of the
  /// fit: what its absence costs where its inputs are not measured.
  sensor::FieldVector size_nT{};
};

struct Calibration {
  std::string id;      ///< "c" and 12 hex digits; set by seal()
  std::string method;  ///< "simplified", "two-step", "joint"
  PerSensor<sensor::SensorModel> sensors;
  /// Of the parameters in kParameterNames order, sensor by sensor.
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(kArrayParameters, kArrayParameters);
  std::vector<CalibratedEffect> effects;
  /// Of all coefficients (rows) with the 48 parameters and then with all coefficients (columns); empty
  /// without effects.
  Eigen::MatrixXd effect_covariance;
  sensor::Geometry geometry;
  /// Of one sample, for the stream's standard deviations; 0: unknown.
  AxisNoise sample_noise_nT = AxisNoise::Zero(kSensors, 3);
  AxisNoise pose_noise_nT = AxisNoise::Zero(kSensors, 3);  ///< scatter of a pose mean about the model
  std::string gauge;  ///< which common rotation was fixed, how, and how well it is known
  Reference reference;
  std::string data_hash;  ///< of the poses it was fitted to
  int poses{0};
  bool accepted_by_checks{false};
  std::vector<Check> checks;  ///< every named check with measured value and limit; key "verdict" of CAL.json
  std::string software;

  /// Fills `id` from everything else.
  void seal();
};

/// Covariance of the 48 parameters and then of all coefficients.
[[nodiscard]] Eigen::MatrixXd full_covariance(const Calibration& calibration);

/// Text form (JSON, CAL.json). Numbers round-trip bit for bit.
[[nodiscard]] std::string to_json_text(const Calibration& calibration);
/// Refuses a file whose id is not the hash of its content, an unknown schema, or a missing key, by name.
[[nodiscard]] Result<Calibration> calibration_from_json_text(std::string_view text);

}  // namespace mgtd::calib::calibration
