// SPDX-License-Identifier: Apache-2.0
#include "calib/linear/parts.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <atomic>
#include <barrier>
#include <chrono>
#include <set>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/support/one_processor.h"

namespace mgtd::calib::linear {
namespace {

TEST(Parts, EachIsDoneOnce) {
  for (const std::size_t count : {0U, 1U, 2U, 97U}) {
    std::vector<std::atomic<int>> done(count);
    for_each_part(count, [&](std::size_t i) { ++done[i]; });
    for (const std::atomic<int>& times : done) EXPECT_EQ(times, 1);
  }
}

/// Two parts that wait for each other end only where they are done at the same time.
TEST(Parts, AreDoneAtTheSameTime) {
  if (threads() < 2) GTEST_SKIP() << "one processor";
  std::barrier both(2);
  for_each_part(2, [&](std::size_t) { both.arrive_and_wait(); });
}

TEST(Parts, OfAPartAreDoneByItsThreadInTheirOrder) {
  std::vector<std::vector<std::size_t>> order(4);
  std::vector<std::set<std::thread::id>> threads(4);
  for_each_part(4, [&](std::size_t i) {
    threads[i].insert(std::this_thread::get_id());
    EXPECT_EQ(linear::threads(), 1U);
    for_each_part(5, [&](std::size_t j) {
      order[i].push_back(j);
      threads[i].insert(std::this_thread::get_id());
    });
  });
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(order[i], (std::vector<std::size_t>{0, 1, 2, 3, 4}));
    EXPECT_EQ(threads[i].size(), 1U);
  }
}

TEST(Parts, StayOnAThreadThatKeepsThem) {
  std::set<std::thread::id> by;
  std::thread::id own;
  std::thread([&] {
    own = std::this_thread::get_id();
    keep_parts_on_this_thread();
    EXPECT_EQ(threads(), 1U);
    for (int i = 0; i < 2; ++i)
      for_each_part(50, [&](std::size_t) { by.insert(std::this_thread::get_id()); });
  }).join();
  EXPECT_EQ(by, std::set{own});
}

TEST(Parts, WhatOneThrowsIsThrownAndNoneIsBegunAfterwards) {
  constexpr std::size_t kMany = 1'000'000;
  for (const std::size_t bad : {0U, 1U, 5U}) {
    std::atomic<std::size_t> begun{0};
    EXPECT_THROW(for_each_part(kMany,
                               [&](std::size_t i) {
                                 ++begun;
                                 if (i == bad) throw std::runtime_error("a part");
                                 if (i > bad) std::this_thread::sleep_for(std::chrono::microseconds(10));
                               }),
                 std::runtime_error);
    EXPECT_LT(begun, kMany);
  }
  int after = 0;  // and the next call is as if nothing had been
  for_each_part(1, [&](std::size_t) { ++after; });
  EXPECT_EQ(after, 1);
}

TEST(Parts, OnOneProcessorTheCallerDoesThemAll) {
  const std::size_t before = threads();
  {
    const test::OneProcessor one;
    EXPECT_EQ(threads(), 1U);
    std::set<std::thread::id> by;
    for_each_part(50, [&](std::size_t) { by.insert(std::this_thread::get_id()); });
    EXPECT_EQ(by, std::set{std::this_thread::get_id()});
  }
  EXPECT_EQ(threads(), before);
}

TEST(Parts, HaveAsManyThreadsAsTheAddressSpaceHolds) {
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_AS, &before), 0);
  if (before.rlim_max != RLIM_INFINITY) GTEST_SKIP() << "the address space is bounded";
  const std::size_t unbounded = threads();
  const auto in_MB = [&](rlim_t MB) {
    const rlimit bounded{MB * 1'000'000, before.rlim_max};
    const bool set = setrlimit(RLIMIT_AS, &bounded) == 0;
    const std::size_t out = threads();
    return set && setrlimit(RLIMIT_AS, &before) == 0 ? out : 0;
  };
  EXPECT_EQ(in_MB(400), 1U);
  EXPECT_EQ(in_MB(999), 1U);
  EXPECT_EQ(in_MB(1000), unbounded);
  EXPECT_EQ(in_MB(1'000'000), unbounded);
  EXPECT_LE(unbounded, 2U);
}

TEST(Parts, OfPosesCoverThemAllInTheirOrder) {
  for (const std::size_t poses : {0U, 1U, 1024U, 1025U, 5832U, 64U * 1024, 1'000'001U}) {
    std::vector<std::pair<std::size_t, std::size_t>> parts(parts_of_poses(poses));
    for_each_poses(poses, [&](std::size_t part, std::size_t from, std::size_t to) {
      parts.at(part) = {from, to};
    });
    std::size_t next = 0;
    for (const auto& [from, to] : parts) {
      EXPECT_EQ(from, next);
      EXPECT_GT(to, from);
      next = to;
    }
    EXPECT_EQ(next, poses);
    EXPECT_EQ(parts.size() > 1, poses > 1024);
    EXPECT_LE(parts.size(), 64U);
  }
}

}  // namespace
}  // namespace mgtd::calib::linear
