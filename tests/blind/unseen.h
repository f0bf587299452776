// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <vector>

#include "tests/blind/hidden_law.h"
#include "tests/rig/scenario.h"

/// This measures what improve is worth on poses that it has not seen, compared with an oracle that is told
/// the true effects. The unseen poses lie among the others, in the set "check"; the calibration is fixed
/// there and each pose fits its own field and attitude.
namespace mgtd::calib::testing {

struct Unseen {
  double nothing_nT{0}, improved_nT{0}, oracle_nT{0};  ///< residual of unseen poses
  double chi2{0}, dof{0};                              ///< of the poses that were fitted, after improve
  int rounds{0};
  std::vector<std::string> added;
};

/// Throws where a fit is refused.
[[nodiscard]] Unseen unseen(const PoseTable& table, const std::vector<std::string>& true_effects);

/// Residual of the poses of set "check", the calibration with these effects fixed, nT. Throws where a fit is
/// refused.
[[nodiscard]] double unseen_rms_nT(const PoseTable& table, const std::vector<std::string>& effects);

/// A law on one axis, `d` of its own uncertainties large.
[[nodiscard]] Unseen unseen_of_law(const HiddenLaw& law, double d, int channel, std::uint64_t seed);

/// A run of 157 poses on the simulated rig with unseen ones among them.
[[nodiscard]] PoseTable rig_run(const rig::Scenario& scenario, std::size_t unseen, std::uint64_t seed);

/// tests/scenarios/paper_experiment.toml, and the effects of the library that are behind it.
[[nodiscard]] rig::Scenario paper_experiment();
[[nodiscard]] std::vector<std::string> paper_effects();

}  // namespace mgtd::calib::testing
