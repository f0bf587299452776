// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include <CLI/CLI.hpp>
#include <boost/asio/signal_set.hpp>
#include <csignal>
#include <cstdio>
#include <string>

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "daemon/app/daemon_app.h"
#include "daemon/app/service_notify.h"
#include "daemon/store/store_lock.h"
#include "proto/version.h"

namespace {

using namespace mgtd;
using namespace mgtd::daemon;

// sysexits.h, as systemd and scripts know them.
constexpr int kExitUsage = 64, kExitConfig = 78, kExitUnavailable = 69, kExitIo = 74;

int report(const Error& error) {
  fmt::print(stderr, "mgtd: {}\n", error.text());
  return error.code == ErrorCode::io ? kExitIo : kExitUnavailable;
}

int run_service(mgtd::daemon::config::Config config) {
  mgtd::daemon::app::start_log(config.log_level);
  std::signal(SIGPIPE, SIG_IGN);
  const auto lock = mgtd::daemon::store::StoreLock::take(config.store_dir);
  if (!lock) return report(lock.error());
  auto store =
      mgtd::daemon::store::CalibrationStore::open(std::filesystem::path(config.store_dir) / "calibrations");
  if (!store) return report(store.error());
  boost::asio::io_context io(1);
  mgtd::daemon::app::DaemonApp app(io, std::move(config), *std::move(store));
  if (auto started = app.start(); !started) return report(started.error());
  boost::asio::signal_set signals(io, SIGINT, SIGTERM);
  if (struct sigaction hangup{}; ::sigaction(SIGHUP, nullptr, &hangup) == 0 && hangup.sa_handler == SIG_DFL)
    signals.add(SIGHUP);  // the terminal was closed; not under nohup
  signals.async_wait([&](auto ec, int number) {
    if (ec) return;
    spdlog::info("signal {}: stopping the table and closing", number);
    mgtd::daemon::app::notify_stopping();
    app.stop();
    io.stop();
  });
  mgtd::daemon::app::notify_ready();
  io.run();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{
      "mgtd: drives a magnetic gradient tensor rig, calibrates it and streams the tensor\n\n"
      "  mgtd --config /etc/mgtd/mgtd.toml                  run\n"
      "  mgtd --config rig.toml --check-config              list every mistake in the configuration and "
      "end\n\n"
      "The operator's tool is mgt: mgt status, mgt run start, mgt watch.",
      "mgtd"};
  app.set_version_flag("--version", version());
  std::string config_file = "/etc/mgtd/mgtd.toml";
  bool check_only = false;
  app.add_option("--config", config_file, "the configuration")->capture_default_str();
  app.add_flag("--check-config", check_only, "only read the configuration");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : kExitUsage;
  }
  auto config = mgtd::daemon::config::load_config(config_file);
  if (!config) {
    for (const std::string& line : config.error().lines) fmt::print(stderr, "{}\n", line);
    return kExitConfig;
  }
  if (check_only) {
    for (const std::string& warning : config->warnings) fmt::print(stderr, "{}\n", warning);
    fmt::print("{}: good\n", config_file);
    return 0;
  }
  return run_service(*std::move(config));
}
