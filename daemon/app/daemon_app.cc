// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/daemon_app.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <system_error>

#include "calib/linear/parts.h"
#include "calib/report/described_array.h"
#include "daemon/app/service_notify.h"
#include "daemon/serve/console/lane_request.h"
#include "daemon/serve/console/metrics.h"
#include "proto/version.h"

namespace mgtd::daemon::app {
namespace {

constexpr auto kTick = std::chrono::milliseconds(20);

serve::StreamConfig stream_config(const config::Config& config) {
  serve::StreamConfig out;
  out.tcp = config.stream.tcp;
  out.unix_path = config.stream.unix_path;
  return out;
}

std::filesystem::path runs_directory(const config::Config& config) {
  return std::filesystem::path(config.store.dir) / "runs";
}

}  // namespace

DaemonApp::DaemonApp(boost::asio::io_context& io, config::Config config, store::CalibrationStore store)
    : config_(std::move(config)),
      array_(calib::report::described(config_.geometry())),
      clock_(config_.speed_up),
      store_(std::move(store)),
      history_(store_),
      worker_(io),
      core_(config_, *this),
      recording_(io, config_, quiet_),
      stream_(io, stream_config(config_), {config_.rig_name, software(), array_}),
      control_(io, {.path = config_.control.unix_path, .mode = config_.control.mode},
               [this](const ControlRequest& request) { return answer(request); }),
      console_{{},
               serve::console::ConsoleServer(
                   io,
                   {.listen = config_.console.listen,
                    .hosts = config_.console.hosts,
                    .control_from_network = config_.console.control_from_network,
                    .workbench = serve::console::WorkbenchConfig{.runs = runs_directory(config_),
                                                                 .mgt = serve::console::mgt_beside_us(),
                                                                 .for_others = true}},
                   console_source())},
      run_(
          config_, runs_directory(config_), store_, worker_, core_.run(),
          {.limits = [this]() -> const drivers::TableLimits& { return core_.instruments().table().limits(); },
           .table = [this] { return core_.instruments().table().health(); },
           .publish = [this](const RunStatus& status) { stream_.publish(status); },
           .warn = [this](std::string_view topic, const std::string& message,
                          Instant now) { quiet_.warn(topic, message, now); }}),
      ports_(io, clock_, config_, core_.instruments()),
      timer_(io),
      started_(clock_.now()),
      published_{.rate = EpochRate(config_.speed_up)} {
  // The other processor is for the acquisition.
  const auto alone = [](const std::stop_token&) {
    calib::linear::keep_parts_on_this_thread();
    return true;
  };
  worker_.run(alone, [](bool) {});
}

DaemonApp::~DaemonApp() { stop(); }

Result<void> DaemonApp::start() {
  std::error_code ec;
  std::filesystem::create_directories(runs_directory(config_), ec);
  if (ec) {
    return fail(ErrorCode::io, fmt::format("{}: {}", runs_directory(config_).string(), ec.message()),
                "set [store] dir to a directory mgtd may write");
  }
  core_.begin(recording_.start(started_, stream_), started_);
  use_active_calibration();
  run_.find_interrupted();
  if (auto bound = stream_.start(); !bound) return bound;
  if (auto bound = control_.start(); !bound) return bound;
  // What can be done without: the rig is measured and operated all the same.
  if (auto bound = console_.server.start(); !bound) spdlog::warn("no web console: {}", bound.error().text());
  if (config_.console.control_from_network)
    spdlog::warn("the console takes control from the network: its token travels unencrypted");
  core_.start_instruments(clock_.now());
  ports_.start();
  for (const std::string& warning : config_.warnings) spdlog::warn("{}", warning);
  if (const auto period = watchdog_period()) watchdog_.emplace(*period);
  tick();
  if (config_.speed_up != 1)
    spdlog::warn("time runs {} times faster than real: only for a simulated rig", config_.speed_up);
  spdlog::info("rig '{}': stream on {} and {}, control on {}", config_.rig_name, config_.stream.tcp,
               config_.stream.unix_path, config_.control.unix_path);
  return {};
}

serve::console::ConsoleSource DaemonApp::console_source() {
  return {.hello =
              [this] {
                const nlohmann::ordered_json hello{
                    {"software", software()},     {"mode", "rig"},
                    {"rig", config_.rig_name},    {"speed_up", config_.speed_up},
                    {"rate_hz", config_.rate_hz}, {"array", to_json(array_)}};
                return hello.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
              },
          .metrics = [this] { return serve::console::metrics(report(), console_.server.refused()); },
          .course =
              [this] {
                RunCourse course = run_.course();
                keep_last_parameters(course);
                return to_json(course).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
              },
          .events = [this]() -> Result<std::string> {
            const auto log = run_.log();
            if (!log) return tl::unexpected(log.error());
            return to_json(*log).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
          },
          .lane = [this](std::string_view query) -> Result<std::string> {
            const auto request = serve::console::parse_lane_request(query);
            if (!request) return tl::unexpected(request.error());
            return serve::console::answer(*request, console_.lanes);
          },
          .stream = [this](const std::shared_ptr<serve::Peer>& peer) { stream_.admit(peer); },
          .control = [this](const std::shared_ptr<serve::Peer>& peer,
                            std::string via) { control_.admit(peer, std::move(via)); }};
}

void DaemonApp::stop() {
  if (std::exchange(stopping_, true)) return;
  timer_.cancel();
  run_.abandon();
  core_.abandon_run(clock_.now());
  ports_.shutdown();
  console_.server.stop();
  stream_.stop();
  control_.stop();
}

void DaemonApp::use_active_calibration() {
  auto active = store_.active();
  std::shared_ptr<const calib::calibration::Calibration> used;
  if (!active) {
    spdlog::error("the active calibration cannot be read, streaming raw: {}", active.error().text());
  } else if (*active && !(*active)->geometry.agrees_with(config_.geometry())) {
    const auto [its, own] = calib::report::names_apart((*active)->geometry, config_.geometry());
    spdlog::error(
        "calibration {} is of {}, this rig is {}: streaming raw; measure a run and accept its calibration",
        (*active)->id, its, own);
  } else if (*active) {
    spdlog::info("calibration {} is active", (*active)->id);
    used = std::make_shared<const calib::calibration::Calibration>(**std::move(active));
  } else {
    spdlog::info("no calibration is active: the stream is raw and says so");
  }
  core_.use(std::move(used), clock_.now());
}

void DaemonApp::publish(const Epoch& epoch, const TensorSample& sample, std::span<const InputValue> inputs) {
  stream_.publish(sample, inputs);
  console_.lanes.add(sample, epoch.T_degC, inputs);
  const acquire::LivePipeline& pipeline = core_.pipeline();
  published_.sensors.add(epoch, sample.calibration_id, pipeline.live().fields_P_nT(),
                         pipeline.standing_angles(epoch.t.mono));
  published_.last_skew_s = epoch.skew_bound_s;
  ++published_.count;
}

void DaemonApp::publish(const Gap& gap) {
  stream_.publish(gap);
  console_.lanes.add(gap);
  ++published_.count;
}

void DaemonApp::say(const core::Remark& remark, Instant now) {
  const bool warning = remark.level == core::Remark::Level::warning;
  if (remark.topic.empty() && warning) return spdlog::warn("{}", remark.text);
  if (remark.topic.empty()) return spdlog::info("{}", remark.text);
  if (warning) return quiet_.warn(remark.topic, remark.text, now);
  quiet_.info(remark.topic, remark.text, now);
}

void DaemonApp::tick() {
  const Stamp now = clock_.now();
  core_.tick(now);
  if (const auto lost = recording_.tick(now)) core_.note(*lost, clock_.now());
  if (published_.rate.is_due(std::chrono::steady_clock::now())) every_second(now);
  if (stopping_) return;
  timer_.wait(kTick, [this] {
    if (!stopping_) tick();
  });
}

void DaemonApp::tell_drops(const StatusReport& status, Instant at) {
  const std::uint64_t drops = status.stream.dropped() + status.control.dropped();
  if (drops == std::exchange(logged_.drops, drops)) return;
  if (!status.stream.last_drop.empty()) quiet_.warn("stream client", status.stream.last_drop, at);
  if (!status.control.last_drop.empty()) quiet_.warn("control client", status.control.last_drop, at);
}

/// Once, and again when it has gone and come back. The size settles within seconds: it is told when it is
/// known to a tenth.
void DaemonApp::tell_clocks(const StatusReport& status, Instant at) {
  for (const DeviceStatus& device : status.devices) {
    const bool wrong = device.clock && !device.clock->trouble.empty() &&
                       device.clock->rate_error_pm < std::abs(device.clock->rate_error) / 10;
    bool& logged = logged_.wrong_clocks[device.name];
    if (wrong && !logged) quiet_.warn(device.name + " clock", device.clock->trouble, at);
    if (device.clock) logged = wrong || (logged && !device.clock->settled);
  }
}

void DaemonApp::every_second(Stamp now) {
  const Instant host = std::chrono::steady_clock::now();
  const std::uint64_t epochs = core_.pipeline().sampler().health().epochs;
  published_.rate.add(epochs, host);
  const auto links = core_.instruments().links();
  published_.frames.resize(links.size());
  for (std::size_t i = 0; i < links.size(); ++i) published_.frames[i].add(links[i].second.frames, now.mono);
  recording_.guard_reserve();
  core_.every_second(now);
  const StatusReport status = report();
  tell_drops(status, now.mono);
  tell_clocks(status, now.mono);
  quiet_.tick(now.mono);
  stream_.publish(status);
  if (const auto sensors = published_.sensors.take()) stream_.publish(*sensors);
  notify_status(fmt::format("{} epochs, calibration {}, run {}", epochs, store_.active_id().value_or("none"),
                            name(run_.status(now.mono).state)));
  if (watchdog_ && watchdog_->is_due(published_.count, epochs, host)) notify_watchdog();
}

}  // namespace mgtd::daemon::app
