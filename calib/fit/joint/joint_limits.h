// SPDX-License-Identifier: Apache-2.0
#pragma once

/// These limits say where the iterations of a joint fit stop. Falls are of chi-square, without unit; no flag
/// changes them.
namespace mgtd::calib::fit::joint {

/// Steps of one solution. A fit that the poses determine needs fewer than twenty.
inline constexpr int kMaxIterations = 200;
/// Predicted fall by the next step at which a solution counts as the minimum; a calibration that moves
/// chi-square by so little moves by 3e-5 of its standard deviation.
inline constexpr double kConverged = 1e-9;
/// The same for a recording, whose chi-square is summed over tens of thousands of readings: a calibration
/// that moves it by so little moves by 1e-3 of its standard deviation.
inline constexpr double kRecordingConverged = 1e-6;
/// The same for a search that only compares solutions.
inline constexpr double kNearlyConverged = 0.1;
/// The same while the weights are not known yet: what is smaller is not worth a step.
inline constexpr double kWeightsUnknown = 10;
/// A predicted fall below this share of chi-square is rounding, not progress.
inline constexpr double kRelativeDecrease = 1e-11;
/// Levenberg-Marquardt damping: the least, tried after a step without it failed; from where on it grows in
/// steps of ten instead of a hundred; and where the solver gives up. Relative to the
/// diagonal of the information.
inline constexpr double kLeastDamping = 1e-10, kFirstDamping = 1e-4, kMaxDamping = 1e8;
/// Termination::slow_progress: at the step limit, over so many last steps, chi-square fell by less than this
/// and this share of it.
inline constexpr int kSlowIterations = 12;
inline constexpr double kSlowFall = 1e-2, kRelativeSlowFall = 1e-6;
/// Rounds of solving, estimating the noise and leaving readings out: nearly all runs settle within six.
inline constexpr int kMaxWeighingRounds = 30;

}  // namespace mgtd::calib::fit::joint
