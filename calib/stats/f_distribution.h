// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace mgtd::calib::stats {

/// f_log10_p() is the decimal logarithm of the probability that a variance ratio with (k, nu) degrees of
/// freedom exceeds f: the regularised incomplete beta function I_x(nu/2, k/2) at x = nu/(nu + k f). There is
/// no underflow: Boost.Math has no logarithm of I_x, and its I_x is 0 below 1e-308; where I_x is too small,
/// its continued fraction is evaluated here. Infinite nu: the chi-square of k f.
[[nodiscard]] double f_log10_p(double f, double k, double nu);

}  // namespace mgtd::calib::stats
