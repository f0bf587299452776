// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace mgtd::calib::stats {

/// chi_square_p() is the probability that a chi-square with `dof` degrees of freedom exceeds x: the
/// regularised upper incomplete gamma function Q(dof/2, x/2) of Boost.Math. 1 for x <= 0.
[[nodiscard]] double chi_square_p(double x, double dof);
/// Its decimal logarithm, without underflow: Boost.Math has no logarithm of Q, and its Q is 0 below 1e-308.
/// Where Q is too small, its continued fraction is evaluated here.
[[nodiscard]] double chi_square_log10_p(double x, double dof);
/// The x that is exceeded with probability p, 0 < p < 1 (Boost.Math's inverse of Q).
[[nodiscard]] double chi_square_limit(double p, double dof);
/// The value of a chi-square with `other_dof` degrees of freedom that is exceeded as rarely as x of one with
/// `dof`, x > 0; x itself where the two are the same. The probability must be above 1e-300.
[[nodiscard]] double chi_square_alike(double x, double dof, double other_dof);

}  // namespace mgtd::calib::stats
