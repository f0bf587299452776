// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <boost/math/policies/policy.hpp>

namespace mgtd::calib::stats {

/// A BoostPolicy is what the functions of Boost.Math are called with: they compute in double, and where there
/// is no value they return NaN or infinity instead of throwing.
using BoostPolicy = boost::math::policies::policy<
    boost::math::policies::promote_double<false>,
    boost::math::policies::domain_error<boost::math::policies::ignore_error>,
    boost::math::policies::pole_error<boost::math::policies::ignore_error>,
    boost::math::policies::overflow_error<boost::math::policies::ignore_error>,
    boost::math::policies::evaluation_error<boost::math::policies::ignore_error>>;

/// Tail probabilities above this are Boost.Math's; below it, down to 1e-308, they lose digits and then are 0.
inline constexpr double kLeastBoostTail = 1e-290;

}  // namespace mgtd::calib::stats
