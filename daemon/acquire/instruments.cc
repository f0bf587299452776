// SPDX-License-Identifier: Apache-2.0
#include "daemon/acquire/instruments.h"

#include <array>

namespace mgtd::daemon::acquire {
namespace {

/// drivers::Direction as the journal calls it.
constexpr std::array<RawDirection, 6> kRecorded{RawDirection::received, RawDirection::sent,
                                                RawDirection::opened,   RawDirection::closed,
                                                RawDirection::tick,     RawDirection::ended};

}  // namespace

std::vector<std::pair<Slot, const config::DeviceConfig*>> devices_of(const config::Config& config) {
  std::vector<std::pair<Slot, const config::DeviceConfig*>> out;
  for (std::size_t i = 0; i < config.sensors.size(); ++i)
    out.emplace_back(Slot::sensor(static_cast<int>(i)), &config.sensors[i]);
  out.emplace_back(Slot::table(), &config.table);
  if (config.scalar) out.emplace_back(Slot::scalar(), &*config.scalar);
  for (std::size_t i = 0; i < config.auxiliary.size(); ++i)
    out.emplace_back(Slot::auxiliary(static_cast<int>(i)), &config.auxiliary[i]);
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

Instruments::Instruments(const config::Config& config, Callbacks callbacks)
    : callbacks_(std::move(callbacks)) {
  for (const auto& [slot, device] : devices_of(config)) {
    Instrument& instrument = instruments_[slot];
    slots_.push_back(slot);
    instrument.driver = device->driver;
    instrument.port = device->port;
    instrument.link =
        std::make_unique<drivers::DeviceLink>(device->device, callbacks_of(slot, !instrument.port.empty()));
  }
}

/// The journal holds what crosses ports, nothing of a device that has none.
drivers::LinkCallbacks Instruments::callbacks_of(Slot slot, bool has_port) {
  drivers::LinkCallbacks out;
  out.on_send = [this, slot](std::string_view bytes) { callbacks_.on_send(slot, bytes); };
  out.on_events = [this, slot](const std::vector<DeviceEvent>& events, Stamp now) {
    for (const DeviceEvent& event : events) callbacks_.on_event(slot, event, now);
  };
  out.on_state = [this, slot](const LinkHealth& health, Stamp now) { callbacks_.on_link(slot, health, now); };
  if (!has_port) return out;
  out.on_raw = [this, slot](drivers::Direction direction, std::span<const std::byte> bytes, Stamp at) {
    callbacks_.on_raw({.device = slot.number(),
                       .direction = kRecorded.at(static_cast<std::size_t>(direction)),
                       .at = at,
                       .bytes = {reinterpret_cast<const char*>(bytes.data()), bytes.size()}});
  };
  return out;
}

void Instruments::start(Stamp now) {
  for (const Slot slot : slots_) {
    if (!has_port(slot)) link(slot).opened(now);
  }
}

void Instruments::tick(Stamp now) {
  for (const Slot slot : slots_) {
    if (!has_port(slot)) link(slot).tick(now);
  }
}

std::vector<DeviceStatus> Instruments::status() const {
  std::vector<DeviceStatus> out;
  for (const Slot slot : slots_)
    out.push_back({slot.name(), at(slot).driver, at(slot).port, link(slot).health()});
  return out;
}

std::vector<std::pair<Slot, LinkHealth>> Instruments::links() const {
  std::vector<std::pair<Slot, LinkHealth>> out;
  for (const Slot slot : slots_) out.emplace_back(slot, link(slot).health());
  return out;
}

}  // namespace mgtd::daemon::acquire
