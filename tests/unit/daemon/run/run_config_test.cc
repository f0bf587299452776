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
  for (const auto limit : {&RunConfig::store_max_s, &RunConfig::judge_max_s, &RunConfig::solve_max_s,
                           &RunConfig::stop_max_s, &RunConfig::answer_max_s})
    EXPECT_DOUBLE_EQ(fast.*limit, 40 * (real.*limit));
  EXPECT_EQ(fast.lost_max_s, real.lost_max_s) << "a simulated device is as fast as the rig";
}

}  // namespace
}  // namespace mgtd::daemon::run
