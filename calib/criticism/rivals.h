// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>
#include <vector>

#include "calib/criticism/score.h"

/// Which other names could stand behind the same residual.
///
/// If a is true with fitted signature v_a, another effect b falls short of it by lambda_ab = |(I - P_b)
/// v_a|^2 in the mean, and the difference of the two falls of chi-square is normal (lambda, 4 lambda): the
/// right one of the two wins with probability Phi(sqrt(lambda_ab) / 2). Seen from the data: b stays possible
/// while
///     z = (S_a - S_b + lambda_ba) / (2 sqrt(lambda_ba)) < 2.6
/// that is, while a deficit this large would not be strange if b were true.
///
/// And b stays possible, however large the effect, where all but a fiftieth of its signature (in squares)
/// lies within that of a: then only the exact form of two idealised laws would decide, not their physics. An
/// axis' own square against the squares of the transverse axes, in one field strength, is such a pair.
namespace mgtd::calib {

/// Share of a signature, in squares, inside that of another effect from which the two count as one.
inline constexpr double kAlike = 0.98;

/// The right one of two effects wins with this probability.
[[nodiscard]] double told_right(double lambda);

struct Rival {
  std::string effect{}, where{};
  std::string spec{};  ///< as --with reads it
  double z{0};
  double alike{0};    ///< share of its signature, in squares, that the winner's holds too
  double p_right{1};  ///< that of these two the right one wins, at the size that was found
  bool possible{false};
};

/// Against the winner of `families[a]`; most dangerous first. Hypotheses of one family are not rivals of each
/// other.
[[nodiscard]] std::vector<Rival> rivals_of(const std::vector<ScoredFamily>& families, std::size_t a);

}  // namespace mgtd::calib
