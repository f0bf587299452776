// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "calib/report/figures/figure.h"

/// waterfall_figure() shows, on log axes, what each effect takes out of the error, down to the noise: of the
/// readings (nT) and of the tensor (nT/m), where the array determines any of it. Parts add in squares. Two
/// bars for each effect: from the error without any effect to that with this one alone ("added first"), and
/// from the error without this one to that with all ("dropped last"). Where the two differ in length, the
/// effect shares what it explains with another.
namespace mgtd::calib::report::figures {

/// Parts of one error; each "share" is sqrt(error without^2 - error with^2).
struct FallValues {
  std::string unit{};
  double without{0}, with{0}, floor{0};
  std::vector<double> first_share{}, last_share{};  ///< by effect
  std::optional<double> held_out{};                 ///< on poses that the fit has not seen
};

struct WaterfallValues {
  std::vector<std::string> effects{};
  std::vector<std::string> short_names{};  ///< drawn in the place of an effect that is too long for its row
  FallValues residual{};
  std::optional<FallValues> tensor{};
};

[[nodiscard]] Figure waterfall_figure(const WaterfallValues& values);

}  // namespace mgtd::calib::report::figures
