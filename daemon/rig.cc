// SPDX-License-Identifier: Apache-2.0
#include "daemon/rig.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <system_error>

#include "daemon/service_notify.h"

namespace mgtd::daemon {
namespace {

constexpr auto kTick = std::chrono::milliseconds(20);
constexpr auto kFreshAngles = std::chrono::seconds(10);

SamplerConfig sampler_config(const Config& config) {
  SamplerConfig out;
  out.rate_hz = config.rate_hz;
  for (std::size_t i = 0; i < kSensors; ++i) {
    const DeviceConfig& sensor = config.sensors.at(i);
    out.latency_s.at(i) = sensor.latency_s;
    out.wire_s.at(i) = wire_s(sensor.device->line_bytes(), sensor.device->baud());
  }
  out.silence_s *= config.speed_up;
  return out;
}

StreamConfig stream_config(const Config& config) {
  StreamConfig out;
  out.tcp = config.stream_tcp;
  out.unix_path = config.stream_unix;
  return out;
}

std::filesystem::path runs_directory(const Config& config) {
  return std::filesystem::path(config.store_dir) / "runs";
}

}  // namespace

Rig::Rig(boost::asio::io_context& io, Config config, CalibrationStore store)
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
                    .on_raw =
                        [this](const RawRecord& record) {
                          if (journal_) journal_->append(record);
                        }}),
      sampler_(sampler_config(config_)),
      live_(calib::Geometry{config_.baseline_m}),
      stream_(io, stream_config(config_), {config_.rig_name, "mgtd " MGTD_VERSION}),
      control_(io, {.path = config_.control_unix, .mode = config_.control_mode},
               [this](const ControlRequest& request) { return answer(request); }),
      run_(config_, runs_directory(config_), store_, worker_,
           {.table = [this]() -> drivers::Turntable& { return instruments_.table(); },
            .flush_table = [this] { instruments_.flush_table(); },
            .publish = [this](const RunStatus& status) { stream_.publish(status); }}),
      timer_(io),
      started_(clock_.now()) {}

Rig::~Rig() { stop(); }

Result<void> Rig::start() {
  std::error_code ec;
  std::filesystem::create_directories(runs_directory(config_), ec);
  if (ec) {
    return fail(ErrorCode::io, fmt::format("{}: {}", runs_directory(config_).string(), ec.message()),
                "set [store] dir to a directory mgtd may write");
  }
  if (config_.journal) {
    auto journal = Journal::open({.directory = runs_directory(config_),
                                  .name = "raw-" + fmt::format("{}", started_.wall.ns / 1'000'000'000),
                                  .header = {config_.rig_name, ""}},
                                 started_.mono);
    if (journal) {
      journal_ = *std::move(journal);
    } else {
      spdlog::error("no raw journal: {}", journal.error().text());
    }
  }
  use_active_calibration();
  run_.find_interrupted();
  if (auto bound = stream_.start(); !bound) return bound;
  if (auto bound = control_.start(); !bound) return bound;
  instruments_.start();
  watchdog_ = watchdog_period();
  tick();
  if (config_.speed_up != 1)
    spdlog::warn("time runs {} times faster than real: only for a simulated rig", config_.speed_up);
  spdlog::info("rig '{}': stream on {} and {}, control on {}", config_.rig_name, config_.stream_tcp,
               config_.stream_unix, config_.control_unix);
  return {};
}

void Rig::stop() {
  if (std::exchange(stopping_, true)) return;
  timer_.cancel();
  run_.abandon();
  instruments_.shutdown();
  stream_.stop();
  control_.stop();
}

void Rig::use_active_calibration() {
  auto active = store_.active();
  if (!active) {
    spdlog::error("the active calibration cannot be read, streaming raw: {}", active.error().text());
    live_ = calib::LiveTensor(calib::Geometry{config_.baseline_m});
    criticism_ = {};
    return;
  }
  if (*active) {
    spdlog::info("calibration {} is active", (*active)->id);
    criticism_ = calib::LiveCriticism(**active);
    live_ = calib::LiveTensor(std::make_shared<const calib::Calibration>(**std::move(active)));
  } else {
    spdlog::info("no calibration is active: the stream is raw and says so");
    criticism_ = {};
    live_ = calib::LiveTensor(calib::Geometry{config_.baseline_m});
  }
}

/// Where the array stands is known while a referenced table stands still and says so.
calib::LiveConditions Rig::conditions(Instant at) const {
  calib::LiveConditions out;
  if (table_ && table_->referenced && !table_->moving && at - table_->arrival.mono < kFreshAngles)
    out.angles = table_->angles;
  return out;
}

void Rig::tell_left_out() {
  if (live_.left_out() == told_left_out_) return;
  for (const auto& [effect, lacks] : live_.left_out())
    spdlog::warn("{} is not corrected: {} is not measured; the samples say incomplete", effect, lacks);
  if (live_.left_out().empty()) spdlog::info("every effect of the calibration is corrected");
  told_left_out_ = live_.left_out();
}

/// On a change of state only.
void Rig::tell_criticism() {
  const calib::LiveVerdict& verdict = criticism_.verdict();
  if (verdict.state == calib::LiveState::suspect) {
    spdlog::warn("the calibration is suspect: {}; limit {}; {}", verdict.measured, verdict.limit,
                 verdict.remedy);
  } else if (verdict.state == calib::LiveState::near_source) {
    spdlog::warn("something magnetic is near: {}; {}", verdict.measured, verdict.remedy);
  } else {
    spdlog::info("the stream's closure: {}", calib::to_string(verdict.state));
  }
}

void Rig::on_event(const std::string& device, const DeviceEvent& event) {
  const Stamp now = clock_.now();
  if (const auto* reading = std::get_if<FieldReading>(&event)) return on_reading(*reading);
  if (const auto* temperature = std::get_if<TemperatureReading>(&event)) return sampler_.push(*temperature);
  if (const auto* scalar = std::get_if<ScalarReading>(&event)) return run_.feed(*scalar, now);
  if (const auto* table = std::get_if<TableReading>(&event)) {
    table_ = *table;
    return run_.feed(*table, now);
  }
  if (const auto* note = std::get_if<DeviceNote>(&event)) return spdlog::info("{}: {}", device, note->what);
  if (const auto* fault = std::get_if<DeviceFault>(&event)) {
    quiet_.warn(device, fault->remedy.empty() ? fault->what : fault->what + "; " + fault->remedy, now.mono);
    run_.feed(DeviceFaulted{device, *fault}, now);
  }
}

void Rig::on_link(const std::string& device, const LinkHealth& health) {
  const Stamp now = clock_.now();
  LinkState& before = link_states_[device];
  if (before == health.state) return;
  const bool answered = answers(before);
  before = health.state;
  const std::string_view state = kLinkStateNames.at(static_cast<std::size_t>(health.state));
  if (answers(health.state) && !answered) {
    spdlog::info("{}: live, {}", device, health.identity);
    if (device.starts_with('s') && device.size() == 2) sampler_.reopened(device[1] - '1');
    run_.feed(DeviceBack{device}, now);
  } else if (health.state == LinkState::live) {
    spdlog::info("{}: live again", device);
  }
  if (health.state == LinkState::live) return;
  quiet_.warn(device, fmt::format("{}: {}", state, health.detail), now.mono);
  if (answered && !answers(health.state)) run_.feed(DeviceLost{device, health.detail}, now);
}

void Rig::on_reading(const FieldReading& reading) {
  sampler_.push(reading, pending_);
  deliver();
}

void Rig::deliver() {
  for (const EpochOrGap& item : pending_) {
    if (const auto* epoch = std::get_if<Epoch>(&item)) {
      publish(*epoch);
    } else {
      stream_.publish(std::get<Gap>(item));
      run_.feed(std::get<Gap>(item), clock_.now());
    }
    ++published_;
  }
  pending_.clear();
}

void Rig::publish(const Epoch& epoch) {
  TensorSample sample = live_.apply(epoch, conditions(epoch.t.mono));
  if (run_.active()) sample.flags |= Flag::calibrating;
  if (const auto& used = live_.calibration(); used && !used->accepted_by_checks) sample.flags |= Flag::forced;
  if (criticism_.add(sample, epoch.T_degC)) tell_criticism();
  if (criticism_.verdict().state == calib::LiveState::suspect) sample.flags |= Flag::suspect;
  if (criticism_.verdict().state == calib::LiveState::near_source) sample.flags |= Flag::near_source;
  stream_.publish(sample);
  last_skew_s_ = epoch.skew_bound_s;
  run_.feed(epoch, clock_.now());
}

void Rig::watch_links(Stamp now) {
  if (!run_.active()) return;
  for (const auto& [name, health] : instruments_.links()) run_.feed(LinkSeen{name, health}, now);
}

void Rig::tick() {
  const Stamp now = clock_.now();
  sampler_.advance(now.mono, pending_);
  deliver();
  if (run_.status(now.mono).state == RunState::preflight) watch_links(now);
  run_.feed(Tick{}, now);
  if (journal_) {
    journal_->tick(now.mono);
    if (const auto error = journal_->take_error()) spdlog::error("raw journal: {}", error->text());
  }
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

void Rig::tell_drops(const StatusReport& status, Instant at) {
  const std::uint64_t drops = status.stream.dropped() + status.control.dropped();
  if (drops == std::exchange(told_drops_, drops)) return;
  if (!status.stream.last_drop.empty()) quiet_.warn("stream client", status.stream.last_drop, at);
  if (!status.control.last_drop.empty()) quiet_.warn("control client", status.control.last_drop, at);
}

void Rig::every_second(Stamp now) {
  const Instant host = std::chrono::steady_clock::now();
  const std::uint64_t epochs = sampler_.health().epochs;
  if (last_second_)
    rate_hz_ =
        static_cast<double>(epochs - epochs_at_second_) / to_seconds(host - *last_second_) / config_.speed_up;
  epochs_at_second_ = epochs;
  watch_links(now);
  tell_left_out();
  const StatusReport status = report();
  tell_drops(status, now.mono);
  stream_.publish(status);
  notify_status(fmt::format("{} epochs, calibration {}, run {}", epochs, store_.active_id().value_or("none"),
                            name(run_.status(now.mono).state)));
  // Fed by the data path: epochs, or honest gaps, must have come out since the last time. Before the first
  // sensor is there nothing can.
  const bool moved = published_ != published_at_watchdog_ || epochs == 0;
  if (watchdog_ && moved && (!last_watchdog_ || host - *last_watchdog_ >= *watchdog_ / 2)) {
    notify_watchdog();
    last_watchdog_ = host;
    published_at_watchdog_ = published_;
  }
}

}  // namespace mgtd::daemon
