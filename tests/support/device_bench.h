// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <cstddef>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "drivers/device.h"

/// A DeviceBench feeds a Device by hand, in virtual time. `answer` plays the instrument's side of the wire:
/// it gets what the device sent and returns what comes back.
namespace mgtd::testing {

class DeviceBench {
 public:
  using Answer = std::function<std::string(std::string_view sent)>;

  explicit DeviceBench(drivers::Device& device, Answer answer = {})
      : device_(device), answer_(std::move(answer)) {}

  void open() {
    device_.on_open(now());
    exchange();
  }
  void close() {
    device_.on_close(now());
    exchange();
  }
  void feed(std::string_view bytes) {
    device_.on_bytes(std::as_bytes(std::span(bytes.data(), bytes.size())), now());
    exchange();
  }
  /// Lets time pass in ticks of 20 ms.
  void pass(double seconds) {
    for (double t = 0; t < seconds - 1e-9; t += 0.02) tick();
  }
  void tick() {
    t_s_ += 0.02;
    device_.on_tick(now());
    exchange();
  }
  /// Ticks until the condition holds; false when `limit_s` of virtual time was not enough.
  [[nodiscard]] bool pass_until(const std::function<bool()>& condition, double limit_s = 60) {
    for (double end = t_s_ + limit_s; t_s_ < end; tick()) {
      if (condition()) return true;
    }
    return condition();
  }
  /// Carries what the device sent to the instrument and its answers back, until both are quiet.
  void exchange() {
    for (std::string out = device_.take_output(); !out.empty(); out = device_.take_output()) {
      sent_ += out;
      const std::string reply = answer_ ? answer_(out) : std::string();
      if (!reply.empty()) device_.on_bytes(std::as_bytes(std::span(reply.data(), reply.size())), now());
    }
    for (DeviceEvent& event : device_.take_events()) events_.push_back(std::move(event));
  }

  [[nodiscard]] Stamp now() const {
    return {Instant(from_seconds(t_s_)), WallTime{1'600'000'000'000'000'000 + from_seconds(t_s_).count()}};
  }
  [[nodiscard]] double t_s() const { return t_s_; }
  [[nodiscard]] const std::string& sent() const { return sent_; }
  void forget_sent() { sent_.clear(); }
  void forget_events() { events_.clear(); }
  template <class Event>
  [[nodiscard]] std::vector<Event> events() const {
    std::vector<Event> out;
    for (const DeviceEvent& event : events_) {
      if (const auto* e = std::get_if<Event>(&event)) out.push_back(*e);
    }
    return out;
  }

 private:
  drivers::Device& device_;
  Answer answer_;
  double t_s_{1000};
  std::string sent_;
  std::vector<DeviceEvent> events_;
};

}  // namespace mgtd::testing
