// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "proto/ring_record.h"
#include "proto/stream_codec.h"
#include "proto/tensor_encoder.h"
#include "tests/scenario/perfect_calibration.h"
#include "tests/scenario/virtual_core.h"

/// The daemon's way from the wires to the lines of the stream in virtual time, without a run, and everything
/// that the daemon would record.
namespace mgtd::test {

class VirtualStream : public VirtualCore {
 public:
  explicit VirtualStream(const rig::Scenario& scenario, double step_s = 0.005)
      : VirtualCore(scenario, step_s),
        text_(rig::config_text(scenario, "/dev", "/nowhere", 1, "127.0.0.1:0")) {}

  std::function<void(const RingRecord&)> on_line = [](const RingRecord&) {};
  std::function<void(const RawRecord&)> on_raw = [](const RawRecord&) {};
  /// What the daemon would log: topic, words.
  std::function<void(const std::string&, const std::string&)> on_word = [](const auto&, const auto&) {};

  using VirtualCore::config;
  [[nodiscard]] std::uint64_t next_seq() const { return pipeline().sampler().next_seq(); }
  [[nodiscard]] const daemon::acquire::LivePipeline& pipeline() const { return core().pipeline(); }

  /// The daemon starts; a life before ends as by a kill, the instruments go on as they were.
  void start(std::uint64_t first_seq = 0, const std::optional<Gap>& before = {}) {
    start_program(text_, first_seq, before);
    if (before) publish(*before);
  }
  void use(std::shared_ptr<const calib::calibration::Calibration> calibration) {
    core().use(std::move(calibration), now());
  }
  /// As long as the operator goes round with a magnet, the samples say that the rig is being calibrated.
  void begin_probe() { ASSERT_TRUE(try_probe()); }
  [[nodiscard]] Result<void> try_probe() { return core().begin_probe(now()); }
  void stop_probe() { core().stop_probe(); }
  void order(const TableOrder& order) { core().order(order, now()); }
  void run(double seconds) {
    for (const double end_s = t_s + seconds; t_s < end_s;) step();
  }

 private:
  void record(const RawRecord& record) override { on_raw(record); }
  void publish(const Epoch&, const TensorSample& sample, std::span<const InputValue> inputs) override {
    on_line({RingRecord::Kind::sample, sample.seq, sample.seq, sample.t, encoder_.encode(sample, inputs)});
  }
  void publish(const Gap& gap) override {
    const std::string line = encode(gap);
    on_line({RingRecord::Kind::gap, gap.from_seq, gap.to_seq, gap.at, line});
  }
  void carry_out(const daemon::run::Action&, Stamp) override {}
  void say(const daemon::core::Remark& remark, Instant) override { on_word(remark.topic, remark.text); }

  std::string text_;
  TensorEncoder encoder_;
};

}  // namespace mgtd::test
