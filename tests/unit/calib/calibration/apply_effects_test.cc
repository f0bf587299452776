// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>

#include "calib/calibration/apply.h"
#include "calib/effects/library/library.h"
#include "calib/fit/method_choice/fit.h"
#include "proto/units.h"
#include "tests/unit/calib/fit/simulated_poses.h"

namespace mgtd::calib::calibration {
namespace {

using ::testing::HasSubstr;

/// A fit with the gradient of the site in the model: the gradient is real field and stays, unless asked.
TEST(ApplyEffects, EffectsOfTheSiteStayUnlessRemoved) {
  testing::Simulation sim{.table_sd_rad = to_rad(0.05)};
  sim.G_nT_per_m = testing::gradient_50();
  PoseTable table = testing::simulate(sim, 36, 121, 3);
  fit::FitOptions options;
  options.effects = {*effects::library::make_effect("site.gradient")};
  const auto report = fit::method_choice::fit(table, options);
  ASSERT_TRUE(report) << report.error().text();
  Calibration c = report->calibration;
  c.sample_noise_nT.setConstant(1);
  for (const double size : c.effects.front().size_nT) EXPECT_NEAR(size, 6, 5);  // 50 nT/m at 0.2 m
  const auto kept = apply(c, table), removed = apply(c, table, {.remove_site = true});
  ASSERT_TRUE(kept && removed);
  double with = 0, without = 0, chi2 = 0;
  for (std::size_t k = 0; k < kept->size(); ++k) {
    with += std::pow(kept->at(k).sample.g_nT_per_m.xx, 2) / 157;
    without += std::pow(removed->at(k).sample.g_nT_per_m.xx, 2) / 157;
    chi2 += std::pow(removed->at(k).sample.g_nT_per_m.xx / removed->at(k).sample.g_sd_nT_per_m.xx, 2) / 157;
  }
  EXPECT_GT(std::sqrt(with), 20);
  EXPECT_LT(std::sqrt(without), 4.5);  // sqrt 2 nT over 0.4 m is 3.5
  EXPECT_NEAR(chi2, 1, 0.4);           // 157 squares, the fit has taken some of it

  table.poses[7].pitch_rad.reset();
  EXPECT_TRUE(apply(c, table));
  const auto refused = apply(c, table, {.remove_site = true});
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message, HasSubstr("pose 8 has no pitch_deg"));
  c.effects.clear();
  EXPECT_THAT(apply(c, table, {.remove_site = true}).error().message, HasSubstr("no effect of the site"));
}

}  // namespace
}  // namespace mgtd::calib::calibration
