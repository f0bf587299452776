// SPDX-License-Identifier: Apache-2.0
#include "daemon/serve/console/job_queue.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <string>

namespace mgtd::daemon::serve::console {
namespace {

using ::testing::ElementsAre;
using namespace std::chrono_literals;

JobTask reading(const std::string& question) {
  JobTask task;
  task.question = task.command = question;
  return task;
}
JobTask change(const std::string& question) {
  JobTask task = reading(question);
  task.changes = true;
  return task;
}

TEST(JobQueue, RunsOneAfterTheOther) {
  JobQueue queue;
  const auto a = queue.put(reading("a"), {}), b = queue.put(reading("b"), {});
  EXPECT_EQ(queue.next({}), *a);
  EXPECT_FALSE(queue.next({})) << "one runs";
  EXPECT_EQ(queue.before(*b), 1U);
  queue.done(*a, 1, "A", Instant{3s});
  EXPECT_EQ(queue.ask(*a, {})->state, JobState::done);
  EXPECT_EQ(queue.ask(*a, {})->result, "A");
  EXPECT_EQ(queue.ask(*a, {})->exit_code, 1);
  EXPECT_EQ(queue.next({}), *b);
  EXPECT_EQ(queue.before(*b), 0U);
}

TEST(JobQueue, ReadersRunBesideEachOtherAndAWriterAlone) {
  JobQueue queue({.at_once = 2});
  const auto a = queue.put(reading("a"), {}), b = queue.put(reading("b"), {}),
             c = queue.put(reading("c"), {}), d = queue.put(change("d"), {}), e = queue.put(reading("e"), {});
  EXPECT_EQ(queue.next({}), *a);
  EXPECT_EQ(queue.next({}), *b);
  EXPECT_FALSE(queue.next({})) << "two run";
  EXPECT_EQ(queue.running(), 2U);
  queue.done(*a, 0, "A", {});
  EXPECT_EQ(queue.next({}), *c);
  queue.done(*b, 0, "B", {});
  EXPECT_FALSE(queue.next({})) << "the change waits for the last reader, and nobody passes it";
  queue.done(*c, 0, "C", {});
  EXPECT_EQ(queue.next({}), *d);
  EXPECT_FALSE(queue.next({})) << "nobody reads while it writes";
  queue.done(*d, 0, "D", {});
  EXPECT_EQ(queue.next({}), *e);
}

TEST(JobQueue, EightWaitAndTheNinthIsRefused) {
  JobQueue queue;
  ASSERT_TRUE(queue.put(reading("runs"), {}));
  ASSERT_TRUE(queue.next({}));
  for (int i = 0; i < 8; ++i) EXPECT_TRUE(queue.put(reading(std::to_string(i)), {}));
  const auto ninth = queue.put(reading("8"), {});
  ASSERT_FALSE(ninth);
  EXPECT_EQ(ninth.error().code, ErrorCode::refused);
  EXPECT_TRUE(queue.put(reading("3"), {})) << "a question that waits already is no further one";
}

TEST(JobQueue, TheSameQuestionIsAnsweredOnce) {
  JobQueue queue;
  const auto a = queue.put(reading("a"), {});
  EXPECT_EQ(*queue.put(reading("a"), {}), *a);
  ASSERT_TRUE(queue.next({}));
  queue.done(*a, 0, "A", {});
  EXPECT_EQ(*queue.put(reading("a"), {}), *a);
  const auto c = queue.put(change("c"), {});
  EXPECT_NE(*queue.put(change("c"), {}), *c) << "a change is made each time";
}

TEST(JobQueue, AFailedQuestionIsAskedAgain) {
  JobQueue queue;
  const auto a = queue.put(reading("a"), {});
  ASSERT_TRUE(queue.next({}));
  queue.failed(*a, "no memory", {});
  EXPECT_EQ(queue.ask(*a, {})->why, "no memory");
  EXPECT_NE(*queue.put(reading("a"), {}), *a);
}

TEST(JobQueue, CancellingTellsWhetherItRuns) {
  JobQueue queue;
  const auto a = queue.put(reading("a"), {}), b = queue.put(reading("b"), {});
  ASSERT_TRUE(queue.next({}));
  EXPECT_FALSE(queue.cancel(*b, {}));
  EXPECT_TRUE(queue.cancel(*a, {}));
  EXPECT_FALSE(queue.cancel(*a, {}));
  queue.done(*a, 0, "late", {});
  EXPECT_EQ(queue.ask(*a, {})->state, JobState::cancelled);
  EXPECT_FALSE(queue.next({}));
}

TEST(JobQueue, WhatNobodyAsksAboutIsForgottenUnlessItWrites) {
  JobQueue queue;
  const auto a = queue.put(reading("a"), {}), b = queue.put(reading("b"), {}), c = queue.put(change("c"), {});
  ASSERT_TRUE(a && b && c);
  EXPECT_THAT(queue.forgotten(Instant{119s}), ElementsAre());
  ASSERT_NE(queue.ask(*b, Instant{119s}), nullptr);
  EXPECT_THAT(queue.forgotten(Instant{121s}), ElementsAre(*a));
}

TEST(JobQueue, ResultsAreKeptInBoundedMemory) {
  JobQueue queue({.waiting = 8, .kept_bytes = 100, .kept_jobs = 3});
  std::vector<JobQueue::Id> ids;
  for (int i = 0; i < 4; ++i) {
    ids.push_back(*queue.put(reading(std::to_string(i)), Instant{std::chrono::seconds(i)}));
    ASSERT_TRUE(queue.next({}));
    queue.done(ids.back(), 0, std::string(10, 'x'), {});
  }
  EXPECT_EQ(queue.ask(ids[0], {}), nullptr);
  EXPECT_NE(queue.ask(ids[1], Instant{9s}), nullptr);
  const auto large = queue.put(reading("large"), Instant{10s});
  ASSERT_TRUE(queue.next({}));
  queue.done(*large, 0, std::string(1000, 'x'), {});
  EXPECT_NE(queue.ask(*large, {}), nullptr) << "the latest is there in any case";
  EXPECT_EQ(queue.ask(ids[1], {}), nullptr);
}

}  // namespace
}  // namespace mgtd::daemon::serve::console
