// SPDX-License-Identifier: Apache-2.0
#include "daemon/app/daemon_app.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cmath>
#include <system_error>

#include "daemon/app/service_notify.h"

namespace mgtd::daemon {
namespace {

constexpr auto kTick = std::chrono::milliseconds(20);

StreamConfig stream_config(const Config& config) {
  StreamConfig out;
  out.tcp = config.stream_tcp;
  out.unix_path = config.stream_unix;
  return out;
}

bool is_rearranged(calib::LiveState state) {
  return state == calib::LiveState::exchanged || state == calib::LiveState::turned;
}

std::filesystem::path runs_directory(const Config& config) {
  return std::filesystem::path(config.store_dir) / "runs";
}

}  // namespace

DaemonApp::DaemonApp(boost::asio::io_context& io, Config config, CalibrationStore store)
    : io_(io),
      config_(std::move(config)),
      clock_(config_.speed_up),
      store_(std::move(store)),
      worker_(io),
      instruments_(io, clock_, config_,
                   {.on_event = [this](const std::string& device,
                                       const DeviceEvent& event) { on_event(device, event); },
                    .on_link = [this](const std::string& device,
                                      const LinkHealth& health) { on_link(device, health); },
                    .on_raw = [this](const RawRecord& record) { on_raw(record); },
                    .on_note = [this](const JournalNote& what, Stamp at) { note(what, at); }}),
      pipeline_(sampler_config(config_), config_.baseline_m, inputs_of(config_)),
      stream_(io, stream_config(config_), {config_.rig_name, "mgtd " MGTD_VERSION}),
      control_(io, {.path = config_.control_unix, .mode = config_.control_mode},
               [this](const ControlRequest& request) { return answer(request); }),
      run_(config_, runs_directory(config_), store_, worker_,
           {.table = [this]() -> drivers::Turntable& { return instruments_.table(); },
            .order = [this](const TableOrder& order) { instruments_.order(order); },
            .publish = [this](const RunStatus& status) { stream_.publish(status); },
            .warn = [this](std::string_view topic, const std::string& message,
                           Instant now) { quiet_.warn(topic, message, now); }}),
      disk_sync_(io),
      timer_(io),
      started_(clock_.now()) {}

DaemonApp::~DaemonApp() { stop(); }

Result<void> DaemonApp::start() {
  std::error_code ec;
  std::filesystem::create_directories(runs_directory(config_), ec);
  if (ec) {
    return fail(ErrorCode::io, fmt::format("{}: {}", runs_directory(config_).string(), ec.message()),
                "set [store] dir to a directory mgtd may write");
  }
  start_recording();
  use_active_calibration();
  run_.find_interrupted();
  if (auto bound = stream_.start(); !bound) return bound;
  if (auto bound = control_.start(); !bound) return bound;
  instruments_.start();
  for (const std::string& warning : config_.warnings) spdlog::warn("{}", warning);
  if (const auto period = watchdog_period()) watchdog_.emplace(*period);
  tick();
  if (config_.speed_up != 1)
    spdlog::warn("time runs {} times faster than real: only for a simulated rig", config_.speed_up);
  spdlog::info("rig '{}': stream on {} and {}, control on {}", config_.rig_name, config_.stream_tcp,
               config_.stream_unix, config_.control_unix);
  return {};
}

void DaemonApp::stop() {
  if (std::exchange(stopping_, true)) return;
  timer_.cancel();
  run_.abandon();
  instruments_.shutdown();
  stream_.stop();
  control_.stop();
}

void DaemonApp::use_active_calibration() {
  auto active = store_.active();
  std::shared_ptr<const calib::Calibration> used;
  if (!active) {
    spdlog::error("the active calibration cannot be read, streaming raw: {}", active.error().text());
  } else if (*active) {
    spdlog::info("calibration {} is active", (*active)->id);
    used = std::make_shared<const calib::Calibration>(**std::move(active));
  } else {
    spdlog::info("no calibration is active: the stream is raw and says so");
  }
  note(CalibrationNote{used ? calib::to_json_text(*used) : std::string()}, clock_.now());
  pipeline_.use(std::move(used));
}

void DaemonApp::tell_left_out() {
  if (pipeline_.live().left_out() == told_left_out_) return;
  for (const auto& [effect, lacks] : pipeline_.live().left_out())
    spdlog::warn("{} is not corrected: {} is not measured; the samples say incomplete", effect, lacks);
  if (pipeline_.live().left_out().empty()) spdlog::info("every effect of the calibration is corrected");
  told_left_out_ = pipeline_.live().left_out();
}

void DaemonApp::tell_identity() {
  const std::string measured = pipeline_.instruments().measured();
  if (measured == told_identity_) return;
  told_identity_ = measured;
  if (measured.empty())
    spdlog::info("every sensor is the one that was calibrated in its place");
  else
    spdlog::warn("the samples are raw: {}; {}", measured, pipeline_.instruments().remedy());
}

/// On a change of state only.
void DaemonApp::tell_criticism() {
  const calib::LiveFinding& verdict = pipeline_.verdict();
  if (is_rearranged(verdict.state) || !readings_said_.empty()) {
    readings_said_ = is_rearranged(verdict.state) ? verdict.measured : std::string();
    run_.feed(ReadingsSay{readings_said_, verdict.remedy}, clock_.now());
  }
  if (verdict.state == calib::LiveState::suspect) {
    spdlog::warn("the calibration is suspect: {}; limit {}; {}", verdict.measured, verdict.limit,
                 verdict.remedy);
  } else if (verdict.state == calib::LiveState::near_source) {
    spdlog::warn("something magnetic is near: {}; {}", verdict.measured, verdict.remedy);
  } else if (is_rearranged(verdict.state)) {
    spdlog::warn("the samples are raw from here on: {}; {}", verdict.measured, verdict.remedy);
  } else {
    spdlog::info("the stream's closure: {}", calib::to_string(verdict.state));
  }
}

void DaemonApp::on_event(const std::string& device, const DeviceEvent& event) {
  const Stamp now = clock_.now();
  if (const auto* reading = std::get_if<FieldReading>(&event)) {
    pipeline_.answers(reading->slot, instruments_.told(reading->slot));
    pipeline_.push(*reading);
    return deliver();
  }
  if (const auto* temperature = std::get_if<TemperatureReading>(&event)) return pipeline_.push(*temperature);
  if (const auto* scalar = std::get_if<ScalarReading>(&event)) return run_.feed(*scalar, now);
  if (const auto* auxiliary = std::get_if<AuxiliaryReading>(&event)) {
    pipeline_.push(*auxiliary);
    return run_.feed(*auxiliary, now);
  }
  if (const auto* table = std::get_if<TableReading>(&event)) {
    pipeline_.push(*table);
    return run_.feed(*table, now);
  }
  if (const auto* note = std::get_if<DeviceNote>(&event)) return quiet_.info(device, note->what, now.mono);
  if (const auto* fault = std::get_if<DeviceFault>(&event)) {
    quiet_.warn(device, fault->remedy.empty() ? fault->what : fault->what + "; " + fault->remedy, now.mono);
    run_.feed(DeviceFaulted{device, *fault}, now);
  }
}

void DaemonApp::on_link(const std::string& device, const LinkHealth& health) {
  const Stamp now = clock_.now();
  const auto [known, first] = link_states_.try_emplace(device, LinkState::absent);
  LinkState& before = known->second;
  if (!first && before == health.state) return;
  const bool answered = answers(before);
  before = health.state;
  const std::string_view state = kLinkStateNames.at(static_cast<std::size_t>(health.state));
  if (answers(health.state) && !answered) {
    quiet_.info(device, health.identity.empty() ? "live" : "live, " + health.identity, now.mono);
    if (device.starts_with('s') && device.size() == 2) {
      note(ReopenedNote{device[1] - '1'}, now);
      pipeline_.reopened(device[1] - '1');
    }
    run_.feed(LinkSeen{device, health}, now);  // who it is, before it counts as back
    run_.feed(DeviceBack{device}, now);
  } else if (health.state == LinkState::live) {
    quiet_.info(device, "live again", now.mono);
  }
  if (health.state == LinkState::live) return;
  const std::string words = fmt::format("{}: {}", state, health.detail);
  if (health.state == LinkState::probing)
    quiet_.info(device, words, now.mono);
  else
    quiet_.warn(device, words, now.mono);
  if (answered && !answers(health.state)) run_.feed(DeviceLost{device, health.detail}, now);
}

void DaemonApp::deliver() {
  pipeline_.deliver(
      [this](const Epoch& epoch, const TensorSample& sample, bool verdict_changed) {
        if (verdict_changed) tell_criticism();
        publish(epoch, sample);
        ++published_;
      },
      [this](const Gap& gap) {
        stream_.publish(gap);
        run_.feed(gap, clock_.now());
        ++published_;
      });
}

void DaemonApp::publish(const Epoch& epoch, const TensorSample& sample) {
  follow_magnet_test(epoch.t.mono, &epoch);
  stream_.publish(sample, pipeline_.inputs().values());
  last_skew_s_ = epoch.skew_bound_s;
  run_.feed(epoch, clock_.now());
}

void DaemonApp::watch_links(Stamp now) {
  if (!run_.active()) return;
  for (const auto& [name, health] : instruments_.links()) run_.feed(LinkSeen{name, health}, now);
  if (!readings_said_.empty()) run_.feed(ReadingsSay{readings_said_, pipeline_.verdict().remedy}, now);
}

void DaemonApp::tick() {
  const Stamp now = clock_.now();
  on_raw({.device = kRawDaemon, .direction = RawDirection::tick, .at = now, .bytes = {}});
  pipeline_.advance(now.mono);
  deliver();
  if (run_.status(now.mono).state == RunState::preflight) watch_links(now);
  run_.feed(Tick{}, now);
  follow_magnet_test(now.mono, nullptr);
  record(now);
  const Instant host = std::chrono::steady_clock::now();
  if (!last_second_ || host - *last_second_ >= std::chrono::seconds(1)) {
    every_second(now);
    last_second_ = host;
  }
  if (stopping_) return;
  timer_.wait(kTick, [this] {
    if (!stopping_) tick();
  });
}

/// Without an epoch, time only passes.
void DaemonApp::follow_magnet_test(Instant now, const Epoch* epoch) {
  if (!magnet_ || magnet_->ended()) return;
  if (epoch != nullptr) magnet_->add(*epoch);
  magnet_->advance(now);
  if (!magnet_->ended()) return;
  const MagnetStatus found = magnet_->status();
  spdlog::info("magnet test: {}", found.text);
  for (const std::string& finding : findings(found)) spdlog::warn("magnet test: {}", finding);
}

void DaemonApp::tell_drops(const StatusReport& status, Instant at) {
  const std::uint64_t drops = status.stream.dropped() + status.control.dropped();
  if (drops == std::exchange(told_drops_, drops)) return;
  if (!status.stream.last_drop.empty()) quiet_.warn("stream client", status.stream.last_drop, at);
  if (!status.control.last_drop.empty()) quiet_.warn("control client", status.control.last_drop, at);
}

/// Once, and again when it has gone and come back. The size settles within seconds: it is told when it is
/// known to a tenth.
void DaemonApp::tell_clocks(const StatusReport& status, Instant at) {
  for (const DeviceStatus& device : status.devices) {
    const bool wrong = device.clock && !device.clock->trouble.empty() &&
                       device.clock->rate_error_pm < std::abs(device.clock->rate_error) / 10;
    bool& told = told_clocks_[device.name];
    if (wrong && !told) quiet_.warn(device.name + " clock", device.clock->trouble, at);
    if (device.clock) told = wrong || (told && !device.clock->settled);
  }
}

void DaemonApp::every_second(Stamp now) {
  const Instant host = std::chrono::steady_clock::now();
  const std::uint64_t epochs = pipeline_.sampler().health().epochs;
  if (last_second_)
    rate_hz_ =
        static_cast<double>(epochs - epochs_at_second_) / to_seconds(host - *last_second_) / config_.speed_up;
  epochs_at_second_ = epochs;
  watch_links(now);
  guard_reserve();
  tell_left_out();
  tell_identity();
  const StatusReport status = report();
  tell_drops(status, now.mono);
  tell_clocks(status, now.mono);
  quiet_.tick(now.mono);
  stream_.publish(status);
  notify_status(fmt::format("{} epochs, calibration {}, run {}", epochs, store_.active_id().value_or("none"),
                            name(run_.status(now.mono).state)));
  if (watchdog_ && watchdog_->is_due(published_, epochs, host)) notify_watchdog();
}

}  // namespace mgtd::daemon
