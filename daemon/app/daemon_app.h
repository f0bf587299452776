// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include <boost/asio/io_context.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "daemon/acquire/instruments.h"
#include "daemon/acquire/live_pipeline.h"
#include "daemon/app/log.h"
#include "daemon/app/watchdog_feed.h"
#include "daemon/config/config.h"
#include "daemon/run/run_executor.h"
#include "daemon/run/wiring_probe.h"
#include "daemon/serve/control_server.h"
#include "daemon/serve/stream_server.h"
#include "daemon/store/calibration_store.h"
#include "daemon/store/disk_ring.h"
#include "daemon/store/disk_sync.h"
#include "daemon/store/journal.h"
#include "daemon/store/worker.h"
#include "drivers/patient_timer.h"

/// The whole daemon, put together: instruments -> sampler -> tensor -> stream, and beside it the run and the
/// operator's commands.
///
/// Order of starting: store, sockets, ports. Order of stopping: run (table stops), ports, sockets, worker,
/// journal. Everything is on the one thread of the io_context but the solver.
namespace mgtd::daemon {

class DaemonApp {
 public:
  DaemonApp(boost::asio::io_context& io, Config config, CalibrationStore store);
  ~DaemonApp();
  DaemonApp(const DaemonApp&) = delete;
  DaemonApp& operator=(const DaemonApp&) = delete;

  [[nodiscard]] Result<void> start();
  void stop();

 private:
  void on_event(const std::string& device, const DeviceEvent& event);
  void on_link(const std::string& device, const LinkHealth& health);
  void on_raw(const RawRecord& record);
  void note(const JournalNote& note, Stamp at);
  void deliver();
  void publish(const Epoch& epoch, const TensorSample& sample);
  void tick();
  void every_second(Stamp now);
  void use_active_calibration();
  void tell_left_out();
  void tell_identity();
  void tell_criticism();
  void settle_calibrating(Stamp at);
  void watch_links(Stamp now);
  void follow_magnet_test(Instant now, const Epoch* epoch);
  void tell_drops(const StatusReport& status, Instant at);
  void tell_clocks(const StatusReport& status, Instant at);
  void start_recording();
  void start_disk_ring(LifeNote& life);
  void record(Stamp now);
  void watch_recording(Journal& journal, const std::string& what, Instant now);
  void guard_reserve();

  [[nodiscard]] Result<nlohmann::ordered_json> answer(const ControlRequest& request);
  [[nodiscard]] Result<nlohmann::ordered_json> answer_run(const ControlRequest& request);
  [[nodiscard]] Result<nlohmann::ordered_json> answer_magnet(const ControlRequest& request);
  [[nodiscard]] Result<nlohmann::ordered_json> abort_magnet(Stamp now);
  [[nodiscard]] Result<nlohmann::ordered_json> answer_calibrations(const ControlRequest& request);
  [[nodiscard]] Result<nlohmann::ordered_json> import_calibration(const ControlRequest& request);
  [[nodiscard]] Result<nlohmann::ordered_json> dry_run(const RunRequest& request) const;
  [[nodiscard]] StatusReport report() const;

  boost::asio::io_context& io_;
  Config config_;
  drivers::Clock clock_;
  CalibrationStore store_;
  Worker worker_;
  Instruments instruments_;
  LivePipeline pipeline_;
  std::optional<DiskRing> disk_ring_;
  StreamServer stream_;
  ControlServer control_;
  RunExecutor run_;
  std::optional<Journal> journal_;
  DiskSync disk_sync_;
  drivers::PatientTimer timer_;
  QuietLog quiet_;

  std::optional<WiringProbe> magnet_;  ///< under way, or the last
  std::vector<calib::LeftOutEffect> told_left_out_;
  std::string told_identity_, readings_said_;
  Stamp started_;
  std::optional<double> last_skew_s_;
  std::uint64_t published_{0};
  std::uint64_t epochs_at_second_{0};
  std::optional<double> rate_hz_;
  std::map<std::string, LinkState> link_states_;
  std::map<std::string, bool> told_clocks_;  ///< wrong rates, as far as the log knows
  std::uint64_t told_drops_{0};              ///< clients that were disconnected, as far as the log knows
  std::optional<Instant> last_second_;
  std::optional<WatchdogFeed> watchdog_;
  bool stopping_{false}, calibrating_{false};
};

}  // namespace mgtd::daemon
