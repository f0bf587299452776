// SPDX-License-Identifier: Apache-2.0
// A fit in which one combination of the unknowns is hardly determined: a step along it without damping is far
// too long, and one with the damping of a bad start leads nowhere.
#include <gtest/gtest.h>

#include <algorithm>

#include "calib/effects/library/library.h"
#include "calib/fit/joint/joint_fit.h"
#include "tests/blind/real_kind.h"

namespace mgtd::calib::fit::joint {
namespace {

TEST(JointSolver, SettlesAlongWhatIsWeaklyKnown) {
  const auto& kinds = testing::real_kinds();
  const auto octant = std::find_if(kinds.begin(), kinds.end(),
                                   [](const testing::RealKind& kind) { return kind.name == "octant"; });
  ASSERT_NE(octant, kinds.end());
  const PoseTable run = octant->make(601).table;
  JointOptions options;
  const auto without = fit_joint(run, options);
  ASSERT_TRUE(without) << without.error().text();
  options.effects = {*effects::library::make_effect("site.reference-error")};
  const auto with = fit_joint(run, options);
  ASSERT_TRUE(with) << with.error().text();
  EXPECT_LT(with->chi2, without->chi2);
}

}  // namespace
}  // namespace mgtd::calib::fit::joint
