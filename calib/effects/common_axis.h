// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "calib/effects/effect.h"
#include "calib/effects/where.h"

/// same_law_on_a_common_axis() decides whether two effects would be the same law on a common axis: a model
/// holds a law once on an axis, but the same law may act on several axes, each with a coefficient of its own.
namespace mgtd::calib::effects {

[[nodiscard]] bool share_an_axis(const Where& a, const Where& b);

/// Effects of site, table and platform, which have no axis, are the same law wherever they act, but for
/// dipoles whose places differ: those are two sources.
[[nodiscard]] bool same_law_on_a_common_axis(const Effect& a, const Effect& b);

}  // namespace mgtd::calib::effects
