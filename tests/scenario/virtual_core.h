// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/config/config.h"
#include "daemon/core/daemon_core.h"
#include "tests/rig/bench_rig.h"
#include "tests/rig/config_text.h"
#include "tests/scenario/virtual_time.h"

/// The core of the daemon on simulated instruments, in virtual time and in one thread. Bytes are carried
/// between the cables of the rig and the links of the core every step; the time is a number. What the core
/// asks for beyond bytes to its ports, the virtual daemons do.
namespace mgtd::test {

using namespace mgtd::daemon;

class VirtualCore : protected daemon::core::CoreActions {
 public:
  rig::BenchRig rig;
  std::function<void()> on_step = [] {};
  double t_s{0};
  double wall_step_s{0};  ///< by which the host's clock was set since the beginning

  [[nodiscard]] Stamp now() const { return stamp_at(t_s, wall_step_s); }
  [[nodiscard]] drivers::Turntable& table() { return core_->instruments().table(); }
  /// What the device says of itself, and what an operator sees of it.
  [[nodiscard]] const LinkHealth& health(std::size_t port) const { return link(port).device().health(); }
  [[nodiscard]] LinkHealth shown(std::size_t port) const { return link(port).health(); }
  [[nodiscard]] bool all_live() const {
    for (std::size_t i = 0; i < ports_.size(); ++i) {
      if (health(i).state != LinkState::live) return false;
    }
    return true;
  }
  /// The program stands still, as a busy host makes it; what comes in meanwhile waits for it.
  void stand_still(double seconds) {
    for (const double end_s = t_s + seconds; t_s < end_s;) pass();
  }
  void fault(const std::string& line) {
    const auto parsed = rig::parse_fault(line);
    ASSERT_TRUE(parsed) << parsed.error();
    const auto applied = rig.apply(*parsed, t_s);
    ASSERT_TRUE(applied) << applied.error();
  }
  void step() {
    pass();
    for (std::size_t i = 0; i < ports_.size(); ++i) exchange(i);
    if (t_s < next_tick_s_) return;
    next_tick_s_ = t_s + kStepsOfTick * step_s_;
    for (std::size_t i = 0; i < ports_.size(); ++i) {
      if (link(i).is_open()) link(i).tick(now());
    }
    core_->tick(now());
    if (t_s < next_second_s_) return;
    next_second_s_ = t_s + 1;
    core_->every_second(now());
  }

 protected:
  /// `step_s`: how often bytes are carried; the time is told every fourth step.
  VirtualCore(const rig::Scenario& scenario, double step_s)
      : rig(scenario, kSwitchedOn_utc_s), step_s_(step_s) {}

  [[nodiscard]] const daemon::core::DaemonCore& core() const { return *core_; }
  [[nodiscard]] daemon::core::DaemonCore& core() { return *core_; }
  [[nodiscard]] const daemon::config::Config& config() const { return config_; }
  /// The program starts; one that ran before has died without a word, the instruments go on as they were.
  void start_program(const std::string& config_text, std::uint64_t first_seq = 0,
                     const std::optional<Gap>& before = {}) {
    auto config = daemon::config::parse_config(config_text, "virtual.toml");
    if (!config) throw std::invalid_argument(config.error().lines.at(0));
    core_.reset();
    config_ = *std::move(config);
    core_.emplace(config_, static_cast<daemon::core::CoreActions&>(*this));
    ports_.clear();
    for (const Slot slot : core_->instruments().slots()) ports_.push_back({slot});
    core_->begin({"test", config_text, first_seq, before}, now());
    core_->start_instruments(now());
    next_tick_s_ = t_s;
  }
  /// The instruments hear the last words of the program.
  void close_ports() {
    for (std::size_t i = 0; i < ports_.size(); ++i) {
      if (link(i).is_open()) rig.write(i, link(i).last_words(now()), t_s);
    }
  }

  void send(Slot slot, std::string_view bytes) override {
    for (std::size_t i = 0; i < ports_.size(); ++i) {
      if (ports_[i].slot == slot) rig.write(i, bytes, t_s);
    }
  }

 private:
  static constexpr int kStepsOfTick = 4;
  struct Port {
    Slot slot;
    double reopen_at_s{0};
    std::uint64_t unplugged{0}, delivered{0};
  };
  [[nodiscard]] drivers::DeviceLink& link(std::size_t port) {
    return core_->instruments().link(ports_.at(port).slot);
  }
  [[nodiscard]] const drivers::DeviceLink& link(std::size_t port) const {
    return core_->instruments().link(ports_.at(port).slot);
  }
  void pass() {
    t_s += step_s_;
    on_step();
    rig.run_script(t_s);
  }
  /// As drivers::PortLink does it on a serial port.
  void exchange(std::size_t i) {
    Port& port = ports_[i];
    drivers::DeviceLink& its_link = link(i);
    const bool gone = !rig.plugged(i) || rig.unplugged(i) != port.unplugged;
    if (its_link.is_open() && (gone || its_link.wants_reopen())) {
      its_link.lost("the port is gone", now());
      port.reopen_at_s = t_s + to_seconds(its_link.next_wait());
    }
    if (!its_link.is_open() && t_s >= port.reopen_at_s) try_open(i);
    if (!its_link.is_open()) return rig.drop(i, t_s);
    const std::string bytes = rig.read(i, t_s);
    port.delivered += bytes.size();
    if (!bytes.empty()) its_link.received(std::as_bytes(std::span(bytes)), now());
    EXPECT_TRUE(health(i).balanced()) << port.slot.name();
    EXPECT_EQ(health(i).bytes_in, port.delivered) << port.slot.name();
  }
  void try_open(std::size_t i) {
    Port& port = ports_[i];
    port.unplugged = rig.unplugged(i);
    if (rig.plugged(i)) return link(i).opened(now());
    link(i).refused({ErrorCode::unreachable, "there is no such port", ""}, now());
    port.reopen_at_s = t_s + to_seconds(link(i).next_wait());
  }

  double step_s_;
  daemon::config::Config config_;
  std::optional<daemon::core::DaemonCore> core_;
  std::vector<Port> ports_;
  double next_tick_s_{0}, next_second_s_{0};
};

}  // namespace mgtd::test
