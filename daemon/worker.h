// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>
#include <memory>
#include <stop_token>

/// The one thread beside the live one. It gets values, gives a value back on the live thread, and owns
/// nothing live.
namespace mgtd::daemon {

class Worker {
 public:
  explicit Worker(boost::asio::io_context& home) : home_(home) {}
  ~Worker() {
    stop_.request_stop();
    pool_.join();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// `job(stop_token)` runs on the worker; `done(its result)` on the live thread, unless the worker is gone
  /// by then.
  template <class Job, class Done>
  void run(Job job, Done done) {
    boost::asio::post(
        pool_, [this, job = std::move(job), done = std::move(done), alive = std::weak_ptr(alive_),
                keep = boost::asio::make_work_guard(home_)]() mutable {
          auto result = std::make_shared<decltype(job(stop_.get_token()))>(job(stop_.get_token()));
          boost::asio::post(home_, [alive = std::move(alive), done = std::move(done), result]() mutable {
            if (!alive.expired()) done(std::move(*result));
          });
        });
  }

 private:
  boost::asio::io_context& home_;
  std::stop_source stop_;
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
  boost::asio::thread_pool pool_{1};
};

}  // namespace mgtd::daemon
