// SPDX-License-Identifier: Apache-2.0
#include "daemon/rig.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <system_error>

#include "daemon/service_notify.h"

namespace mgtd::daemon {
namespace {

constexpr auto kTick = std::chrono::milliseconds(20);

SamplerConfig sampler_config(const Config& config) {
  SamplerConfig out;
  out.rate_hz = config.rate_hz;
  for (std::size_t i = 0; i < kSensors; ++i) out.latency_s.at(i) = config.sensors.at(i).latency_s;
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
      pipeline_(calib::Geometry{config_.baseline_m}),
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
    pipeline_ = calib::TensorPipeline(calib::Geometry{config_.baseline_m});
    return;
  }
  if (*active) {
    spdlog::info("calibration {} is active", (*active)->id);
    pipeline_ = calib::TensorPipeline(std::make_shared<const calib::Calibration>(**std::move(active)));
  } else {
    spdlog::info("no calibration is active: the stream is raw and says so");
    pipeline_ = calib::TensorPipeline(calib::Geometry{config_.baseline_m});
  }
}

void Rig::on_event(const std::string& device, const DeviceEvent& event) {
  const Stamp now = clock_.now();
  if (const auto* reading = std::get_if<FieldReading>(&event)) return on_reading(*reading);
  if (const auto* temperature = std::get_if<TemperatureReading>(&event)) return sampler_.push(*temperature);
  if (const auto* scalar = std::get_if<ScalarReading>(&event)) return run_.feed(*scalar, now);
  if (const auto* table = std::get_if<TableReading>(&event)) return run_.feed(*table, now);
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
  TensorSample sample = pipeline_.apply(epoch);
  if (run_.active()) sample.flags |= Flag::calibrating;
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

void Rig::every_second(Stamp now) {
  const Instant host = std::chrono::steady_clock::now();
  const std::uint64_t epochs = sampler_.health().epochs;
  if (last_second_)
    rate_hz_ =
        static_cast<double>(epochs - epochs_at_second_) / to_seconds(host - *last_second_) / config_.speed_up;
  epochs_at_second_ = epochs;
  watch_links(now);
  stream_.publish(report());
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

StatusReport Rig::report() const {
  const Stamp now = clock_.now();
  StatusReport out;
  out.at = now;
  out.uptime_s = to_seconds(now.mono - started_.mono) / config_.speed_up;
  out.software = "mgtd " MGTD_VERSION;
  out.rig = config_.rig_name;
  out.speed_up = config_.speed_up;
  out.calibration = store_.active_id();
  out.devices = instruments_.status();
  const SamplerHealth sampler = sampler_.health();
  out.sampler = {
      .epochs = sampler.epochs, .gaps = sampler.gaps, .rate_hz = rate_hz_, .skew_bound_s = last_skew_s_};
  out.stream = stream_.stats();
  out.journal.state = journal_ ? (journal_->recording() ? "writing" : "stopped: the disk refused") : "off";
  out.journal.bytes = journal_ ? journal_->bytes_written() : 0;
  std::error_code ec;
  if (const auto space = std::filesystem::space(config_.store_dir, ec); !ec)
    out.disk_free_bytes = space.available;
  out.run = run_.status(now.mono);
  return out;
}

}  // namespace mgtd::daemon
