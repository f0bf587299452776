// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "calib/criticism/search/explain_report.h"
#include "calib/criticism/tests/criticism.h"
#include "calib/poses/pose_table.h"

/// An EffectSearch holds the state of the search for the effects that a model lacks. In each round the best
/// family is added, everything is fitted again, and what is left is judged anew.
namespace mgtd::calib::criticism::search {

struct EffectSearch {
  const PoseTable& table;
  fit::joint::JointOptions joint;
  tests::CandidateEffects candidate_effects;
  std::uint64_t seed;
  int looks{1};                             ///< ExplainOptions
  fit::joint::JointFit fit;                 ///< of `joint`, with the covariance of the noise in force
  tests::Criticism criticism;               ///< of `fit`
  std::vector<effects::EffectPtr> given{};  ///< the model that was asked about
  std::set<std::string> failed{};           ///< effects that no fit settled with
  /// Effects that would have needed a size beyond what occurs, and that size as last seen.
  std::map<std::string, tests::Candidate> absurd{};
  std::optional<EvidenceOfOnePose> one_pose{};  ///< of the first effect whose evidence is that of one pose
  std::set<std::string> unknown{};  ///< axes and sensors with a law of no library: closed to effects
  bool pairs_tried{false};          ///< site_pair.h
  bool slow{false};                 ///< the residual follows time or temperature: no memory of a turn does

  /// Of a fit of `joint`; the rates of false alarms stay those that are known.
  void judge_anew(const fit::joint::JointFit& refit);
};

[[nodiscard]] double residual_of(const fit::joint::JointFit& fit);

/// Takes the fit with what `round` adds as that of the model, which is judged anew. Fills in what the round
/// did.
void add_round(Round round, fit::joint::JointOptions wider, const fit::joint::JointFit& refit,
               EffectSearch& search, ExplainReport& report);

/// Adds what stands out: at most so many laws, a dependence on temperature with both its terms and all its
/// axes counting as one. False: nothing stands out but what rests on one pose.
[[nodiscard]] bool add_rounds(int most, EffectSearch& search, ExplainReport& report);

}  // namespace mgtd::calib::criticism::search
