// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/criticism/search/model_stage.h"

/// waterfall() computes how much each effect of a model takes out of the error, down to the noise.
///
/// Errors of independent causes add in squares, so the share of one is sqrt(error without^2 - error with^2).
/// Two orders: added first, to the twelve parameters of each sensor alone, and dropped last, from the whole
/// model. They agree where effects have nothing in common; what two of them share counts in neither's
/// "dropped last". Every fit has the weights of the whole model. Errors of the tensor are NaN where the array
/// determines no component of it.
namespace mgtd::calib::criticism::search {

struct WaterfallStep {
  std::string effect{}, spec{};
  double first_nT{0}, first_nT_per_m{0};
  double last_nT{0}, last_nT_per_m{0};
};

struct Waterfall {
  std::vector<WaterfallStep> steps{};  ///< largest last_nT first
  /// Residual of the readings and of the tensor: without any effect, with all, and what the noise alone
  /// makes.
  double without_nT{0}, without_nT_per_m{0};
  double with_nT{0}, with_nT_per_m{0};
  double floor_nT{0}, floor_nT_per_m{0};
};

[[nodiscard]] Result<Waterfall> waterfall(const PoseTable& table, const fit::FitOptions& options);

}  // namespace mgtd::calib::criticism::search
