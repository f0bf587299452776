// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/discovery/discovery_report.h"
#include "calib/fit/fit_options.h"
#include "proto/error.h"

/// discover() looks for the formula of a law that stands in no library: what the residual of a run depends
/// on, how, where, how sure that is and what else it could be.
///
///     PASS        nothing stands out from noise
///     LAW         one formula, P above 0.95, nothing left after it, and nothing random does as well
///     LAW-SET     the same, but several formulas remain that these poses do not tell apart
///     LIBRARY     an effect of the library describes it as well or better: explain names it
///     SHAPE-ONLY  something depends on what was recorded, and no formula of the grammar accounts for it
///     NOISE-LIKE  an offset that walks or jumps describes it better than any formula
///
/// The method: one linearisation of the joint fit with all nuisances and parameters projected out
/// (channel_sums.h), every formula of a fixed grammar at every place (grammar.h, law_search.h), one p-value
/// for the whole search by draws of noise, ranking by evidence (law_ranking.h), each law taken out and the
/// search repeated. A name says what the law depends on, never what causes it; it stays exploratory until the
/// same formula is confirmed on another run.
namespace mgtd::calib::discovery {

struct DiscoverOptions {
  fit::FitOptions fit;  ///< method joint; its effects are the model that is asked about
  int draws{2000};
  /// At a run as it grows, of which this is one: together they name as seldom what is not there as one alone.
  int looks{1};
  bool checks{true};  ///< fits again with the law, repeats the search in folds and halves
};

/// Poses that a search can hold in memory, and poses times channels where noise is correlated from pose to
/// pose. Of a longer run so many are taken, evenly; the report says how many.
inline constexpr std::size_t kMostPoses = 600, kMostCorrelated = 7000;

/// Refuses what a fit refuses.
[[nodiscard]] Result<DiscoveryReport> discover(const PoseTable& run, const DiscoverOptions& options);

}  // namespace mgtd::calib::discovery
