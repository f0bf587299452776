// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "calib/calibration/calibration.h"
#include "calib/sensor/channels.h"
#include "proto/epoch.h"
#include "proto/pose.h"
#include "proto/tensor.h"

/// A TensorPipeline computes field, gradient tensor and closure from one set of readings.
///
/// The 3N corrected components b_i (platform frame, sensor at r_i) are fitted by least squares to
///     b_i = B + G r_i,   G symmetric and traceless (5 numbers)
/// and what is left over are the closure quantities (field_expansion.h); what the places of the sensors
/// cannot tell is NaN. On the cross the six differences decide G, and 12 - 3 - 5 = 4 quantities are left:
///     Bxx=(Bx1-Bx3)/d  Byx=(By1-By3)/d  Bzx=(Bz1-Bz3)/d  Bxy=(Bx2-Bx4)/d  Byy=(By2-By4)/d  Bzy=(Bz2-Bz4)/d
///     Gxx = Bxx, Gyy = Byy, Gzz = -(Bxx+Byy), Gxy = (Bxy+Byx)/2, Gxz = Bzx, Gyz = Bzy.
/// Does not remove site effects: a gradient of the site is real field.
namespace mgtd::calib::calibration {

class EffectCorrection;

struct FieldAndGradient {
  Eigen::Vector3d b_P_nT;
  Gradient g_nT_per_m;
  std::optional<Eigen::Vector3d> along_line_nT_per_m{};  ///< of sensors on one line
  Closure closure;                                       ///< chi2 is left NaN here: it needs the noise
};

/// The closure quantities as closure_rows() gives them: of the cross curl, centre x, y, z.
[[nodiscard]] sensor::FieldVector closure_numbers(const Closure& closure);

/// Over the components that the array can tell (those that are no NaN); NaN where it can tell none.
[[nodiscard]] double root_mean_square(const Gradient& g);

/// The vectors of all sensors one below the other.
[[nodiscard]] sensor::FieldVector stacked(const PerSensor<Eigen::Vector3d>& b);

/// Of the cross, in closed form.
[[nodiscard]] FieldAndGradient field_and_gradient(const sensor::FieldVector& b_P_nT, double baseline_m);

/// The six gradient components (xx, yy, zz, xy, xz, yz) and the closure quantities (of the cross curl, centre
/// x, y, z) as linear functions of the corrected components. The row of a component that the array cannot
/// tell is NaN.
[[nodiscard]] sensor::ChannelColumns<6> gradient_rows(const sensor::Geometry& geometry);
[[nodiscard]] Eigen::MatrixXd closure_rows(const sensor::Geometry& geometry);

/// The stream's arithmetic for one calibration. Everything that does not depend on the sample is computed
/// once; a sample allocates nothing.
///
/// Uncertainty. An error dp of the parameters shifts the corrected field of sensor i by -R (CA)^-1 dy(dp; b),
/// linear in (1, b): so the variance of any linear function of the corrected fields is a quadratic form q' Q
/// q in q = (1, b_P), with Q a constant 4x4 matrix per function. The noise of n samples adds a constant over
/// n, and never less than the scatter of a pose mean about the model in the calibration's own run: what the
/// model leaves out does not average away.
class TensorPipeline {
 public:
  /// No calibration: readings pass uncorrected (identity), samples are flagged `uncalibrated`, sd and chi2
  /// are NaN.
  explicit TensorPipeline(const sensor::Geometry& geometry);
  /// `run`: poses that will be applied, for effects with a memory (EffectCorrection).
  explicit TensorPipeline(std::shared_ptr<const Calibration> calibration, const PoseTable* run = nullptr);

  /// Effects of the instrument are removed with the temperatures and the time of the epoch; one whose inputs
  /// are not in it is left out, widens g_sd by its size, and flags the sample `incomplete` (LiveTensor knows
  /// more of a stream, and its memory).
  /// g_sd holds noise and calibration covariance together, the latter at the field of this very sample.
  /// `samples` is the number of samples averaged into the readings. `fields_P_nT` receives the corrected
  /// field at each sensor.
  [[nodiscard]] TensorSample apply(const Epoch& epoch, double samples = 1,
                                   sensor::FieldVector* fields_P_nT = nullptr) const;
  /// The same for a pose of a table, with everything it knows and the pose before it. `remove_site` takes the
  /// effects of the site out, for which the pose needs its table angles. seq and time stay empty.
  [[nodiscard]] TensorSample apply(const Pose& pose, double samples, bool remove_site = false,
                                   const Pose* previous = nullptr,
                                   sensor::FieldVector* fields_P_nT = nullptr) const;
  /// The corrected field at each sensor, platform frame, by the parameters of the sensors alone.
  [[nodiscard]] sensor::FieldVector correct(const PerSensor<Eigen::Vector3d>& y_nT) const;
  /// Field, gradient and closure of corrected fields, without their uncertainty.
  [[nodiscard]] TensorSample sample(const sensor::FieldVector& b_P_nT) const;
  /// Of the gradient: `covariance` of the corrected components by calibration and effects, and the noise.
  [[nodiscard]] Gradient gradient_sd(const sensor::ChannelCovariance& covariance, double samples) const;
  /// The same of the derivative along the line of the sensors; NaN of other arrays.
  [[nodiscard]] Eigen::Vector3d along_line_sd(const sensor::ChannelCovariance& covariance,
                                              double samples) const;
  /// Of one sample, in the corrected components; zero where noise_known() is false.
  [[nodiscard]] const sensor::ChannelCovariance& sample_noise() const { return noise_; }
  [[nodiscard]] bool noise_known() const { return noise_known_; }
  /// How many closure numbers the array has.
  [[nodiscard]] int closure_dof() const;
  /// Null without a calibration or without effects in it.
  [[nodiscard]] const EffectCorrection* effects() const { return effects_.get(); }
  [[nodiscard]] const std::shared_ptr<const Calibration>& calibration() const { return calibration_; }

 private:
  /// Variance of a linear function of the corrected fields: noise + q' Q q.
  struct Variance {
    double noise{0};
    Eigen::Matrix4d Q{Eigen::Matrix4d::Zero()};
    [[nodiscard]] double at(const Eigen::Vector4d& q, double samples) const {
      return noise / samples + by_parameters(q);
    }
    [[nodiscard]] double by_parameters(const Eigen::Vector4d& q) const { return q.dot(Q * q); }
  };

  void prepare_uncertainty();
  /// A sample as apply() makes it, without effects, sequence number and time.
  [[nodiscard]] TensorSample by_parameters(const PerSensor<Eigen::Vector3d>& y_nT, double samples,
                                           sensor::FieldVector* fields_P_nT) const;
  [[nodiscard]] FieldAndGradient expanded(const sensor::FieldVector& b_P_nT) const;
  void add_uncertainty(double samples, TensorSample& out) const;
  void add_uncertainty(const sensor::ChannelCovariance& covariance, double samples, TensorSample& out) const;
  /// Of a linear function of the corrected fields: what noise and what the parameters make of it, and what
  /// scatters about the model, which does not average away.
  struct Uncertainty {
    Variance variance;
    double unmodelled{0};
    [[nodiscard]] double noise(double samples) const {
      return std::max(variance.noise / samples, unmodelled);
    }
    [[nodiscard]] double sd(const Eigen::Vector4d& q, double samples) const {
      return std::sqrt(variance.by_parameters(q) + noise(samples));
    }
  };

  std::shared_ptr<const Calibration> calibration_;
  std::shared_ptr<const std::string> id_;
  sensor::Geometry geometry_;
  double baseline_m_;  ///< of the cross; 0: another array, which has rows_
  struct Rows;
  std::shared_ptr<const Rows> rows_;
  PerSensor<Eigen::Matrix3d> gain_;  ///< R_PS (C A)^-1
  PerSensor<Eigen::Vector3d> offset_nT_;
  std::shared_ptr<const EffectCorrection> effects_;
  sensor::ChannelCovariance noise_{sensor::ChannelCovariance::Zero(
      sensor::kChannels, sensor::kChannels)};  ///< of one sample, in the corrected components
  bool noise_known_{false};
  std::array<Uncertainty, 6> gradient_uncertainty_;
  std::array<Uncertainty, 3> line_uncertainty_;  ///< of the derivative along the line of the sensors
  /// Covariance of each pair of closure quantities, upper triangle by rows.
  std::vector<Variance> closure_covariance_;
};

}  // namespace mgtd::calib::calibration
