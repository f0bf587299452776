// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/criticism/tests/score.h"

/// A forward step adds the winner of a round to the model.
namespace mgtd::calib::criticism::search {

struct ForwardStep {
  std::vector<effects::EffectPtr> model;
  std::vector<effects::EffectPtr>
      added;  ///< the winner, or one effect for each of the few axes that make it up
};

/// A winner on several axes with one coefficient each is taken apart: the axis and the fixed number that
/// account for most, then the next with those taken out, as long as one stands out. Where a few axes carry
/// what the winner carries, each becomes an effect with its own number; else the winner stays whole.
///
/// What the winner holds already takes its place: the same law with the same fixed number on a part of the
/// winner's axes, "s3.z" in "each-axis". Everything else stays beside it; an axis that has the law with
/// another number does not get it twice. Refuses what the library refuses, and a winner of which nothing is
/// left.
[[nodiscard]] Result<ForwardStep> forward_step(const std::vector<effects::EffectPtr>& model,
                                               const tests::ScoredFamily& winner);

}  // namespace mgtd::calib::criticism::search
