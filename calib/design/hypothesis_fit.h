// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "calib/criticism/tests/detectable.h"
#include "calib/design/hypothesis.h"
#include "calib/design/hypothesis_distance.h"
#include "calib/design/model_on_poses.h"

/// hypothesis_fit() fits hypotheses (hypothesis.h) to the residual of a run and says which pairs of them are
/// in question; distances_on() says how far apart those stand on the poses of a table.
namespace mgtd::calib::design {

/// Of a description, in standard deviations, below which the smallest size that is seen stands for it.
inline constexpr double kAssumedBelow = criticism::tests::kSeen;

struct HypothesisFit {
  std::vector<Hypothesis> hypotheses;  ///< numbers that they left open found on the run
  std::vector<Eigen::VectorXd> size;   ///< coefficients of each, one effect after the other
  std::vector<double> d;               ///< size on the run, in standard deviations
  bool assumed{false};                 ///< none is large enough to be seen: all have kAssumedBelow
  /// Of each two, the one that leaves less is taken as true. One that contains another and has more
  /// coefficients is in no pair, unless nothing else remains: their price decides there, and no measurement.
  std::vector<HypothesisPair> pairs;
};

/// Refuses a hypothesis that has no value on these poses, and one that the calibration takes up whole.
[[nodiscard]] Result<HypothesisFit> hypothesis_fit(const PoseTable& run, const fit::joint::JointFit& fit,
                                                   const fit::joint::JointOptions& options,
                                                   std::vector<Hypothesis> hypotheses);

/// lambda of each pair on the poses of a table, beside HypothesisFit::pairs.
[[nodiscard]] Result<std::vector<double>> distances_on(const PoseTable& table,
                                                       const HypothesisFit& hypotheses,
                                                       const fit::joint::JointFit& fit,
                                                       const fit::joint::JointOptions& options);

/// Rows of the poses of `table`, whitened, nuisances of each taken out. Columns: the calibration's
/// parameters, then each hypothesis's (`described`).
struct HypothesisRows {
  Eigen::MatrixXd run;  ///< of the first poses, and the priors
  std::vector<Eigen::MatrixXd> further;
  Eigen::Index fixed{0};
  std::vector<Described> described;
};

/// `of_run`: how many poses of the table are the run. Poses of the set "check" are not among the rows.
[[nodiscard]] Result<HypothesisRows> hypothesis_rows(const PoseTable& table, std::size_t of_run,
                                                     const HypothesisFit& hypotheses,
                                                     const fit::joint::JointFit& fit,
                                                     const fit::joint::JointOptions& options);

}  // namespace mgtd::calib::design
