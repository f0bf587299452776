// SPDX-License-Identifier: Apache-2.0
#include "daemon/acquire/instruments.h"

namespace mgtd::daemon {
namespace {

constexpr std::size_t kTable = kSensors;
constexpr Duration kTick = std::chrono::milliseconds(20);
/// drivers::Direction as the journal calls it.
constexpr std::array<RawDirection, 6> kRecorded{RawDirection::received, RawDirection::sent,
                                                RawDirection::opened,   RawDirection::closed,
                                                RawDirection::tick,     RawDirection::ended};

}  // namespace

std::vector<const DeviceConfig*> devices_of(const Config& config) {
  std::vector<const DeviceConfig*> out;
  for (const DeviceConfig& sensor : config.sensors) out.push_back(&sensor);
  out.push_back(&config.table);
  out.push_back(config.scalar ? &*config.scalar : nullptr);
  for (const DeviceConfig& auxiliary : config.auxiliary) out.push_back(&auxiliary);
  return out;
}

void carry_out(const TableOrder& order, drivers::Turntable& table) {
  switch (order.what) {
    case TableOrder::What::home:
      return table.home();
    case TableOrder::What::move:
      return table.move_to(order.target);
    case TableOrder::What::stop:
      return table.stop();
  }
}

Instruments::Instruments(boost::asio::io_context& io, const drivers::Clock& clock, const Config& config,
                         Callbacks callbacks)
    : callbacks_(std::move(callbacks)), clock_(clock), timer_(io) {
  const auto devices = devices_of(config);
  for (std::size_t i = 0; i < devices.size(); ++i) {
    if (devices[i] != nullptr) add(io, clock, *devices[i], static_cast<std::uint8_t>(i));
  }
}

void Instruments::add(boost::asio::io_context& io, const drivers::Clock& clock, const DeviceConfig& device,
                      std::uint8_t number) {
  const std::string name = device.name;
  if (device.port.empty()) {
    instruments_.push_back({name, device.driver, {}, device.device, nullptr});
    return;
  }
  drivers::PortCallbacks port;
  port.on_events = [this, name](std::vector<DeviceEvent> events) {
    for (const DeviceEvent& event : events) callbacks_.on_event(name, event);
  };
  port.on_state = [this, name](const LinkHealth& health) { callbacks_.on_link(name, health); };
  port.on_raw = [this, number](drivers::Direction direction, std::span<const std::byte> bytes, Stamp at) {
    callbacks_.on_raw({.device = number,
                       .direction = kRecorded.at(static_cast<std::size_t>(direction)),
                       .at = at,
                       .bytes = {reinterpret_cast<const char*>(bytes.data()), bytes.size()}});
  };
  instruments_.push_back(
      {name, device.driver, device.port, device.device,
       std::make_unique<drivers::PortLink>(io, clock, drivers::PortSettings{device.port, device.baud},
                                           device.device, std::move(port))});
}

void Instruments::start() {
  bool without_port = false;
  for (Instrument& instrument : instruments_) {
    if (instrument.link != nullptr) {
      instrument.link->start();
      continue;
    }
    without_port = true;
    instrument.device->on_open(clock_.now());
    callbacks_.on_link(instrument.name, instrument.device->health());
  }
  if (without_port) listen();
}

void Instruments::listen() {
  for (const Instrument& instrument : instruments_) {
    if (instrument.link != nullptr) continue;
    instrument.device->on_tick(clock_.now());
    deliver(instrument);
  }
  timer_.wait(kTick, [this] { listen(); });
}

void Instruments::deliver(const Instrument& instrument) {
  for (const DeviceEvent& event : instrument.device->take_events()) {
    if (const auto* reading = std::get_if<TableReading>(&event))
      callbacks_.on_note(TableNote{*reading}, reading->arrival);
    callbacks_.on_event(instrument.name, event);
  }
}

void Instruments::shutdown() {
  timer_.cancel();
  if (instruments_[kTable].link != nullptr) instruments_[kTable].link->shutdown();
  for (Instrument& instrument : instruments_)
    if (instrument.link != nullptr) instrument.link->shutdown();
}

drivers::Turntable& Instruments::table() {
  return static_cast<drivers::Turntable&>(*instruments_[kTable].device);
}

void Instruments::order(const TableOrder& order) {
  if (instruments_[kTable].link != nullptr) callbacks_.on_note(order, clock_.now());
  carry_out(order, table());
  if (instruments_[kTable].link != nullptr) instruments_[kTable].link->flush();
}

LinkHealth Instruments::health(const Instrument& instrument) {
  return instrument.link != nullptr ? instrument.link->health() : instrument.device->health();
}

std::vector<DeviceStatus> Instruments::status() const {
  std::vector<DeviceStatus> out;
  for (const Instrument& i : instruments_) out.push_back({i.name, i.driver, i.port, health(i)});
  return out;
}

std::vector<std::pair<std::string, LinkHealth>> Instruments::links() const {
  std::vector<std::pair<std::string, LinkHealth>> out;
  for (const Instrument& i : instruments_) out.emplace_back(i.name, health(i));
  return out;
}

}  // namespace mgtd::daemon
