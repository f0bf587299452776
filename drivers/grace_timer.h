// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>

#include "proto/time.h"

/// A GraceTimer fires late rather than blame a device whose bytes are still waiting to be read. A program
/// that slept (a busy host, a stopped virtual machine, a slow disk) finds bytes waiting that came meanwhile;
/// it must read them before it calls a device silent. So when this timer fires late, it waits once more for a
/// moment, and the readings go first.
namespace mgtd::drivers {

class GraceTimer {
 public:
  explicit GraceTimer(boost::asio::io_context& io) : timer_(io) {}

  /// Calls `then()` after `period` of host time, on the io_context; not at all when cancelled.
  template <class Then>
  void wait(Duration period, Then then) {
    const Instant due = std::chrono::steady_clock::now() + period;
    timer_.expires_after(period);
    timer_.async_wait([this, due, then = std::move(then)](auto ec) mutable {
      if (ec) return;
      if (std::chrono::steady_clock::now() - due < kLate) return then();
      timer_.expires_after(kMoment);
      timer_.async_wait([then = std::move(then)](auto again) mutable {
        if (!again) then();
      });
    });
  }
  void cancel() { timer_.cancel(); }

 private:
  static constexpr Duration kLate = std::chrono::milliseconds(10);
  static constexpr Duration kMoment = std::chrono::milliseconds(2);
  boost::asio::steady_timer timer_;
};

}  // namespace mgtd::drivers
