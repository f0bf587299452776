// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/service.h"

#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <filesystem>
#include <utility>

#include <spdlog/spdlog.h>

#include "daemon/app/daemon_app.h"
#include "daemon/app/log.h"
#include "daemon/app/service_notify.h"
#include "daemon/store/store_lock.h"

namespace mgtd::daemon::app {

Result<void> run_service(config::Config config) {
  start_log(config.log_level);
  std::signal(SIGPIPE, SIG_IGN);
  const auto lock = store::StoreLock::take(config.store.dir);
  if (!lock) return tl::unexpected(lock.error());
  auto calibrations = store::CalibrationStore::open(std::filesystem::path(config.store.dir) / "calibrations");
  if (!calibrations) return tl::unexpected(calibrations.error());
  boost::asio::io_context io(1);
  DaemonApp app(io, std::move(config), *std::move(calibrations));
  if (auto started = app.start(); !started) return started;
  boost::asio::signal_set signals(io, SIGINT, SIGTERM);
  if (struct sigaction hangup{}; ::sigaction(SIGHUP, nullptr, &hangup) == 0 && hangup.sa_handler == SIG_DFL)
    signals.add(SIGHUP);  // the terminal was closed; not under nohup
  signals.async_wait([&](auto ec, int number) {
    if (ec) return;
    spdlog::info("signal {}: stopping the table and closing", number);
    notify_stopping();
    app.stop();
    io.stop();
  });
  notify_ready();
  io.run();
  return {};
}

}  // namespace mgtd::daemon::app
