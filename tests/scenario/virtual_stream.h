// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "daemon/acquire/instruments.h"
#include "daemon/acquire/live_pipeline.h"
#include "drivers/link_life.h"
#include "proto/journal_note.h"
#include "proto/raw_log.h"
#include "proto/ring_record.h"
#include "proto/stream_codec.h"
#include "proto/tensor_encoder.h"
#include "proto/units.h"
#include "tests/rig/bench_rig.h"
#include "tests/rig/config_text.h"
#include "tests/scenario/virtual_time.h"

/// The daemon's way from the wires to the stream in virtual time, without a run: simulated instruments byte
/// by byte, the real drivers and link lives, the pipeline, and everything that the daemon would record.
namespace mgtd::test {

using namespace mgtd::daemon;

/// What a perfect calibration of this rig would be.
inline std::shared_ptr<const calib::Calibration> perfect_calibration(const rig::Scenario& scenario) {
  calib::Calibration c;
  for (std::size_t i = 0; i < kSensors; ++i) {
    const rig::SensorTruth& s = scenario.truth.at(i);
    calib::ParameterVector p;
    p << to_rad(s.theta_deg), to_rad(s.phi_deg), to_rad(s.psi_deg), s.scale, s.offset_nT, to_rad(s.alpha_deg),
        to_rad(s.beta_deg), to_rad(s.gamma_deg);
    c.sensors.at(i) = calib::SensorModel::from_parameters(p);
  }
  c.sample_noise_nT.setConstant(0.3);
  c.covariance.diagonal().setConstant(1e-10);
  c.reference.t_utc = "2026-11-21T10:00:00.000000Z";
  c.accepted_by_checks = true;
  c.seal();
  return std::make_shared<const calib::Calibration>(std::move(c));
}

class VirtualStream {
 public:
  /// `step_s`: how often bytes are handed over; the time is told every fourth step.
  explicit VirtualStream(const rig::Scenario& scenario, double step_s = 0.005)
      : rig(scenario, kSwitchedOn_utc_s),
        text_(rig::config_text(scenario, "/dev", "/nowhere", 1, "127.0.0.1:0")),
        step_s_(step_s) {}

  rig::BenchRig rig;
  std::function<void(const RingRecord&)> on_line = [](const RingRecord&) {};
  std::function<void(const RawRecord&)> on_raw = [](const RawRecord&) {};
  /// What the daemon would log: device, words.
  std::function<void(const std::string&, const std::string&)> on_word = [](const auto&, const auto&) {};
  double t_s{0};
  double wall_step_s{0};  ///< by which the host's clock was set since the beginning

  [[nodiscard]] Stamp now() const { return stamp_at(t_s, wall_step_s); }
  [[nodiscard]] const Config& config() const { return config_; }
  [[nodiscard]] std::uint64_t next_seq() const { return pipeline_->sampler().next_seq(); }
  [[nodiscard]] const LivePipeline& pipeline() const { return *pipeline_; }
  [[nodiscard]] const LinkHealth& health(std::size_t port) const { return ports_.at(port).device->health(); }

  /// The daemon starts; a life before ends as by a kill, the instruments go on as they were.
  void start(std::uint64_t first_seq = 0, const std::optional<Gap>& before = {}) {
    config_ = parse_config(text_, "virtual.toml").value();
    ports_.clear();
    for (const DeviceConfig* device : devices_of(config_)) {
      if (device != nullptr) ports_.push_back({device->name, device->device});
    }
    SamplerConfig sampler = sampler_config(config_);
    sampler.first_seq = first_seq;
    pipeline_.emplace(sampler, config_.baseline_m, inputs_of(config_));
    calibrating_ = wants_calibrating_ = false;
    note(LifeNote{"test", text_, first_seq, before});
    if (before) say(*before);
    next_tick_s_ = t_s;
  }
  void use(const std::shared_ptr<const calib::Calibration>& calibration) {
    note(CalibrationNote{calibration ? calib::to_json_text(*calibration) : std::string()});
    pipeline_->use(calibration);
  }
  void set_calibrating(bool on) { wants_calibrating_ = on; }
  void order(const TableOrder& order) {
    note(order);
    carry_out(order, static_cast<drivers::Turntable&>(*ports_[kSensors].device));
  }
  void fault(const std::string& line) {
    const auto parsed = rig::parse_fault(line);
    ASSERT_TRUE(parsed) << parsed.error();
    ASSERT_TRUE(rig.apply(*parsed, t_s));
  }
  void run(double seconds) {
    for (const double end_s = t_s + seconds; t_s < end_s;) step();
  }

 private:
  struct Port {
    std::string name;
    std::shared_ptr<drivers::Device> device;
    drivers::LinkLife life{};
    bool open{false}, answered{false};
    double reopen_at_s{0};
    LinkState told{LinkState::absent};
  };

  void step() {
    t_s += step_s_;
    rig.run_script(t_s);
    for (std::size_t i = 0; i < ports_.size(); ++i) exchange(i);
    if (t_s < next_tick_s_) return;
    next_tick_s_ = t_s + 4 * step_s_;
    for (std::size_t i = 0; i < ports_.size(); ++i) {
      if (!ports_[i].open) continue;
      raw(i, RawDirection::tick);
      ports_[i].device->on_tick(now());
      talk(i);
    }
    raw(kRawDaemon, RawDirection::tick);
    pipeline_->advance(now().mono);
    deliver();
  }
  void exchange(std::size_t i) {
    Port& port = ports_[i];
    if (port.open && (!rig.plugged(i) || port.device->wants_reopen())) close(i);
    if (!port.open && t_s >= port.reopen_at_s) {
      if (!rig.plugged(i)) {
        port.life.refused({ErrorCode::unreachable, "there is no such port", ""});
        port.reopen_at_s = t_s + to_seconds(port.life.next_wait());
        return rig.drop(i, t_s);
      }
      port.open = true;
      port.life.opened();
      raw(i, RawDirection::opened);
      port.device->on_open(now());
      talk(i);
    }
    if (!port.open) return rig.drop(i, t_s);
    talk(i);
    const std::string bytes = rig.read(i, t_s);
    if (bytes.empty()) return;
    raw(i, RawDirection::received, bytes);
    port.device->on_bytes(std::as_bytes(std::span(bytes)), now());
    talk(i);
  }
  void close(std::size_t i) {
    Port& port = ports_[i];
    port.open = false;
    port.life.lost("the port is gone");
    port.reopen_at_s = t_s + to_seconds(port.life.next_wait());
    raw(i, RawDirection::closed);
    port.device->on_close(now());
    static_cast<void>(port.device->take_output());
    talk(i);
  }
  /// What a device sends goes to the rig, what it says to the pipeline, as PortLink and Rig do it.
  void talk(std::size_t i) {
    Port& port = ports_[i];
    const std::string out = port.device->take_output();
    if (!out.empty()) {
      raw(i, RawDirection::sent, out);
      rig.write(i, out, t_s);
    }
    for (const DeviceEvent& event : port.device->take_events()) {
      port.life.heard(event);
      if (const auto* reading = std::get_if<FieldReading>(&event)) {
        pipeline_->answers(reading->slot, port.device->health().identity);
        pipeline_->push(*reading);
        deliver();
      } else if (const auto* temperature = std::get_if<TemperatureReading>(&event)) {
        pipeline_->push(*temperature);
      } else if (const auto* table = std::get_if<TableReading>(&event)) {
        pipeline_->push(*table);
      } else if (const auto* auxiliary = std::get_if<AuxiliaryReading>(&event)) {
        pipeline_->push(*auxiliary);
      } else if (const auto* fault = std::get_if<DeviceFault>(&event)) {
        on_word(port.name, fault->what);
      }
    }
    watch(i);
  }
  void watch(std::size_t i) {
    Port& port = ports_[i];
    EXPECT_TRUE(port.device->health().balanced()) << port.name;
    const LinkHealth shown = port.life.shown(port.device->health());
    if (shown.state == port.told) return;
    port.told = shown.state;
    on_word(port.name, shown.detail);
    if (shown.state == LinkState::live) port.life.live();
    if (answers(shown.state) == port.answered) return;
    port.answered = answers(shown.state);
    if (!port.answered || i >= kSensors) return;
    note(ReopenedNote{static_cast<int>(i)});
    pipeline_->reopened(static_cast<int>(i));
  }
  void raw(std::size_t device, RawDirection direction, std::string_view bytes = {}) {
    if (wants_calibrating_ != calibrating_) {
      calibrating_ = wants_calibrating_;
      pipeline_->set_calibrating(calibrating_);
      note(CalibratingNote{calibrating_});
    }
    on_raw({static_cast<std::uint8_t>(device), direction, now(), bytes});
  }
  void note(const JournalNote& note) {
    const std::string text = encode(note);
    on_raw({kRawDaemon, RawDirection::note, now(), text});
  }
  void deliver() {
    pipeline_->deliver(
        [this](const Epoch&, const TensorSample& sample, bool) {
          on_line({RingRecord::Kind::sample, sample.seq, sample.seq, sample.t,
                   encoder_.encode(sample, pipeline_->inputs().values())});
        },
        [this](const Gap& gap) { say(gap); });
  }
  void say(const Gap& gap) {
    const std::string line = encode(gap);
    on_line({RingRecord::Kind::gap, gap.from_seq, gap.to_seq, gap.at, line});
  }

  std::string text_;
  double step_s_;
  Config config_;
  std::vector<Port> ports_;
  std::optional<LivePipeline> pipeline_;
  TensorEncoder encoder_;
  bool calibrating_{false}, wants_calibrating_{false};
  double next_tick_s_{0};
};

}  // namespace mgtd::test
