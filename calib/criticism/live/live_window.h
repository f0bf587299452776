// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <deque>

#include "calib/calibration/calibration.h"

/// A LiveWindow holds the latest closure of a stream as block means, which live criticism tests.
///
///     c = W q + noise      c = the closure numbers of the corrected fields, d of them      q = (1, b_P/F0)
///
/// An exact calibration of a uniform gradient has W = 0; errors dp of the parameters make a W that is linear
/// in them, so the calibration states how large W may be. Of the cross c is curl, centre x, y, z.
namespace mgtd::calib::criticism::live {

/// Of W by columns: d for the constant, d for each component of b.
using ClosureErrors = Eigen::MatrixXd;

/// What closure an intact calibration may have.
struct ClosurePrior {
  sensor::ChannelCovariance sample_noise;  ///< covariance of one sample, d x d
  /// Covariance of W by the parameters of the sensors; by coefficients of effects: not in it. 4d x 4d.
  ClosureErrors parameters;
  bool cross{true};  ///< the first quantity is a curl, nT/m; all others are nT
  [[nodiscard]] Eigen::Index numbers() const { return sample_noise.rows(); }
};
/// Noise must be known (Calibration::sample_noise_nT).
[[nodiscard]] ClosurePrior closure_prior(const calibration::Calibration& calibration);

struct ClosureSample {
  double t_s{0};  ///< from any origin, not going back
  sensor::FieldVector closure;
  Eigen::Vector3d b_P_nT;
  double T_degC{0};  ///< mean of the heads; NaN where not measured
};

/// Means over block_s seconds.
struct ClosureBlock {
  double t_s{0}, samples{0};
  sensor::FieldVector closure;
  Eigen::Vector3d u;  ///< b/F0
  double T_degC{0};   ///< NaN when no sample had one
  /// Scatter of the ten parts of the block against the noise of that many samples, 1 for white noise: what
  /// correlation within the block makes of it.
  double excess{1};
};

/// Slides: the oldest block goes when there is no room for a new one. A block in which more than two of its
/// ten parts have no sample is dropped.
class LiveWindow {
 public:
  LiveWindow(double block_s, std::size_t blocks, const ClosurePrior& prior);
  /// True when a block was completed with the sample before this one.
  bool add(const ClosureSample& sample);
  [[nodiscard]] const std::deque<ClosureBlock>& blocks() const { return blocks_; }
  [[nodiscard]] double block_s() const { return block_s_; }

 private:
  static constexpr int kParts = 10;
  struct Sums {
    double n{0}, t_s{0}, T_degC{0}, n_T{0};
    sensor::FieldVector closure;
    Eigen::Vector3d u{Eigen::Vector3d::Zero()};
  };
  [[nodiscard]] bool close();
  [[nodiscard]] Sums nothing() const;

  double block_s_;
  std::size_t most_;
  sensor::ChannelCovariance weight_;  ///< inverse of the noise of one sample
  std::int64_t number_{0};            ///< of the block under way, since the origin of time
  bool begun_{false};
  std::array<Sums, kParts> parts_;
  std::deque<ClosureBlock> blocks_;
};

}  // namespace mgtd::calib::criticism::live
