// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <utility>

#include <boost/asio/io_context.hpp>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "daemon/acquire/sensor_means.h"
#include "daemon/app/calibration_history.h"
#include "daemon/app/epoch_rate.h"
#include "daemon/app/frame_rate.h"
#include "daemon/app/log.h"
#include "daemon/app/ports.h"
#include "daemon/app/recording.h"
#include "daemon/app/watchdog_feed.h"
#include "daemon/config/config.h"
#include "daemon/core/daemon_core.h"
#include "daemon/run/run_executor.h"
#include "daemon/serve/console/console_server.h"
#include "daemon/serve/console/lane_history.h"
#include "daemon/serve/control_server.h"
#include "daemon/serve/stream_server.h"
#include "daemon/store/calibration_store.h"
#include "daemon/store/worker.h"
#include "drivers/clock.h"
#include "drivers/grace_timer.h"

/// DaemonApp is the service: it tells the core what happens at ports, sockets and clock, and does what the
/// core decides.
///
/// Order of starting: store, sockets, console, ports. Order of stopping: run (table stops), ports, console,
/// sockets, journal, worker. Everything runs on the one thread of the io_context but two things: the worker
/// has a thread for the computations of a run (fits, judgements, what accuracy to expect), and the journal
/// and the samples on disk have one that syncs them (disk_sync.h). The console computes in child processes.
namespace mgtd::daemon::app {

class DaemonApp : private core::CoreActions {
 public:
  DaemonApp(boost::asio::io_context& io, config::Config config, store::CalibrationStore store);
  ~DaemonApp() override;

  [[nodiscard]] Result<void> start();
  void stop();

 private:
  struct Console {
    serve::console::LaneHistory lanes;
    serve::console::ConsoleServer server;
  };
  struct Published {
    EpochRate rate;
    acquire::SensorMeans sensors{};
    std::vector<FrameRate> frames{};  ///< of each instrument
    std::optional<double> last_skew_s{};
    std::uint64_t count{0};  ///< epochs and gaps
  };
  /// What the log says already, so that it is said once.
  struct Logged {
    std::map<std::string, bool> wrong_clocks;  ///< of devices, by name
    std::uint64_t drops{0};                    ///< clients that were disconnected
  };

  void send(Slot slot, std::string_view bytes) override { ports_.send(slot, bytes); }
  void record(const RawRecord& record) override { recording_.append(record); }
  void publish(const Epoch& epoch, const TensorSample& sample, std::span<const InputValue> inputs) override;
  void publish(const Gap& gap) override;
  void carry_out(const run::Action& action, Stamp now) override { run_.carry_out(action, now); }
  void say(const core::Remark& remark, Instant now) override;

  [[nodiscard]] serve::console::ConsoleSource console_source();
  void tick();
  void every_second(Stamp now);
  void use_active_calibration();
  void tell_drops(const StatusReport& status, Instant at);
  void tell_clocks(const StatusReport& status, Instant at);

  [[nodiscard]] Result<nlohmann::ordered_json> answer(const ControlRequest& request);
  [[nodiscard]] Result<nlohmann::ordered_json> answer_run(const ControlRequest& request);
  [[nodiscard]] Result<nlohmann::ordered_json> answer_magnet(const ControlRequest& request);
  [[nodiscard]] Result<nlohmann::ordered_json> abort_magnet(Stamp now);
  [[nodiscard]] Result<nlohmann::ordered_json> answer_calibrations(const ControlRequest& request);
  [[nodiscard]] Result<nlohmann::ordered_json> import_calibration(const ControlRequest& request);
  [[nodiscard]] Result<nlohmann::ordered_json> dry_run(const RunRequest& request) const;
  [[nodiscard]] StatusReport report() const;

  config::Config config_;
  ArrayDescription array_;
  drivers::Clock clock_;
  store::CalibrationStore store_;
  CalibrationHistory history_;
  store::Worker worker_;
  QuietLog quiet_;
  core::DaemonCore core_;
  Recording recording_;
  serve::StreamServer stream_;
  serve::ControlServer control_;
  Console console_;
  run::RunExecutor run_;
  Ports ports_;
  drivers::GraceTimer timer_;

  Stamp started_;
  Published published_;
  Logged logged_;
  std::optional<WatchdogFeed> watchdog_;
  bool stopping_{false};
};

}  // namespace mgtd::daemon::app
