// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "daemon/config/config.h"
#include "drivers/device_link.h"
#include "proto/journal_note.h"
#include "proto/raw_log.h"
#include "proto/slot.h"
#include "proto/status_report.h"

/// Instruments holds the links of all instruments of the rig: the sensors, the table and, where configured,
/// the scalar reference and auxiliary inputs. It tells its owner what they say. It knows neither what that is
/// for, nor the ports.
namespace mgtd::daemon::acquire {

/// Every device of the configuration in its slot: sensors, table, scalar reference, auxiliary modules.
[[nodiscard]] std::vector<std::pair<Slot, const config::DeviceConfig*>> devices_of(
    const config::Config& config);

void carry_out(const TableOrder& order, drivers::Turntable& table);

class Instruments {
 public:
  struct Callbacks {
    std::function<void(Slot slot, std::string_view bytes)> on_send;
    std::function<void(Slot slot, const DeviceEvent& event, Stamp now)> on_event;
    /// The link became live, or is no longer, or has another reason for it.
    std::function<void(Slot slot, const LinkHealth& health, Stamp now)> on_link;
    std::function<void(const RawRecord& record)> on_raw;
  };

  Instruments(const config::Config& config, Callbacks callbacks);
  Instruments(const Instruments&) = delete;
  Instruments& operator=(const Instruments&) = delete;

  /// Those that are there, in the order of devices_of().
  [[nodiscard]] const std::vector<Slot>& slots() const { return slots_; }
  [[nodiscard]] drivers::DeviceLink& link(Slot slot) { return *at(slot).link; }
  [[nodiscard]] const drivers::DeviceLink& link(Slot slot) const { return *at(slot).link; }
  /// A table that is turned by hand has none.
  [[nodiscard]] bool has_port(Slot slot) const { return !at(slot).port.empty(); }
  [[nodiscard]] drivers::Turntable& table() {
    return static_cast<drivers::Turntable&>(link(Slot::table()).device());
  }

  /// Opens what has no port.
  void start(Stamp now);
  /// Tells the time to what has no port.
  void tick(Stamp now);

  [[nodiscard]] std::vector<DeviceStatus> status() const;
  [[nodiscard]] std::vector<std::pair<Slot, LinkHealth>> links() const;

 private:
  struct Instrument {
    std::string driver, port;
    std::unique_ptr<drivers::DeviceLink> link;
  };
  [[nodiscard]] Instrument& at(Slot slot) { return instruments_.at(slot); }
  [[nodiscard]] const Instrument& at(Slot slot) const { return instruments_.at(slot); }
  [[nodiscard]] drivers::LinkCallbacks callbacks_of(Slot slot, bool has_port);

  Callbacks callbacks_;
  std::vector<Slot> slots_;
  std::map<Slot, Instrument> instruments_;
};

}  // namespace mgtd::daemon::acquire
