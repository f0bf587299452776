// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "daemon/config/config.h"
#include "drivers/clock.h"
#include "drivers/patient_timer.h"
#include "drivers/port_link.h"
#include "proto/journal_note.h"
#include "proto/raw_log.h"
#include "proto/status_report.h"

/// The instruments of the rig on their ports: four sensors, the table and, where configured, the scalar
/// reference and auxiliary inputs. Opens and keeps them, and tells its owner what they say. Does not know
/// what their words are for.
namespace mgtd::daemon {

/// Every device at its number in the journal: sensors, table, scalar (null without one), auxiliary inputs.
[[nodiscard]] std::vector<const DeviceConfig*> devices_of(const Config& config);

void carry_out(const TableOrder& order, drivers::Turntable& table);

class Instruments {
 public:
  struct Callbacks {
    std::function<void(const std::string& device, const DeviceEvent& event)> on_event;
    /// The link became live, or is no longer, or has another reason for it.
    std::function<void(const std::string& device, const LinkHealth& health)> on_link;
    std::function<void(const RawRecord& record)> on_raw;
    /// What the journal has to know beside the wires.
    std::function<void(const JournalNote& note, Stamp at)> on_note;
  };

  /// `io` and `clock` outlive this.
  Instruments(boost::asio::io_context& io, const drivers::Clock& clock, const Config& config,
              Callbacks callbacks);

  void start();
  /// The table is told to stop, then every port is closed.
  void shutdown();

  [[nodiscard]] drivers::Turntable& table();
  /// Asks the table and sends what it says to that.
  void order(const TableOrder& order);
  /// Who answers in the place of a sensor, as it told last.
  [[nodiscard]] const std::string& told(int slot) const {
    return instruments_.at(static_cast<std::size_t>(slot)).device->health().identity;
  }
  [[nodiscard]] std::vector<DeviceStatus> status() const;
  [[nodiscard]] std::vector<std::pair<std::string, LinkHealth>> links() const;

 private:
  struct Instrument {
    std::string name, driver, port;
    std::shared_ptr<drivers::Device> device;
    std::unique_ptr<drivers::PortLink> link;  ///< null: the device has no port
  };
  void add(boost::asio::io_context& io, const drivers::Clock& clock, const DeviceConfig& device,
           std::uint8_t number);
  [[nodiscard]] static LinkHealth health(const Instrument& instrument);
  /// What a device without a port has to say.
  void listen();
  void deliver(const Instrument& instrument);

  Callbacks callbacks_;
  const drivers::Clock& clock_;
  drivers::PatientTimer timer_;
  std::vector<Instrument> instruments_;  ///< s1 .. s4, table, scalar, aux1, ...
};

}  // namespace mgtd::daemon
