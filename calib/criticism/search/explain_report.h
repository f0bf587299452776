// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "calib/criticism/search/explain_note.h"
#include "calib/criticism/tests/candidate.h"
#include "calib/criticism/tests/confusion.h"
#include "calib/criticism/tests/detectable.h"
#include "calib/criticism/tests/noise.h"
#include "calib/criticism/tests/residual_maps.h"
#include "calib/design/next_measurement.h"
#include "calib/fit/joint/joint_fit.h"

/// An ExplainReport holds the result of explain() (explain.h), as values.
namespace mgtd::calib::criticism::search {

enum class Finding { pass, explained, ambiguous, partial, unknown, bad_data };
[[nodiscard]] std::string_view to_string(Finding finding);

/// A step of the search: the winner, and what adding it did.
struct Round {
  tests::Candidate added;
  std::vector<std::string> possible{};  ///< other effects that could stand in its place
  double chi2_before{0}, chi2_after{0};
  double rms_before_nT{0}, rms_after_nT{0};
  std::vector<effects::EffectPtr> effects{};          ///< that were added: one, or one for each of a few axes
  std::vector<effects::EffectPtr> model{};            ///< after it
  std::shared_ptr<const fit::joint::JointFit> fit{};  ///< of that model; points into the pose table
};

struct ExplainReport {
  Finding finding{Finding::pass};
  std::vector<tests::Candidate> candidates{};  ///< of the model that was asked about, best first
  std::vector<std::string> named{};
  /// Specs of effects that were found and are not named: formulas of no library account for everything
  /// without them (stand_ins.h).
  std::vector<std::string> stand_ins{};
  /// Set by who looked for them: formulas account for what is left.
  bool formulas_account{false};
  Finding left{Finding::pass};  ///< PASS, UNKNOWN or PARTIAL: what stands out after the last round
  std::vector<Round> rounds{};
  std::vector<tests::MapScore> maps{};       ///< of the model that was asked about
  std::vector<tests::MapScore> maps_left{};  ///< after the last round
  tests::NoiseModel noise;
  double noise_nT{0}, residual_nT{0};
  double chi2{0}, dof{0};
  double omnibus_log10_p{0};
  double families{1};                           ///< independent ones, by draws
  std::vector<fit::OutlierNode> outliers{};     ///< left out beside the names that were found
  std::vector<tests::Detectable> detectable{};  ///< beside the model after the rounds
  std::vector<tests::Untestable> untestable{};
  std::optional<tests::ConfusionMatrix> confusion{};  ///< of the model that was asked about
  std::vector<design::NextMeasurement> next{};        ///< for the open round or else the first, best first
  std::vector<ExplainNote> notes{};                   ///< the same may stand there twice
  std::vector<effects::EffectPtr> model{};            ///< effects of the last fit
  std::shared_ptr<const fit::joint::JointFit>
      fit{};  ///< of the model that was asked about; points into the pose table
  /// The first round in whose place another effect could stand; null when there is none.
  [[nodiscard]] const Round* open_round() const;
};

}  // namespace mgtd::calib::criticism::search
