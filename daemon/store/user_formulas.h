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

/// How `mgt discover` found a formula, and what else it could be.
struct Discovered {
  std::string word;  ///< LAW or LAW-SET
  double P{0};
  struct Other {
    std::string formula, where;
    double P{0};
    std::string
        spec{};  ///< as make_effect reads it; empty where it takes several effects, or none can say it
  };
  std::vector<Other> others{};  ///< of the 99 % set, best first
  std::size_t more{0};          ///< that are in the set beside these
  std::string data_hash{};      ///< of the poses that were searched
  /// "found by mgt discover (LAW-SET, P 0.82); could also be max(0, abs(z)-0.57) at s3.z (0.15), and 2 more"
  [[nodiscard]] std::string text() const;
};

struct Definition {
  std::string name;
  std::string spec;      ///< complete, as make_effect reads it
  std::string found_on;  ///< data hash of the run it was thought of on: there its p-value proves nothing
  std::vector<calib::calibration::EffectCoefficient> found;  ///< its coefficients there
  std::optional<double> confirmed_log10_p;                   ///< on this run, where that is another
  std::optional<Discovered> discovered{};                    ///< empty: it was thought of by a person
  [[nodiscard]] bool exploratory() const { return !confirmed_log10_p.has_value(); }
};

[[nodiscard]] std::string to_text(const std::vector<Definition>& definitions);
[[nodiscard]] Result<std::vector<Definition>> definitions_from_text(const std::string& text);

/// NAME[@WHERE][,PARAM=VALUE] of a definition as its whole spec; every other text stays as it is.
[[nodiscard]] std::string whole_spec(const std::string& text, const std::vector<Definition>& definitions);

}  // namespace mgtd::daemon::store
