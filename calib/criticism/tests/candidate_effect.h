// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <Eigen/Core>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/effects/library/library.h"

/// A candidate effect is a family of effects that is tested at several scales and, where it has a fixed
/// number, at several values of it.
namespace mgtd::calib::criticism::tests {

/// One question: coefficients of the finest scale, combined. Column j of `combine` says which of them are
/// one.
struct Hypothesis {
  std::string where{};  ///< "all", "s3", "s3.z", "each-sensor", "each-axis", "site", "platform", "table"
  int axes{12};         ///< channels it acts on
  Eigen::MatrixXd combine{};
  std::vector<std::string> names{};  ///< of the combined coefficients
  int alike{1};                      ///< hypotheses of its scale: price of asking that often
};

struct CandidateEffect {
  std::string name{};
  effects::Level level{effects::Level::axis};
  std::vector<effects::EffectPtr>
      variants{};  ///< finest scale; one, or one for each value of the fixed number
  /// Of the searched number, as many as variants; an empty one is the form without it.
  std::vector<std::optional<double>> values{};
  std::string parameter{};  ///< its name
  double typical{1}, bound{0};
  /// What its law reads besides the field at the sensor: columns, in a fixed order ("T_degC", "t_s").
  std::string reads{};
  std::vector<Hypothesis> hypotheses{};
  /// The effect of one hypothesis, for the model; null: at its finest scale.
  std::function<Result<effects::EffectPtr>(const Hypothesis*, const std::optional<double>& value)> make{};
  /// A value of the searched number between two others; empty where there is none. See scan_refinement.h.
  std::function<std::optional<double>(double lower, double upper)> between{};
  /// Where the searched number is an instant of the run: every one that lies between two poses.
  std::vector<double> instants{};
  /// A dipole at a place (site frame, m), with the searched number of one of the variants: coefficients
  /// moment, then shift. Empty for a law that has none. See dipole_search.h.
  std::function<Result<effects::EffectPtr>(const Eigen::Vector3d& place_S_m,
                                           const std::optional<double>& value)>
      dipole_at{};
};

/// What cannot be tested at all, and why.
struct Untestable {
  std::string effect{}, why{};
};

struct CandidateEffects {
  std::vector<CandidateEffect> testable{};
  std::vector<Untestable> untestable{};
};

/// Hypotheses of an effect at its finest scale. Effects of the axes have coefficients "s3.z" or "s3.z.name".
[[nodiscard]] std::vector<Hypothesis> hypotheses_of(const effects::Effect& finest, int sensors);

/// Every effect of the library on this run, less those called like one of `left_out`.
[[nodiscard]] CandidateEffects library_candidates(const PoseTable& table,
                                                  const std::vector<effects::EffectPtr>& left_out = {});

/// The effect of a hypothesis, as `--with` reads it: "axis.offset.temperature@s3.z".
[[nodiscard]] std::string spec_of(const CandidateEffect& candidate_effect, const Hypothesis& hypothesis,
                                  std::size_t variant);

}  // namespace mgtd::calib::criticism::tests
