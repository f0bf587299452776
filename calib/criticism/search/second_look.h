// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "calib/criticism/tests/alternatives.h"
#include "calib/criticism/tests/criticism.h"

/// second_look() tests a winner and its alternatives again once the winner is in the model.
///
/// While much is missing, everything is judged in units of the misfit, and laws look alike that the noise of
/// the readings tells apart. The fit with the winner says where calibration, attitudes and field really are
/// and how large the noise is. There the winner is taken out again, without a new fit, and the residual,
/// which now is the winner's signature and noise, is tested for which of the laws makes it.
namespace mgtd::calib::criticism::search {

struct SecondLook {
  std::vector<tests::Alternative> alternatives{};  ///< of the winner, see alternatives.h
  std::optional<std::string> better{};  ///< the effect that has the smallest p, when it is not the winner
};

/// `first`: the judgement of the model without the winner, `winner` its family there; `narrow` that model,
/// and `with` the fit that has the winner. Empty where that fit leaves as large a misfit as there was before.
[[nodiscard]] std::optional<SecondLook> second_look(const PoseTable& table,
                                                    const fit::joint::JointOptions& narrow,
                                                    const tests::Criticism& first, std::size_t winner,
                                                    const std::vector<tests::Alternative>& alternatives,
                                                    double noise_inflation, const fit::joint::JointFit& with,
                                                    std::uint64_t seed, int looks);

}  // namespace mgtd::calib::criticism::search
