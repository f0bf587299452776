// SPDX-License-Identifier: Apache-2.0
#include "daemon/worker.h"

#include <gtest/gtest.h>

#include <thread>

namespace mgtd::daemon {
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

}  // namespace
}  // namespace mgtd::daemon
