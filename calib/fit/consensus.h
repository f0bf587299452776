// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <optional>
#include <vector>

#include "calib/calibration/tensor.h"

/// agreeing_poses() finds the poses that agree with each other, without a start and without knowing the
/// noise, while up to two in five are wrong by any amount.
///
/// Where the four sensors see one field, the twelve readings of a pose are an affine map of its three
/// components: all poses lie in one three-dimensional plane, y_k = m + U x_k, and there on one ellipsoid,
/// because |b_k| = F_k. Both are found by least trimmed squares: from many small random subsets of poses,
/// each concentrated on the three fifths that are nearest to what it fits (Rousseeuw and Van Driessen,
/// FAST-LTS). A random subset of five is clean once in six where three poses in ten are wrong; seventy are
/// drawn, always the same ones. What the model adds beyond this (gradients, effects) only blurs the
/// distances: the result is a start, never an estimate.
namespace mgtd::calib::fit {

using ReadingTable = Eigen::MatrixXd;  ///< a row for each channel, a column for each pose

/// Whether some poses are much farther from the plane that fits all of them best than most are, or one
/// direction of the misfit is much larger than the others. Cheap; says yes to gross readings, and often where
/// the model misses a law.
[[nodiscard]] bool looks_spoilt(const ReadingTable& y_nT);

/// Indices of the poses that agree, in order. `f_nT`: scalar reference of each pose, or a constant where
/// there is none. Empty where the poses turn about one axis only or are too few to tell.
[[nodiscard]] std::optional<std::vector<Eigen::Index>> agreeing_poses(const ReadingTable& y_nT,
                                                                      const Eigen::VectorXd& f_nT);
/// By the plane alone: where the field is known as a vector, its three components stand below the readings
/// and it need not have one strength.
[[nodiscard]] std::optional<std::vector<Eigen::Index>> agreeing_poses(const ReadingTable& y_nT);

}  // namespace mgtd::calib::fit
