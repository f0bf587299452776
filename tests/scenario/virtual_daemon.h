// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "daemon/acquire/calibrated_with.h"
#include "daemon/acquire/instrument_watch.h"
#include "daemon/acquire/live_pipeline.h"
#include "daemon/acquire/sampler.h"
#include "daemon/config/config.h"
#include "daemon/run/run_fsm.h"
#include "drivers/link_life.h"
#include "tests/rig/bench_rig.h"
#include "tests/rig/config_text.h"
#include "tests/scenario/virtual_time.h"

/// The whole stack in virtual time and in one thread: the simulated instruments, byte by byte through the
/// real drivers, the sampler and the run. Only ports, clock and disk are left out: bytes are handed over
/// every kStep_s, the time is a number, poses are kept in memory.
namespace mgtd::test {

using namespace mgtd::daemon;

inline constexpr double kStep_s = 0.005;
inline constexpr double kTick_s = 0.02;

class VirtualDaemon {
 public:
  /// `mistake`: what is wrong in the configuration, and what stands there instead.
  explicit VirtualDaemon(const rig::Scenario& scenario, std::pair<std::string, std::string> mistake = {})
      : rig(scenario, kSwitchedOn_utc_s),
        mistake_(std::move(mistake)),
        config_(read_config(scenario)),
        sampler_(sampler_config(config_)) {
    add_ports();
  }

  rig::BenchRig rig;
  PoseTable poses;
  std::optional<Finish> finished;
  std::optional<RunStatus> status;
  std::vector<std::string> records;
  std::vector<std::string> notes;               ///< faults and losses, as they came
  std::vector<InstrumentIdentity> instruments;  ///< of the run, as its file keeps them
  std::function<Result<Solution>(const PoseTable&)> solver = [](const PoseTable&) {
    return Solution{true, "cal", {}, {}};
  };
  std::function<void(const EpochOrGap&)> on_item = [](const EpochOrGap&) {};  ///< of the stream
  std::function<void()> on_step = [] {};
  std::uint64_t epochs{0}, gaps{0};
  double t_s{0};
  double wall_step_s{0};  ///< by which the host's clock was set since the beginning

  [[nodiscard]] Stamp now() const { return stamp_at(t_s, wall_step_s); }
  [[nodiscard]] WallTime started_utc() const { return started_utc_; }
  [[nodiscard]] drivers::Turntable& table() { return dynamic_cast<drivers::Turntable&>(*ports_[4].device); }
  [[nodiscard]] const LinkHealth& health(std::size_t port) const { return ports_.at(port).device->health(); }
  /// What an operator sees of it.
  [[nodiscard]] LinkHealth shown(std::size_t port) const {
    return ports_.at(port).life.shown(ports_.at(port).device->health());
  }
  [[nodiscard]] bool all_live() const {
    for (const Port& port : ports_) {
      if (port.device->health().state != LinkState::live) return false;
    }
    return true;
  }

  /// As the daemon makes it from its configuration.
  [[nodiscard]] RunConfig run_config() {
    RunConfig run;
    run.run_id = "virtual";
    run.limits = table().limits();
    run.preflight.rate_hz = run.settle.rate_hz = run.dwell.rate_hz = config_.rate_hz;
    run.preflight.scalar = config_.scalar.has_value();
    run.preflight.field_nT = config_.field_nT;
    return run;
  }
  void start(RunPlan plan, std::optional<RunConfig> config = std::nullopt,
             const std::optional<EarlierLife>& earlier = std::nullopt) {
    fsm_ = std::make_unique<RunFsm>(config ? *config : run_config(), std::move(plan), now(), earlier);
    if (!earlier) started_utc_ = now().wall;
    finished.reset();
    tell(Tick{});
  }
  void tell(const Event& event) {
    if (fsm_ == nullptr) return;
    for (const Action& action : fsm_->step(event, now())) {
      std::visit([this](const auto& a) { carry_out(a); }, action);
    }
  }
  /// The program ends in good order: the instruments hear its last words, the run is left as it is.
  void terminate() {
    if (fsm_ != nullptr) table().stop();
    for (std::size_t i = 0; i < ports_.size(); ++i) {
      if (!ports_[i].open) continue;
      ports_[i].device->on_shutdown(now());
      rig.write(i, ports_[i].device->take_output(), t_s);
    }
    restart();
  }
  /// The program dies without a word and is started again; the instruments go on as they were.
  void restart() {
    config_ = read_config(rig.world().scenario());
    ports_.clear();
    add_ports();
    sampler_ = Sampler(sampler_config(config_));
    fsm_.reset();
    pending_.clear();
    answers_.clear();
  }
  /// The program stands still, as a busy host makes it; what comes in meanwhile waits for it.
  void stand_still(double seconds) {
    for (const double end_s = t_s + seconds; t_s < end_s;) {
      t_s += kStep_s;
      on_step();
      rig.run_script(t_s);
    }
  }
  void fault(const std::string& line) {
    const auto parsed = rig::parse_fault(line);
    ASSERT_TRUE(parsed) << parsed.error();
    const auto applied = rig.apply(*parsed, t_s);
    ASSERT_TRUE(applied) << applied.error();
  }

  void step() {
    t_s += kStep_s;
    on_step();
    rig.run_script(t_s);
    for (std::size_t i = 0; i < ports_.size(); ++i) exchange(i);
    for (const Event& answer : std::exchange(answers_, {})) tell(answer);
    if (t_s < next_tick_s_) return;
    next_tick_s_ = t_s + kTick_s;
    for (Port& port : ports_) {
      if (port.open) port.device->on_tick(now());
    }
    sampler_.advance(now().mono, pending_);
    deliver();
    watch_links();
    tell(Tick{});
  }
  /// Until `done` or the run's end; false after limit_s.
  bool run(
      double limit_s, const std::function<bool()>& done = [] { return false; }) {
    for (const double end_s = t_s + limit_s; t_s < end_s;) {
      if (finished || done()) return true;
      step();
    }
    return finished.has_value() || done();
  }

 private:
  struct Port {
    std::string name;
    std::shared_ptr<drivers::Device> device;
    drivers::LinkLife life{};
    bool open{false}, was_live{false};
    double reopen_at_s{0};
    std::uint64_t unplugged{0}, delivered{0};
  };

  [[nodiscard]] Config read_config(const rig::Scenario& scenario) const {
    std::string text = rig::config_text(scenario, "/dev", "/nowhere", 1, "127.0.0.1:0");
    const auto& [right, wrong] = mistake_;
    for (std::size_t at = 0; !right.empty() && (at = text.find(right, at)) != std::string::npos;
         at += wrong.size())
      text.replace(at, right.size(), wrong);
    auto config = parse_config(text, "virtual.toml");
    if (!config) throw std::invalid_argument(config.error().lines.at(0));
    return *std::move(config);
  }
  void add_ports() {
    for (const DeviceConfig& sensor : config_.sensors) ports_.push_back({sensor.name, sensor.device});
    ports_.push_back({config_.table.name, config_.table.device});
    if (config_.scalar) ports_.push_back({config_.scalar->name, config_.scalar->device});
    for (const DeviceConfig& module : config_.auxiliary) ports_.push_back({module.name, module.device});
  }

  void exchange(std::size_t i) {
    Port& port = ports_[i];
    const bool gone = !rig.plugged(i) || rig.unplugged(i) != port.unplugged;
    if (port.open && (gone || port.device->wants_reopen())) close(i);
    if (!port.open && t_s >= port.reopen_at_s) try_open(i);
    if (!port.open) return;
    rig.write(i, port.device->take_output(), t_s);
    const std::string bytes = rig.read(i, t_s);
    port.delivered += bytes.size();
    if (!bytes.empty()) port.device->on_bytes(std::as_bytes(std::span(bytes)), now());
    rig.write(i, port.device->take_output(), t_s);
    take_events(i);
  }
  void close(std::size_t i) {
    Port& port = ports_[i];
    port.open = false;
    port.life.lost("the port is gone");
    port.reopen_at_s = t_s + to_seconds(port.life.next_wait());
    port.device->on_close(now());
    static_cast<void>(port.device->take_output());
    take_events(i);
  }
  void try_open(std::size_t i) {
    Port& port = ports_[i];
    port.unplugged = rig.unplugged(i);
    if (!rig.plugged(i)) {
      port.life.refused({ErrorCode::unreachable, "there is no such port", ""});
      port.reopen_at_s = t_s + to_seconds(port.life.next_wait());
      return;
    }
    port.open = true;
    port.life.opened();
    port.device->on_open(now());
  }
  /// That a device no longer answers is told before what it says about it, as PortLink does; all else after.
  void take_events(std::size_t i) {
    Port& port = ports_[i];
    if (!is_live(port)) watch_link(port);
    for (const DeviceEvent& event : port.device->take_events()) {
      port.life.heard(event);
      std::visit([&](const auto& e) { on(port, e); }, event);
    }
    deliver();
    watch_link(port);
  }
  static bool is_live(const Port& port) {
    return port.open && port.device->health().state == LinkState::live;
  }
  void on(const Port& port, const FieldReading& reading) {
    watch_.answers({port.name, port.device->health().identity});
    sampler_.push(reading, pending_);
  }
  void on(const Port&, const TemperatureReading& reading) { sampler_.push(reading); }
  void on(const Port&, const ScalarReading& reading) { tell(reading); }
  void on(const Port&, const AuxiliaryReading& reading) { tell(reading); }
  void on(const Port&, const TableReading& reading) { tell(reading); }
  void on(const Port& port, const DeviceFault& fault) {
    notes.push_back(port.name + ": " + fault.what);
    tell(DeviceFaulted{port.name, fault});
  }
  void on(const Port&, const DeviceNote&) {}
  void deliver() {
    for (EpochOrGap& item : std::exchange(pending_, {})) {
      // As the pipeline says it of the sensors of a calibration.
      if (auto* epoch = std::get_if<Epoch>(&item); epoch != nullptr && watch_.another())
        epoch->flags |= Flag::identity;
      on_item(item);
      if (const auto* gap = std::get_if<Gap>(&item)) {
        gaps += gap->to_seq - gap->from_seq + 1;
        tell(*gap);
      } else {
        ++epochs;
        tell(std::get<Epoch>(item));
      }
    }
  }

  void watch_links() {
    for (Port& port : ports_) {
      watch_link(port);
      tell(LinkSeen{port.name, port.life.shown(port.device->health())});
    }
  }
  void watch_link(Port& port) {
    const LinkHealth& health = port.device->health();
    EXPECT_TRUE(health.balanced()) << port.name;
    EXPECT_EQ(health.bytes_in, port.delivered) << port.name;
    const bool live = is_live(port);
    if (live) port.life.live();
    if (live == port.was_live) return;
    port.was_live = live;
    if (live) {
      if (port.name.size() == 2) sampler_.reopened(port.name[1] - '1');  // s1 .. s4
      tell(LinkSeen{port.name, health});
      tell(DeviceBack{port.name});
    } else {
      notes.push_back(port.name + " lost");
      tell(DeviceLost{port.name, port.life.shown(health).detail});
    }
  }

  void carry_out(const HomeTable&) { table().home(); }
  void carry_out(const MoveTable& move) { table().move_to(move.target); }
  void carry_out(const SetTable&) {}  // its table has motors
  void carry_out(const DropPoses&) {}
  void carry_out(const StopTable&) { table().stop(); }
  void carry_out(const StorePose& store) {
    poses.poses.push_back(store.pose);
    answers_.emplace_back(PoseStored{store.pose.number, {}});
  }
  void carry_out(const StartSolve&) { answers_.emplace_back(SolveDone{solver(poses)}); }
  void carry_out(const ProposeCalibration&) { answers_.emplace_back(CalibrationProposed{}); }
  void carry_out(const PublishStatus& publish) { status = publish.status; }
  void carry_out(const Record& record) { records.push_back(record.what); }
  void carry_out(const Finish& finish) { finished = finish; }
  void carry_out(const StorePath&) {}
  void carry_out(const StoreChecks& store) {
    if (store.stage != kInstrumentsStage) return;
    instruments = instruments_among(store.checks);
    watch_.want(instruments);
  }
  void carry_out(const CancelSolve&) {}

  std::pair<std::string, std::string> mistake_;
  Config config_;
  Sampler sampler_;
  InstrumentWatch watch_{kByRun};
  std::vector<Port> ports_;
  std::unique_ptr<RunFsm> fsm_;
  std::vector<EpochOrGap> pending_;
  std::vector<Event> answers_;
  double next_tick_s_{0};
  WallTime started_utc_;
};

}  // namespace mgtd::test
