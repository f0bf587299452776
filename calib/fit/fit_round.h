// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>

/// A FitRound tells someone who waits for a fit how far it has come; a fit weighs its readings anew in
/// rounds.
namespace mgtd::calib::fit {

struct FitRound {
  int round{1};           ///< of this fit; a fit that starts again from other poses counts anew
  double residual_nT{0};  ///< rms of reading less prediction after this round (PoseResiduals::residual_nT)
};

/// Is told each round of each fit, in the thread that fits.
using RoundListener = std::function<void(const FitRound&)>;

}  // namespace mgtd::calib::fit
