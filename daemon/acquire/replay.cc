// SPDX-License-Identifier: Apache-2.0
#include "daemon/acquire/replay.h"

#include <fmt/format.h>

#include <map>
#include <nlohmann/json.hpp>
#include <span>

#include "calib/report/described_array.h"
#include "daemon/acquire/instruments.h"
#include "proto/stream_codec.h"

namespace mgtd::daemon::acquire {
namespace {

std::string printable(std::string_view bytes) {
  return nlohmann::json(bytes.substr(0, 40)).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

}  // namespace

struct Replay::Life {
  explicit Life(config::Config c)
      : config(std::move(c)), pipeline(sampler_config(config), config.geometry(), inputs_of(config)) {
    for (const auto& [slot, device] : devices_of(config))
      instruments[slot.number()] = {device->name, device->device, {}};
  }
  struct Instrument {
    std::string name;
    std::shared_ptr<drivers::Device> device;
    std::string wanted{};  ///< what it wants to send, not yet seen as sent
  };
  config::Config config;
  LivePipeline pipeline;
  std::map<std::uint8_t, Instrument> instruments;  ///< by their number in the journal
};

Replay::Replay(std::function<void(std::string_view)> line,
               std::shared_ptr<const calib::calibration::Calibration> instead)
    : line_(std::move(line)), instead_(std::move(instead)) {}

Replay::~Replay() = default;

Result<void> Replay::feed(const RawRecord& record) {
  ++counts_.records;
  if (record.direction == RawDirection::note) return note(record);
  if (life_ == nullptr) {
    return fail(
        ErrorCode::bad_input, "the journal does not begin with the start of the daemon",
        "name its first file too, and all between; what its first file is gone of cannot be replayed");
  }
  if (record.device == kRawDaemon) {
    life_->pipeline.advance(record.at.mono);
    deliver();
    return {};
  }
  if (!life_->instruments.contains(record.device)) {
    return fail(ErrorCode::bad_input,
                fmt::format("device {} of the journal is not in its configuration", record.device), "");
  }
  tell_device(record);
  return {};
}

void Replay::tell_device(const RawRecord& record) {
  Life::Instrument& instrument = life_->instruments.at(record.device);
  drivers::Device& device = *instrument.device;
  switch (record.direction) {
    case RawDirection::received:
      device.on_bytes(std::as_bytes(std::span(record.bytes.data(), record.bytes.size())), record.at);
      break;
    case RawDirection::opened:
      device.on_open(record.at);
      break;
    case RawDirection::closed:
      device.on_close(record.at);
      static_cast<void>(device.take_output());
      instrument.wanted.clear();
      break;
    case RawDirection::tick:
      device.on_tick(record.at);
      break;
    case RawDirection::ended:
      device.on_shutdown(record.at);
      break;
    case RawDirection::sent:
      return check_sent(record);
    case RawDirection::note:
      return;
  }
  instrument.wanted += device.take_output();
  take_events(record.device);
}

void Replay::check_sent(const RawRecord& record) {
  Life::Instrument& instrument = life_->instruments.at(record.device);
  std::string& wanted = instrument.wanted;
  if (wanted.starts_with(record.bytes)) {
    wanted.erase(0, record.bytes.size());
    return;
  }
  if (!counts_.parted) {
    counts_.parted =
        fmt::format("{} {}: sent was {}, the driver now wants to send {}", format_utc(record.at.wall),
                    instrument.name, printable(record.bytes), printable(wanted));
  }
  wanted.clear();
}

void Replay::take_events(std::uint8_t number) {
  LivePipeline& pipeline = life_->pipeline;
  drivers::Device& device = *life_->instruments.at(number).device;
  for (const DeviceEvent& event : device.take_events()) {
    if (const auto* reading = std::get_if<FieldReading>(&event)) {
      pipeline.answers(reading->slot, device.health().identity);
      pipeline.push(*reading);
      deliver();
    } else if (const auto* temperature = std::get_if<TemperatureReading>(&event)) {
      pipeline.push(*temperature);
    } else if (const auto* table = std::get_if<TableReading>(&event)) {
      pipeline.push(*table);
    } else if (const auto* auxiliary = std::get_if<AuxiliaryReading>(&event)) {
      pipeline.push(*auxiliary);
    }
  }
}

void Replay::deliver() {
  life_->pipeline.deliver(
      [this](const Epoch&, const TensorSample& sample, bool) {
        ++counts_.samples;
        line_(encoder_.encode(sample, life_->pipeline.inputs().values()));
      },
      [this](const Gap& gap) { say(gap); });
}

void Replay::say(const Gap& gap) {
  ++counts_.gaps;
  counts_.missing += gap.to_seq - gap.from_seq + 1;
  line_(encode(gap));
}

Result<void> Replay::note(const RawRecord& record) {
  const auto parsed = parse_note(record.bytes);
  if (!parsed) return tl::unexpected(parsed.error());
  if (life_ == nullptr && !std::holds_alternative<LifeNote>(*parsed)) return {};
  return std::visit([this](const auto& n) { return on(n); }, *parsed);
}

Result<void> Replay::on(const LifeNote& note) {
  auto config = config::parse_config(note.config, "the journal's configuration");
  if (!config)
    return fail(ErrorCode::bad_input, config.error().lines.front(), "use the version that wrote it");
  ++counts_.lives;
  life_ = std::make_unique<Life>(*std::move(config));
  SamplerConfig sampler = sampler_config(life_->config);
  sampler.first_seq = note.first_seq;
  life_->pipeline = LivePipeline(sampler, life_->config.geometry(), inputs_of(life_->config));
  if (instead_ != nullptr) {
    if (auto used = use(instead_); !used) return used;
  }
  if (note.before) say(*note.before);
  return {};
}

Result<void> Replay::on(const CalibrationNote& note) {
  if (instead_ != nullptr) return {};
  if (note.json.empty()) {
    life_->pipeline.use(nullptr);
    return {};
  }
  auto calibration = calib::calibration::calibration_from_json_text(note.json);
  if (!calibration) return tl::unexpected(calibration.error());
  return use(std::make_shared<const calib::calibration::Calibration>(*std::move(calibration)));
}

Result<void> Replay::use(std::shared_ptr<const calib::calibration::Calibration> calibration) {
  const calib::sensor::Geometry recorded = life_->config.geometry();
  if (!calibration->geometry.agrees_with(recorded)) {
    const auto [its, own] = calib::report::names_apart(calibration->geometry, recorded);
    return fail(
        ErrorCode::bad_input,
        fmt::format("calibration {} is of {}, the journal was recorded by {}", calibration->id, its, own),
        "name a calibration of the array that was recorded; where the array was changed, replay the "
        "files before and after separately");
  }
  life_->pipeline.use(std::move(calibration));
  return {};
}

Result<void> Replay::on(const CalibratingNote& note) {
  life_->pipeline.set_calibrating(note.on);
  return {};
}

Result<void> Replay::on(const ReopenedNote& note) {
  life_->pipeline.reopened(note.slot);
  return {};
}

Result<void> Replay::on(const TableOrder& order) {
  constexpr std::uint8_t kTable = Slot::table().number();
  Life::Instrument& table = life_->instruments.at(kTable);
  carry_out(order, static_cast<drivers::Turntable&>(*table.device));
  table.wanted += table.device->take_output();
  take_events(kTable);
  return {};
}

Result<void> Replay::on(const TableNote& note) {
  life_->pipeline.push(note.reading);
  return {};
}

Result<void> Replay::on(const LostNote& note) {
  counts_.bytes_lost += note.bytes;
  return {};
}

}  // namespace mgtd::daemon::acquire
