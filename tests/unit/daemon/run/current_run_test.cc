// SPDX-License-Identifier: Apache-2.0
#include "daemon/run/current_run.h"

#include <gtest/gtest.h>

#include "daemon/plan/run_plan.h"

namespace mgtd::daemon::run {
namespace {

/// A run whose every action is answered at once with an event, as a table does that refuses an order.
struct Answered {
  Answered() : run([this](const Action& action, Stamp now) { carry_out(action, now); }) {}

  void carry_out(const Action& action, Stamp now) {
    EXPECT_FALSE(inside) << "an action within another";
    inside = true;
    ++actions;
    if (std::holds_alternative<Finish>(action)) ++finished;
    if (answers_left-- > 0) run.feed(Request::abort, now);
    inside = false;
  }
  void begin() {
    plan::RunPlan plan;
    plan.poses.resize(3);
    run.begin({}, plan, Stamp{});
  }

  CurrentRun run;
  bool inside{false};
  int actions{0}, finished{0}, answers_left{0};
};

TEST(CurrentRun, WhatHappensDuringAnActionReachesTheRunAfterIt) {
  Answered answered;
  answered.answers_left = 5;
  answered.begin();
  EXPECT_GT(answered.actions, 1);
  EXPECT_EQ(answered.run.fsm()->status(Instant{}).state, RunState::aborting);
}

TEST(CurrentRun, AnAnswerWaitsForTheNextEvent) {
  Answered answered;
  answered.begin();
  const int before = answered.actions;
  answered.run.answer(Request::abort);
  EXPECT_EQ(answered.actions, before);
  answered.run.feed(Tick{}, Stamp{});
  EXPECT_GT(answered.actions, before);
}

TEST(CurrentRun, NothingReachesARunThatWasForgotten) {
  Answered answered;
  answered.begin();
  answered.run.drop();
  EXPECT_FALSE(answered.run.active());
  const int before = answered.actions;
  answered.run.feed(Request::abort, Stamp{});
  EXPECT_EQ(answered.actions, before);
}

}  // namespace
}  // namespace mgtd::daemon::run
