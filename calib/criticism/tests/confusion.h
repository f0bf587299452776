// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "calib/criticism/tests/score.h"

/// A ConfusionMatrix says, pair by pair, which effects look alike on one run. Of effect a the question that
/// fits these poses best is taken at its fitted form, with the calibration, attitudes and fields free; of
/// effect b all questions:
///
///     correlation   length of a's signature inside the nearest of b's spaces, 0 to 1
///     p_right       that the right one of the two is named, if a is there in the smallest size that is seen
///                   in 99 of 100 runs (d = 8): Phi(sqrt(lambda) / 2), lambda = d^2 (1 - correlation^2)
///
/// It is not symmetric: an effect with many coefficients holds one with few, not the reverse.
namespace mgtd::calib::criticism::tests {

struct ConfusionMatrix {
  std::vector<std::string> effects{}, where{};  ///< of the question that was taken
  Eigen::MatrixXd correlation{}, p_right{};     ///< row: the effect that is there; column: the other
};

[[nodiscard]] ConfusionMatrix confusion_of(const std::vector<ScoredFamily>& families);

}  // namespace mgtd::calib::criticism::tests
