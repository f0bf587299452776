// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/run_config.h"

#include <gtest/gtest.h>

#include "daemon/config/config.h"

namespace mgtd::daemon::run {
namespace {

/// Fits and disks are no faster where the rig's time is sped up.
TEST(RunConfig, WhatTheHostDoesMayTakeTheHostsTime) {
  config::Config config;
  const RunConfig real = run_config(config, {});
  config.speed_up = 40;
  const RunConfig fast = run_config(config, {});
  for (const auto limit : {&WaitLimits::store_max_s, &WaitLimits::judge_max_s, &WaitLimits::solve_max_s,
                           &WaitLimits::stop_max_s, &WaitLimits::answer_max_s})
    EXPECT_DOUBLE_EQ(fast.wait.*limit, 40 * (real.wait.*limit));
  EXPECT_EQ(fast.wait.lost_max_s, real.wait.lost_max_s) << "a simulated device is as fast as the rig";
}

}  // namespace
}  // namespace mgtd::daemon::run
