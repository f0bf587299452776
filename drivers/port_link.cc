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
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <optional>
#include <utility>

#include "drivers/link_life.h"
#include "drivers/patient_timer.h"
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
  Impl(asio::io_context& io, const Clock& clock, PortSettings settings, std::shared_ptr<Device> device,
       PortCallbacks callbacks)
      : clock_(clock),
        settings_(std::move(settings)),
        device_(std::move(device)),
        callbacks_(std::move(callbacks)),
        stream_(io),
        tick_timer_(io),
        open_timer_(io) {
    if (settings_.baud == 0) settings_.baud = device_->baud();
  }

  void start() {
    try_open();
    tick();
  }
  void deliver();
  void flush();
  void shutdown();

  [[nodiscard]] Device& device() { return *device_; }
  [[nodiscard]] LinkHealth health() const;
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
  bool send_output();
  void tell_raw(Direction direction, std::span<const std::byte> bytes, Stamp at) const {
    if (callbacks_.on_raw) callbacks_.on_raw(direction, bytes, at);
  }
  [[nodiscard]] Stamp tell_now(Direction what) const {
    const Stamp now = clock_.now();
    tell_raw(what, {}, now);
    return now;
  }
  void report_state();

  const Clock& clock_;
  PortSettings settings_;
  std::shared_ptr<Device> device_;
  PortCallbacks callbacks_;

  std::optional<SerialPort> port_;  ///< owns the descriptor that stream_ borrows
  asio::posix::stream_descriptor stream_;
  PatientTimer tick_timer_;
  asio::steady_timer open_timer_;
  LinkLife life_;
  std::array<std::byte, 4096> in_{};
  std::string out_, in_flight_;
  std::uint64_t generation_{0};  ///< of the open port: completions of an earlier one are stale
  bool delivering_{false};
  bool ended_{false};
  LinkState told_state_{LinkState::absent};
  std::string told_detail_;
};

LinkHealth PortLink::Impl::health() const { return life_.shown(device_->health()); }

void PortLink::Impl::report_state() {
  const LinkHealth now = health();
  if (now.state == told_state_ && now.detail == told_detail_) return;
  told_state_ = now.state;
  told_detail_ = now.detail;
  if (callbacks_.on_state) callbacks_.on_state(now);
}

void PortLink::Impl::try_open() {
  if (ended_) return;
  auto port = SerialPort::open(settings_.path, settings_.baud);
  if (!port) {
    life_.refused(port.error());
    report_state();
    open_later();
    return;
  }
  port_.emplace(std::move(*port));
  ++generation_;
  life_.opened();
  stream_.assign(port_->fd());
  device_->on_open(tell_now(Direction::opened));
  read();
  deliver();
}

void PortLink::Impl::open_later() {
  open_timer_.expires_after(life_.next_wait());
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
  life_.lost(why);
  close_port();
  device_->on_close(tell_now(Direction::closed));
  static_cast<void>(device_->take_output());
  report_state();  // first that the device is lost, then what it says about it
  deliver();
  open_later();
}

void PortLink::Impl::tick() {
  if (ended_) return;
  tick_timer_.wait(std::clamp(clock_.host(kTick), kShortestTick, kTick), [self = shared_from_this()] {
    if (self->ended_) return;
    if (self->port_) {
      self->device_->on_tick(self->tell_now(Direction::tick));
      self->deliver();
      if (self->device_->health().state == LinkState::live) self->life_.live();
      if (self->port_ && self->device_->wants_reopen())
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
        const Stamp now = self->clock_.now();
        if (ec || n == 0) {
          self->lost(fmt::format("{}: the port is gone ({}); it is opened again when it is back",
                                 self->settings_.path, ec.message()));
          return;
        }
        const std::span<const std::byte> bytes(self->in_.data(), n);
        self->tell_raw(Direction::in, bytes, now);
        self->device_->on_bytes(bytes, now);
        self->deliver();
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

/// False when the device had nothing to send.
bool PortLink::Impl::send_output() {
  const std::string bytes = device_->take_output();
  if (bytes.empty() || !port_) return false;
  tell_raw(Direction::out, std::as_bytes(std::span(bytes.data(), bytes.size())), clock_.now());
  out_ += bytes;
  write();
  return true;
}

void PortLink::Impl::deliver() {
  if (std::exchange(delivering_, true)) return;  // a callback asked: the loop below goes on
  for (bool more = true; more;) {
    const bool sent = send_output();
    std::vector<DeviceEvent> events = device_->take_events();
    if (!answers(health().state)) report_state();
    more = sent || !events.empty();
    for (const DeviceEvent& event : events) life_.heard(event);
    if (!events.empty() && callbacks_.on_events) callbacks_.on_events(std::move(events));
  }
  delivering_ = false;
  report_state();
}

void PortLink::Impl::flush() {
  if (ended_) return;
  send_output();
  asio::post(stream_.get_executor(), [self = shared_from_this()] {
    if (!self->ended_) self->deliver();
  });
}

/// Blocking, but for no longer than kLastWords_ms: there is no event loop left to wait in.
void PortLink::Impl::send_last_words() {
  device_->on_shutdown(tell_now(Direction::ended));
  const std::string words = device_->take_output();
  if (!words.empty())
    tell_raw(Direction::out, std::as_bytes(std::span(words.data(), words.size())), clock_.now());
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
  life_.ended();
  port_.reset();
  device_->on_close(tell_now(Direction::closed));
}

PortLink::PortLink(asio::io_context& io, const Clock& clock, PortSettings settings,
                   std::shared_ptr<Device> device, PortCallbacks callbacks)
    : impl_(std::make_shared<Impl>(io, clock, std::move(settings), std::move(device), std::move(callbacks))) {
}

PortLink::~PortLink() { impl_->shutdown(); }

void PortLink::start() { impl_->start(); }
void PortLink::flush() { impl_->flush(); }
void PortLink::shutdown() { impl_->shutdown(); }
Device& PortLink::device() { return impl_->device(); }
LinkHealth PortLink::health() const { return impl_->health(); }
std::string PortLink::latency() const { return impl_->latency(); }

}  // namespace mgtd::drivers
