// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include <boost/asio/executor_work_guard.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/thread_pool.hpp>
#include <exception>
#include <memory>
#include <stop_token>
#include <string>
#include <type_traits>

#include "proto/error.h"

/// A Worker is a thread beside the live one; the daemon has one for fits and one for the disk (disk_sync.h).
/// It gets values, gives a value back on the live thread, and owns nothing live. Jobs run one after the
/// other.
namespace mgtd::daemon::store {

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
  /// by then. What is returned stops this job, begun or not; the end of the worker stops them all. A job that
  /// is stopped still gives a result. What a job throws is its result where that may be an Error: a
  /// computation that fails in a way nobody thought of must not end the acquisition.
  template <class Job, class Done>
  std::stop_source run(Job job, Done done) {
    std::stop_source this_job;
    boost::asio::post(pool_, [all = stop_.get_token(), this_job, &home = home_, job = std::move(job),
                              done = std::move(done), alive = std::weak_ptr(alive_),
                              keep = boost::asio::make_work_guard(home_)]() mutable {
      const std::stop_callback with_the_others(all, [&] { this_job.request_stop(); });
      boost::asio::post(home, [alive = std::move(alive), done = std::move(done),
                               result = result_of(job, this_job.get_token())]() mutable {
        if (!alive.expired()) done(std::move(result));
      });
    });
    return this_job;
  }

 private:
  template <class T>
  struct MayFail : std::false_type {};
  template <class T>
  struct MayFail<Result<T>> : std::true_type {};

  template <class Job>
  static auto result_of(Job& job, std::stop_token stop) {
    using Returned = decltype(job(stop));
    if constexpr (MayFail<Returned>::value) {
      try {
        return job(std::move(stop));
      } catch (const std::exception& error) {
        return Returned(fail(ErrorCode::internal, std::string("the computation broke off: ") + error.what(),
                             "keep the run file and report it; what was measured is in it"));
      }
    } else {
      return job(std::move(stop));
    }
  }

  boost::asio::io_context& home_;
  std::stop_source stop_;
  std::shared_ptr<bool> alive_ = std::make_shared<bool>(true);
  boost::asio::thread_pool pool_{1};
};

}  // namespace mgtd::daemon::store
