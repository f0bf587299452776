// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "calib/criticism/search/evidence.h"
#include "calib/criticism/search/explain_report.h"
#include "calib/criticism/search/waterfall.h"
#include "calib/criticism/tests/confusion.h"
#include "calib/fit/joint/effect_impact.h"
#include "calib/report/figures/figure.h"

/// These functions draw figures of what explain() found: candidates and their evidence, what each effect
/// takes out, costs and brings, and what the run cannot see or tell apart.
namespace mgtd::calib::report {

[[nodiscard]] figures::Figure candidates_of(const criticism::search::ExplainReport& report);
/// Smallest sizes that are seen, of a run as measured or as planned.
[[nodiscard]] figures::Figure detectable_of(const std::vector<criticism::tests::Detectable>& detectable,
                                            const std::vector<criticism::tests::Untestable>& untestable);
/// `held_out_nT`: residual on poses that the fit of the whole model has not seen.
[[nodiscard]] figures::Figure waterfall_of(const criticism::search::Waterfall& waterfall,
                                           std::optional<double> held_out_nT);
[[nodiscard]] figures::Figure evidence_of(const criticism::search::Evidence& evidence);
[[nodiscard]] figures::Figure confusion_of(const criticism::tests::ConfusionMatrix& confusion);

/// Both fits with the same weights.
[[nodiscard]] figures::Figure price_of(const fit::joint::JointFit& narrow, const fit::joint::JointFit& wide);
/// By name of the effect. `fit`: whose standard error the shifts are held against.
[[nodiscard]] figures::Figure impact_of(
    const std::vector<std::pair<std::string, fit::joint::EffectImpact>>& impacts,
    const fit::joint::JointFit& fit);

}  // namespace mgtd::calib::report
