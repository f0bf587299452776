// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "calib/criticism/tests/score.h"

/// alternatives_of() finds which other effects could have made the same residual.
///
/// The families are ranked by their p, in units of chi-square by
///     L = S - price,   price = S0 + 2 ln(p(S0) n),   S0 the winner's fall, n the questions that were asked.
/// If b were true with its fitted signature v_b, the residual would be v_b plus noise. In draws of that
/// residual the best of all other questions beats the best of b's own by D; in the data, by D_0. With
///     p_behind = P(D >= D_0)
/// b stays possible while p_behind is at least 1/200: the true name is lost in one run of 200 at the most,
/// however many alternatives there are and however close they lie.
///
/// If a is true with fitted signature v_a, b falls short of it by lambda_ab = |(I - P_b) v_a|^2 in the mean,
/// the difference of the two falls of chi-square is normal (lambda, 4 lambda), and the right one of the two
/// wins with probability Phi(sqrt(lambda_ab) / 2).
///
/// And b stays possible, however large the effect, where both laws read the same (CandidateEffect::reads) and
/// all but a twentieth of one signature (in squares) lies within the other's on the same axes: then only the
/// exact form of two idealised laws would decide, not their physics, and a twentieth of the signature is not
/// counted in p_right. What the winner has beyond that twentieth decides as soon as p_right is 0.99. An axis'
/// own square against the squares of the transverse axes, in one field strength, is such a pair: of square
/// axes the two would differ by a constant. Laws that read different things differ by what was measured, and
/// that decides: a gradient that was there from the first pose, against one that came after it. Nor is it a
/// matter of form where b has three coefficients or more beyond those of a that would stand out if they were
/// as large as its largest: a sensor that turns as a whole with its temperature (3) is told from axes that
/// lean by themselves (24), which would hardly lean as one by chance.
namespace mgtd::calib::criticism::tests {

/// Share of a signature, in squares, inside that of another effect from which the two count as one.
inline constexpr double kAlike = 0.95;
/// Share of true names that are declared impossible: of all looks at a run together, each of which has an
/// equal part of it.
inline constexpr double kLost = 0.005;

/// Probability that the right one of two effects wins.
[[nodiscard]] double probability_right(double lambda);
/// Of lambda: the right one of two wins in 99 of 100 runs.
inline constexpr double kToldApart = 4.65 * 4.65;

/// lambda of two idealised laws less what their form alone may make, of a signature of `length2` in squares.
[[nodiscard]] double beyond_form(double lambda, double length2);

struct Alternative {
  std::string effect{}, where{};
  std::string spec{};     ///< as --with reads it
  double p_behind{0};     ///< chance that it fell so far behind although it is the true one
  double alike{0};        ///< share of its signature, in squares, that the winner's holds too, or the reverse
  bool form_only{false};  ///< the exact form of two laws alone would tell them apart
  double p_right{1};      ///< that of these two the right one wins, at the size that was found
  bool possible{false};
};

/// Against the winner of `families[a]`; most dangerous first. Hypotheses of one family are not alternatives
/// to each other. `looks`: at the run, of which this is one.
[[nodiscard]] std::vector<Alternative> alternatives_of(const std::vector<ScoredFamily>& families,
                                                       std::size_t a, std::uint64_t seed, int looks = 1);

}  // namespace mgtd::calib::criticism::tests
