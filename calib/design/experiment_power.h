// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "calib/criticism/tests/candidate_effect.h"
#include "calib/criticism/tests/detectable.h"
#include "calib/fit/joint/joint_setup.h"
#include "calib/fit/joint/joint_solver.h"

/// design_power() says which effects that are not in its model a planned run would show, and which two causes
/// it could not tell apart.
///
/// Signatures z of the library's effects at the planned poses, calibration and pose nuisances projected out.
/// If a is the truth, the share of its signature that lies within that of b,
///     alike = |P_b z_a|^2 / |z_a|^2       (its square root: the correlation of the two)
/// is all there is to go by: at a size of d standard errors the right one of the two wins with probability
///     Phi(d sqrt(1 - alike) / 2).
/// b is taken at every scale that reaches where a is, and at every value of its searched number; a at the
/// place where it is hardest to tell. Readings play no part.
namespace mgtd::calib::design {

/// Of the size at which two effects are compared, in standard errors.
inline constexpr double kComparedAt_d = 10;
/// A pair that is named right less often than this cannot be separated.
inline constexpr double kSeparated = 0.95;

/// What would separate a pair.
struct Remedy {
  std::string action;
  double minutes{0};
  double p_right{0};  ///< afterwards
};

struct LookAlike {
  std::string effect, where;     ///< the truth
  std::string alternative;       ///< what it would be taken for
  double correlation{0};         ///< of the signatures
  double p_right{1};             ///< that the right one of the two is named, at d = kComparedAt_d
  std::optional<Remedy> remedy;  ///< the best further measurement; none of the menu helps where it is empty
  std::string advice;            ///< what the library's page says of this pair
};

struct DesignPower {
  std::vector<criticism::tests::Detectable>
      detectable;  ///< in the order of the library; value 0: at no size that occurs
  std::vector<criticism::tests::Untestable> untestable;
  std::vector<LookAlike> inseparable;  ///< worst first; each pair once
  int pairs{0};                        ///< compared
};

/// A rig at its planned poses: what the fit would work on.
struct DesignProblem {
  fit::joint::JointProblem problem;
  fit::joint::JointState state;
  fit::joint::Gauge gauge;
};
struct DesignRequest;

/// `table` holds readings made in thought; pointers into it are kept.
[[nodiscard]] Result<DesignProblem> design_problem(const DesignRequest& request, const PoseTable& table);

[[nodiscard]] Result<DesignPower> design_power(const DesignRequest& request, const PoseTable& table);

}  // namespace mgtd::calib::design
