// SPDX-License-Identifier: Apache-2.0
#include "daemon/store/worker.h"

#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace mgtd::daemon::store {
namespace {

TEST(Worker, ResultComesBackOnTheLiveThread) {
  boost::asio::io_context io(1);
  Worker worker(io);
  std::thread::id solved, delivered;
  int result = 0;
  worker.run(
      [&](std::stop_token) {
        solved = std::this_thread::get_id();
        return 42;
      },
      [&](int value) {
        delivered = std::this_thread::get_id();
        result = value;
      });
  io.run();
  EXPECT_EQ(result, 42);
  EXPECT_EQ(delivered, std::this_thread::get_id());
  EXPECT_NE(solved, delivered);
}

/// A job's input and its result have one owner at a time: neither is shared between the threads.
TEST(Worker, InputAndResultAreMovedNeverShared) {
  boost::asio::io_context io(1);
  Worker worker(io);
  std::unique_ptr<int> result;
  worker.run([input = std::make_unique<int>(42)](std::stop_token) mutable { return std::move(input); },
             [&](std::unique_ptr<int> value) { result = std::move(value); });
  io.run();
  ASSERT_NE(result, nullptr);
  EXPECT_EQ(*result, 42);
}

/// A computation that fails in a way nobody thought of must not end the acquisition.
TEST(Worker, WhatAJobThrowsIsItsError) {
  boost::asio::io_context io(1);
  Worker worker(io);
  Result<int> result = 1;
  worker.run([](std::stop_token) -> Result<int> { throw std::runtime_error("the lost thread"); },
             [&](Result<int> got) { result = std::move(got); });
  io.run();
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::internal);
  EXPECT_EQ(result.error().message, "the computation broke off: the lost thread");
  EXPECT_FALSE(result.error().remedy.empty());
}

TEST(Worker, AJobIsToldToStopWhenTheWorkerGoes) {
  boost::asio::io_context io(1);
  bool delivered = false;
  {
    Worker worker(io);
    worker.run(
        [](std::stop_token stop) {
          while (!stop.stop_requested()) std::this_thread::yield();
          return 1;
        },
        [&](int) { delivered = true; });
  }
  io.run();
  EXPECT_FALSE(delivered);
}

TEST(Worker, OneJobIsStoppedAndTheNextIsNot) {
  boost::asio::io_context io(1);
  Worker worker(io);
  std::vector<std::string> ended;
  const auto until_stopped = [](std::stop_token stop) {
    while (!stop.stop_requested()) std::this_thread::yield();
    return std::string("stopped");
  };
  const auto note = [&](const std::string& how) { ended.push_back(how); };
  std::stop_source under_way = worker.run(until_stopped, note);
  std::stop_source waiting = worker.run(until_stopped, note);
  worker.run([](std::stop_token stop) { return std::string(stop.stop_requested() ? "stopped" : "done"); },
             note);
  waiting.request_stop();
  under_way.request_stop();
  io.run();
  EXPECT_EQ(ended, (std::vector<std::string>{"stopped", "stopped", "done"}));
}

}  // namespace
}  // namespace mgtd::daemon::store
