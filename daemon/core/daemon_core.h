// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "daemon/acquire/instruments.h"
#include "daemon/acquire/live_pipeline.h"
#include "daemon/config/config.h"
#include "daemon/core/core_actions.h"
#include "daemon/run/current_run.h"
#include "daemon/run/wiring_probe.h"
#include "proto/journal_note.h"

/// DaemonCore is the daemon put together, without any input or output of its own: instruments -> sampler ->
/// tensor -> stream, and beside it the run and the wiring probe. What happens comes in with its time: at the
/// ports through the links of instruments(), the rest through the calls below. What is to be done goes to
/// CoreActions, in the order in which it is decided. The same calls with the same times give the same
/// actions.
///
/// Does not know files, sockets, threads or a clock, and keeps no run file: whoever carries out the run's
/// actions does.
namespace mgtd::daemon::core {

class DaemonCore {
 public:
  /// Both outlive this. The devices of a configuration serve one core.
  DaemonCore(const config::Config& config, CoreActions& actions);
  DaemonCore(const DaemonCore&) = delete;
  DaemonCore& operator=(const DaemonCore&) = delete;

  /// The first of all calls: from where the stream is numbered.
  void begin(const LifeNote& life, Stamp now);
  /// Opens instruments that have no port. The others are opened through their links.
  void start_instruments(Stamp now) { instruments_.start(now); }
  /// From the next epoch on; null: the samples are raw and say so.
  void use(std::shared_ptr<const calib::calibration::Calibration> calibration, Stamp now);
  /// Every 20-50 ms.
  void tick(Stamp now);
  /// Every second of the host's time.
  void every_second(Stamp now);
  /// Tells the run how every link is doing; without an active run nothing happens.
  void show_links(Stamp now);

  /// Asks the table and sends what it says to that.
  void order(const TableOrder& order, Stamp now);
  /// The daemon ends: the table of a run stops.
  void abandon_run(Stamp now);

  /// Refused while a probe or a run is going on, or a sensor is not live.
  [[nodiscard]] Result<void> begin_probe(Stamp now);
  /// What there was of a probe stays readable.
  void stop_probe();

  /// Writes into the journal what a replay has to know beside the wires.
  void note(const JournalNote& note, Stamp at);

  [[nodiscard]] acquire::Instruments& instruments() { return instruments_; }
  [[nodiscard]] const acquire::Instruments& instruments() const { return instruments_; }
  [[nodiscard]] run::CurrentRun& run() { return run_; }
  [[nodiscard]] const run::CurrentRun& run() const { return run_; }
  [[nodiscard]] const acquire::LivePipeline& pipeline() const { return pipeline_; }
  /// Under way, or the last; empty: there was none.
  [[nodiscard]] const std::optional<run::WiringProbe>& probe() const { return probe_; }
  [[nodiscard]] bool probing() const { return probe_ && !probe_->ended(); }

 private:
  void on_event(Slot slot, const DeviceEvent& event, Stamp now);
  void on_link(Slot slot, const LinkHealth& health, Stamp now);
  void on_raw(const RawRecord& record);
  void came_back(Slot slot, const LinkHealth& health, Stamp now);
  void carry_out(const run::Action& action, Stamp now);
  void deliver(Stamp now);
  void settle_calibrating(Stamp at);
  void follow_probe(Instant now, const Epoch* epoch);
  void tell_criticism(Stamp now);
  void tell_left_out(Instant now);
  void tell_identity(Instant now);
  void inform(std::string topic, std::string text, Instant now) {
    actions_.say({Remark::Level::info, std::move(topic), std::move(text)}, now);
  }
  void warn(std::string topic, std::string text, Instant now) {
    actions_.say({Remark::Level::warning, std::move(topic), std::move(text)}, now);
  }

  const config::Config& config_;
  CoreActions& actions_;
  acquire::Instruments instruments_;
  acquire::LivePipeline pipeline_;
  run::CurrentRun run_;
  std::optional<run::WiringProbe> probe_;
  std::map<Slot, LinkState> link_states_;
  bool calibrating_{false};                                  ///< as the pipeline knows it
  std::string readings_say_;                                 ///< what the run was told; empty: nothing
  std::vector<calib::calibration::LeftOutEffect> left_out_;  ///< as the log knows them
  std::string identity_;                                     ///< likewise
};

}  // namespace mgtd::daemon::core
