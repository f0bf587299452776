// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/criticism/search/effect_search.h"

/// site_pair_instead() tries two sources at the site at once. Where two act together, a search that adds one
/// effect at a time begins with an effect that is neither of them, and what it adds next mends that.
///
/// The pairs are two dipoles, a dipole beside site.gradient, and site.gradient beside site.curvature; the
/// places of dipoles are searched (tests/dipole_search.h), first about the fit without the pair, then,
/// because strong sources bend that fit, about the best fit that is known, at most three times and as long as
/// that helps. Where such a fit has a dipole that was not given, a second one
/// is also searched beside it. A pair is preferred to
/// the effects of the rounds where
///
///     n ln(chi2) + k ln(n),   n degrees of freedom, k coefficients,     Schwarz, Ann. Statist. 6 (1978) 461
///
/// is lower by kClearly after a fit with each.
namespace mgtd::calib::criticism::search {

/// Twice the natural logarithm of odds of about 150.
inline constexpr double kClearly = 10;

/// That the rounds added, in their order.
[[nodiscard]] std::vector<effects::EffectPtr> effects_of(const std::vector<Round>& rounds);
/// Whether these are the effects of such a pair, in any order.
[[nodiscard]] bool is_site_pair(const std::vector<effects::EffectPtr>& effects);

/// Puts a pair in the place of all rounds where one is preferred, a round for each of its two effects; what
/// other pairs of about the same odds have besides becomes possible. True when it did. Rounds that are such a
/// pair themselves keep as possible what other pairs of about the same odds have. Where a preferred pair
/// cannot be added after all, the search stands at the model that was asked about, without rounds.
/// Axes that are closed to names are not allowed for.
[[nodiscard]] bool site_pair_instead(EffectSearch& search, ExplainReport& report);

}  // namespace mgtd::calib::criticism::search
