// SPDX-License-Identifier: Apache-2.0
#include "drivers/port_link.h"

#include <fmt/format.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <boost/asio/buffer.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <optional>
#include <utility>

#include "drivers/grace_timer.h"
#include "drivers/serial_port.h"

namespace mgtd::drivers {
namespace {

namespace asio = boost::asio;
using boost::system::error_code;
using std::chrono::milliseconds;

constexpr Duration kTick = milliseconds(20);
constexpr Duration kShortestTick = milliseconds(4);  ///< of host time, when the clock runs fast
constexpr int kLastWords_ms = 200;

}  // namespace

class PortLink::Impl : public std::enable_shared_from_this<Impl> {
 public:
  Impl(asio::io_context& io, const Clock& clock, PortSettings settings, DeviceLink& link)
      : clock_(clock),
        settings_(std::move(settings)),
        link_(link),
        stream_(io),
        tick_timer_(io),
        open_timer_(io) {
    if (settings_.baud == 0) settings_.baud = link_.device().baud();
  }

  void start() {
    try_open();
    tick();
  }
  void send(std::string_view bytes);
  void shutdown();

  [[nodiscard]] std::string latency() const { return port_ ? port_->latency() : std::string(); }

 private:
  void try_open();
  void open_later();
  void lost(const std::string& why);
  void close_port();
  void tick();
  void read();
  void write();
  void send_last_words();

  const Clock& clock_;
  PortSettings settings_;
  DeviceLink& link_;

  std::optional<SerialPort> port_;  ///< owns the descriptor that stream_ borrows
  asio::posix::stream_descriptor stream_;
  GraceTimer tick_timer_;
  asio::steady_timer open_timer_;
  std::array<std::byte, 4096> in_{};
  std::string out_, in_flight_;
  std::uint64_t generation_{0};  ///< of the open port: completions of an earlier one are stale
  bool ended_{false};
};

void PortLink::Impl::try_open() {
  if (ended_) return;
  auto port = SerialPort::open(settings_.path, settings_.baud);
  if (!port) {
    link_.refused(port.error(), clock_.now());
    open_later();
    return;
  }
  port_.emplace(std::move(*port));
  ++generation_;
  stream_.assign(port_->fd());
  link_.opened(clock_.now());
  read();
}

void PortLink::Impl::open_later() {
  open_timer_.expires_after(link_.next_wait());
  open_timer_.async_wait([self = shared_from_this()](error_code ec) {
    if (!ec) self->try_open();
  });
}

void PortLink::Impl::close_port() {
  stream_.release();  // cancels, and leaves the descriptor to its owner
  port_.reset();
  out_.clear();
  in_flight_.clear();
}

void PortLink::Impl::lost(const std::string& why) {
  close_port();
  link_.lost(why, clock_.now());
  open_later();
}

void PortLink::Impl::tick() {
  if (ended_) return;
  tick_timer_.wait(std::clamp(clock_.host(kTick), kShortestTick, kTick), [self = shared_from_this()] {
    if (self->ended_) return;
    if (self->port_) {
      self->link_.tick(self->clock_.now());
      if (self->port_ && self->link_.wants_reopen())
        self->lost(
            fmt::format("{}: the device does not answer; opening the port again", self->settings_.path));
    }
    self->tick();
  });
}

void PortLink::Impl::read() {
  stream_.async_read_some(
      asio::buffer(in_), [self = shared_from_this(), generation = generation_](error_code ec, std::size_t n) {
        if (self->ended_ || generation != self->generation_ || !self->port_) return;
        if (ec || n == 0) {
          self->lost(fmt::format("{}: the port is gone ({}); it is opened again when it is back",
                                 self->settings_.path, ec.message()));
          return;
        }
        self->link_.received({self->in_.data(), n}, self->clock_.now());
        if (self->port_ && generation == self->generation_) self->read();
      });
}

void PortLink::Impl::write() {
  if (!in_flight_.empty() || out_.empty() || !port_) return;
  in_flight_ = std::exchange(out_, {});
  asio::async_write(stream_, asio::buffer(in_flight_),
                    [self = shared_from_this(), generation = generation_](error_code ec, std::size_t) {
                      if (self->ended_ || generation != self->generation_ || !self->port_) return;
                      if (ec) {
                        self->lost(fmt::format("{}: the port is gone while sending ({})",
                                               self->settings_.path, ec.message()));
                        return;
                      }
                      self->in_flight_.clear();
                      self->write();
                    });
}

void PortLink::Impl::send(std::string_view bytes) {
  if (!port_) return;
  out_ += bytes;
  write();
}

/// Blocking, but for no longer than kLastWords_ms: there is no event loop left to wait in.
void PortLink::Impl::send_last_words() {
  const std::string words = link_.last_words(clock_.now());
  std::string_view rest = words;
  const int fd = port_->fd();
  stream_.release();
  while (!rest.empty()) {
    pollfd ready{fd, POLLOUT, 0};
    if (::poll(&ready, 1, kLastWords_ms) <= 0) return;
    const ssize_t n = ::write(fd, rest.data(), rest.size());
    if (n <= 0) return;
    rest.remove_prefix(static_cast<std::size_t>(n));
  }
}

void PortLink::Impl::shutdown() {
  if (std::exchange(ended_, true)) return;
  tick_timer_.cancel();
  open_timer_.cancel();
  if (!port_) return;
  send_last_words();
  port_.reset();
  link_.closed(clock_.now());
}

PortLink::PortLink(asio::io_context& io, const Clock& clock, PortSettings settings, DeviceLink& link)
    : impl_(std::make_shared<Impl>(io, clock, std::move(settings), link)) {}

PortLink::~PortLink() { impl_->shutdown(); }

void PortLink::start() { impl_->start(); }
void PortLink::send(std::string_view bytes) { impl_->send(bytes); }
void PortLink::shutdown() { impl_->shutdown(); }
std::string PortLink::latency() const { return impl_->latency(); }

}  // namespace mgtd::drivers
