// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "tests/rig/fault.h"
#include "tests/rig/instrument.h"
#include "tests/rig/wire.h"
#include "tests/rig/world.h"

/// A BenchRig is the whole simulated rig in virtual time: one world, and a cable to each instrument. Tests
/// drive it byte by byte; the server puts it on ptys. The same scenario and the same bytes at the same times
/// give the same bytes back.
namespace mgtd::rig {

class BenchRig {
 public:
  /// `utc_s`: the hour on the instruments' clocks when the rig is switched on.
  BenchRig(Scenario scenario, double utc_s);

  /// In the order of port_names(); the scalar reference and the auxiliary inputs are left out where the
  /// scenario has none.
  [[nodiscard]] std::size_t ports() const { return instruments_.size(); }
  [[nodiscard]] std::string_view name(std::size_t port) const { return names_.at(port); }
  void write(std::size_t port, std::string_view bytes, double now_s);
  /// Everything that has come out of the cable by now; empty while unplugged.
  [[nodiscard]] std::string read(std::size_t port, double now_s);
  /// The same when no host listens: the bytes are gone.
  void drop(std::size_t port, double now_s);
  [[nodiscard]] bool plugged(std::size_t port) const { return plugged_.at(port); }
  /// How often the port was unplugged: a cable that was out and is in again is a new port.
  [[nodiscard]] std::uint64_t unplugged(std::size_t port) const { return unplugged_.at(port); }

  /// Applies a fault at once; refuses a port this rig has not got, in words.
  [[nodiscard]] tl::expected<void, std::string> apply(const Fault& fault, double now_s);
  /// Ends faults whose time is over and starts those of the scenario; call before read().
  void run_script(double now_s);

  /// The array on the table, by hand: "mount AZIMUTH PITCH ROLL", deg. False: that is something else.
  bool mount(std::string_view line, double now_s);
  /// What a hand changes around it: "warm DEGC TAU_S [HEAD [AFTER_S]]" (and lets cool again; head 0: all),
  /// "heat DEGC TAU_S [HEAD [AFTER_S]]" (and keeps warm), "coil SHARE" (of the site's field). False: that is
  /// something else.
  bool surroundings(std::string_view line, double now_s);

  /// Whose plug is in the port: of fluxgate2 it may be fluxgate4.
  [[nodiscard]] std::string_view instrument(std::size_t port) const { return names_.at(whose_.at(port)); }

  [[nodiscard]] World& world() { return world_; }
  [[nodiscard]] const World& world() const { return world_; }

 private:
  struct Ending {
    double at_s;
    std::size_t port;
    FaultKind kind;
    std::size_t other{0};  ///< of exchange
  };
  /// Lets a port's instrument speak up to now, onto its cable.
  void advance(std::size_t port, double now_s);
  /// Before the world changes: what was measured until now, though nobody has read it, does not know of it.
  void advance_all(double now_s);
  void set(std::size_t port, FaultKind kind, bool on, double now_s);
  void plug(std::size_t port, bool in);
  void set_delivery(std::size_t port, double step_s);
  [[nodiscard]] double own_delivery_s(std::size_t port) const;
  void forget_endings(std::size_t port, FaultKind kind);

  /// Whose plug is in the port, whatever is there for a while.
  [[nodiscard]] Instrument& plugged_in(std::size_t port) { return *instruments_.at(whose_.at(port)); }
  /// Who is at the end of the cable.
  [[nodiscard]] Instrument& at_cable(std::size_t port) {
    return strange_.at(port) ? *stranger_.at(port) : plugged_in(port);
  }
  /// Two plugs change places: each is out for a second.
  void exchange(std::size_t port, std::size_t other, double now_s);
  void out_for_a_second(std::size_t port, double now_s);
  void set_table(FaultKind kind, bool on, double now_s);

  /// The digitisers' ports come first, then the table's.
  [[nodiscard]] std::size_t table_port() const { return world_.sensors(); }
  /// Whether what is behind this port can have the fault at all.
  [[nodiscard]] bool can_have(std::size_t port, FaultKind kind) const;

  World world_;
  std::vector<std::string> names_;
  std::vector<std::unique_ptr<Instrument>> instruments_, stranger_;
  std::vector<std::size_t> whose_;  ///< number of the instrument whose plug is in a port
  std::vector<Wire> wires_;
  std::vector<bool> plugged_, strange_;
  std::vector<std::uint64_t> unplugged_;
  std::vector<Ending> endings_;
  std::size_t next_fault_{0};
};

}  // namespace mgtd::rig
