// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <vector>

#include "calib/discovery/channel_sums.h"
#include "calib/discovery/grammar.h"
#include "calib/discovery/place.h"

/// A FittedLaw is one formula at one place, with the coefficients that fit the residual best when
/// calibration, attitudes and fields are free: value = A^+ v, covariance A^+, A the products of its projected
/// columns and v their scores.
namespace mgtd::calib::discovery {

struct FittedLaw {
  Columns columns;
  Place place;
  int k{0};               ///< coefficients that these poses tell apart
  double S{0};            ///< fall of chi-square
  Eigen::VectorXd value;  ///< nT: columns of the first channel, then of the next
  Eigen::MatrixXd covariance;
  LawOnChannels law;                 ///< nT at each pose
  std::vector<LawOnChannels> basis;  ///< k directions, orthonormal after projection

  [[nodiscard]] double d() const;
};

/// A formula with its coefficients (order as FittedLaw::value), nT at each pose of the inputs.
[[nodiscard]] Result<LawOnChannels> law_on(const Columns& columns, const Place& place,
                                           const Eigen::VectorXd& value, LawInputs& inputs, int channels,
                                           int total);

/// k is zero where the calibration takes the formula up whole.
[[nodiscard]] Result<FittedLaw> fitted_law(const Columns& columns, const Place& place, LawInputs& inputs,
                                           const ChannelSums& sums);

/// All directions of a law: ChannelSums::take_out.
void take_out(const FittedLaw& law, ChannelSums& sums);

/// Square of the length of what law a, as it was fitted, has beyond everything that b can be, whatever its
/// coefficients. Two laws are told apart with 99 % when this is above
/// criticism::tests::kToldApart.
[[nodiscard]] double beyond(const FittedLaw& a, const FittedLaw& b, const ChannelSums& sums);

}  // namespace mgtd::calib::discovery
