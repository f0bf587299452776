// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/criticism/tests/score.h"

/// The chi-square of a score is that of normal noise. Where the noise has heavier tails, a few poses far out
/// make large scores of nothing more often than it says. There an effect is also measured by the scatter of
/// what the poses say for it: with U the orthonormal columns of a question, U_k their rows in pose k, e what
/// is left of the residual beside them, and c_k = (1 - U_k'U_k)^-1 U_k'e_k what that pose adds to U'r when
/// the effect is fitted to the others,
///     S = (1 - k/n) s' V^-1 s,  s = U'r,  V = sum over k of c_k c_k'
/// of n poses and k columns: large noise in few poses makes V large as it does s (MacKinnon and White 1985,
/// HC3; the factor is that of Hotelling's T^2). Whether that counts is for the caller to say.
namespace mgtd::calib::criticism::tests {

/// How heavy the tails are of what a question leaves, and what its score is beside the scatter of the poses.
struct TailsBeside {
  double excess_kurtosis{0};  ///< mean over the rows of a pose; of normal noise zero
  double score_by_scatter{0};
};

/// Of the winning question of a family.
[[nodiscard]] TailsBeside tails_beside(const ScoredFamily& family, const Residual& residual);

}  // namespace mgtd::calib::criticism::tests
