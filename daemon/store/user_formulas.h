// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/calibration/calibration.h"
#include "calib/effects/effect_spec.h"
#include "proto/error.h"

/// A user's formulas on a run are kept in its file (document "formulas").
namespace mgtd::daemon::store {

inline constexpr std::string_view kFormulasDocument = "formulas";

struct Definition {
  std::string name;
  std::string spec;      ///< complete, as make_effect reads it
  std::string found_on;  ///< data hash of the run it was thought of on: there its p-value proves nothing
  std::vector<calib::calibration::EffectCoefficient> found;  ///< its coefficients there
  std::optional<double> confirmed_log10_p;                   ///< on this run, where that is another
  [[nodiscard]] bool exploratory() const { return !confirmed_log10_p.has_value(); }
};

[[nodiscard]] std::string to_text(const std::vector<Definition>& definitions);
[[nodiscard]] Result<std::vector<Definition>> definitions_from_text(const std::string& text);

/// NAME[@WHERE][,PARAM=VALUE] of a definition as its whole spec; every other text stays as it is.
[[nodiscard]] std::string whole_spec(const std::string& text, const std::vector<Definition>& definitions);

}  // namespace mgtd::daemon::store
