// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/bench_rig.h"

#include <sstream>

#include <fmt/format.h>

#include <algorithm>

#include "tests/rig/dcon_instrument.h"
#include "tests/rig/gcs2_instrument.h"
#include "tests/rig/gsm_instrument.h"
#include "tests/rig/obsdaq_instrument.h"
#include "tests/rig/rotations.h"
#include "tests/rig/satellite_receiver.h"

namespace mgtd::rig {
namespace {

constexpr double kClockStep_s = 3;     ///< leap seconds learnt late
constexpr double kDelivery_s = 0.016;  ///< of a USB converter as it comes from the maker
constexpr double kReplug_s = 1;        ///< from one instrument to another
constexpr std::array kLasting{FaultKind::stranger, FaultKind::unplug,  FaultKind::torn,      FaultKind::half,
                              FaultKind::twice,    FaultKind::swap,    FaultKind::freeze,    FaultKind::stall,
                              FaultKind::mute,     FaultKind::late,    FaultKind::saturate,  FaultKind::power,
                              FaultKind::turn,     FaultKind::runaway, FaultKind::backwards, FaultKind::limit,
                              FaultKind::slow,     FaultKind::step};

}  // namespace

bool BenchRig::can_have(std::size_t port, FaultKind kind) const {
  if (kind == FaultKind::runaway || kind == FaultKind::backwards || kind == FaultKind::limit)
    return port == table_port();
  return kind != FaultKind::turn || port < table_port();
}

BenchRig::BenchRig(Scenario scenario, double utc_s) : world_(std::move(scenario)) {
  for (std::size_t slot = 0; slot < world_.sensors(); ++slot) {
    auto digitiser = std::make_unique<ObsdaqInstrument>(world_, static_cast<int>(slot), utc_s);
    if (world_.scenario().autostart) digitiser->autostart(0);
    instruments_.push_back(std::move(digitiser));
  }
  instruments_.push_back(std::make_unique<Gcs2Instrument>(world_));
  names_ = port_names(world_.sensors());
  names_.resize(table_port() + 1);
  if (world_.scenario().scalar) {
    instruments_.push_back(std::make_unique<GsmInstrument>(world_, utc_s));
    names_.emplace_back("scalar");
  }
  if (auto inputs = on_module(world_.scenario().covariates); !inputs.empty()) {
    instruments_.push_back(std::make_unique<DconInstrument>(std::move(inputs)));
    names_.emplace_back("auxiliary");
  }
  for (std::size_t i = 0; i < instruments_.size(); ++i)
    wires_.emplace_back(instruments_[i]->baud(), world_.scenario().seed + i);
  for (std::size_t i = 0; i < ports(); ++i)
    whose_.push_back(i < table_port() ? static_cast<std::size_t>(of_sensor(world_.scenario().plugs, i) - 1)
                                      : i);
  for (std::size_t i = 0; i < ports(); ++i) set_delivery(i, own_delivery_s(i));
  plugged_.assign(ports(), true);
  strange_.assign(ports(), false);
  unplugged_.assign(ports(), 0);
  for (std::size_t i = 0; i < ports(); ++i)
    stranger_.push_back(std::make_unique<SatelliteReceiver>(instruments_[i]->baud()));
}

void BenchRig::advance_all(double now_s) {
  for (std::size_t i = 0; i < ports(); ++i) advance(i, now_s);
}

void BenchRig::advance(std::size_t port, double now_s) {
  plugged_in(port).advance(now_s);
  stranger_.at(port)->advance(now_s);
  std::vector<Utterance> words = at_cable(port).take_utterances();
  static_cast<void>((strange_[port] ? plugged_in(port) : *stranger_[port]).take_utterances());
  for (Utterance& said : words) {
    if (plugged_[port]) wires_[port].push(std::move(said));
  }
}

void BenchRig::write(std::size_t port, std::string_view bytes, double now_s) {
  if (!plugged_.at(port) || bytes.empty()) return;
  advance_all(now_s);
  at_cable(port).receive(bytes, now_s);
}

std::string BenchRig::read(std::size_t port, double now_s) {
  advance(port, now_s);
  return wires_[port].pull(now_s);
}

void BenchRig::drop(std::size_t port, double now_s) {
  advance(port, now_s);
  wires_[port].clear();
}

void BenchRig::out_for_a_second(std::size_t port, double now_s) {
  plug(port, false);
  forget_endings(port, FaultKind::unplug);
  endings_.push_back({now_s + kReplug_s, port, FaultKind::unplug});
}

void BenchRig::exchange(std::size_t port, std::size_t other, double now_s) {
  std::swap(whose_.at(port), whose_.at(other));
  out_for_a_second(port, now_s);
  out_for_a_second(other, now_s);
}

tl::expected<void, std::string> BenchRig::apply(const Fault& fault, double now_s) {
  const auto number = [this](const std::string& name) {
    return static_cast<std::size_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
  };
  const std::size_t port = number(fault.port);
  if (port >= ports()) return tl::unexpected(fmt::format("this rig has no {}", fault.port));
  advance_all(now_s);
  if (fault.kind == FaultKind::restore) {
    for (const FaultKind kind : kLasting) {
      if (can_have(port, kind)) set(port, kind, false, now_s);
      forget_endings(port, kind);
    }
    const auto own = static_cast<std::size_t>(std::find(whose_.begin(), whose_.end(), port) - whose_.begin());
    if (own != port) exchange(port, own, now_s);
    std::erase_if(endings_, [&](const Ending& e) {
      return e.kind == FaultKind::exchange && (e.port == port || e.other == port);
    });
  } else if (fault.kind == FaultKind::exchange) {
    exchange(port, number(fault.other), now_s);
    if (fault.for_s) endings_.push_back({now_s + *fault.for_s, port, fault.kind, number(fault.other)});
  } else if (fault.kind == FaultKind::garbage) {
    if (plugged_[port]) wires_[port].garbage(now_s);
  } else if (fault.kind == FaultKind::clock) {
    instruments_[port]->step_clock(kClockStep_s);
  } else if (fault.kind == FaultKind::rate) {
    instruments_[port]->halve_rate();
  } else {
    set(port, fault.kind, true, now_s);
    forget_endings(port, fault.kind);
    if (fault.for_s) endings_.push_back({now_s + *fault.for_s, port, fault.kind});
  }
  return {};
}

double BenchRig::own_delivery_s(std::size_t port) const {
  return port < table_port() ? of_sensor(world_.scenario().delivery_s, port) : 0;
}

/// The timers of the ports tick at different moments.
void BenchRig::set_delivery(std::size_t port, double step_s) {
  const double slow = port < table_port() ? 1 + 1e-6 * of_sensor(world_.scenario().delivery_ppm, port) : 1;
  const double phase_s = step_s * static_cast<double>(port) / static_cast<double>(ports());
  wires_[port].set_delivery(step_s * slow, phase_s);
}

void BenchRig::plug(std::size_t port, bool in) {
  if (plugged_[port] && !in) ++unplugged_[port];
  plugged_[port] = in;
  wires_[port].clear();
}

void BenchRig::set(std::size_t port, FaultKind kind, bool on, double now_s) {
  Instrument& instrument = *instruments_[port];
  switch (kind) {
    case FaultKind::unplug:
      return plug(port, !on);
    case FaultKind::stranger:
      if (strange_[port] == on) return;
      strange_[port] = on;
      return out_for_a_second(port, now_s);
    case FaultKind::turn:
      return world_.set_turned(static_cast<int>(port), on, now_s);
    case FaultKind::torn:
      return wires_[port].set_torn(on);
    case FaultKind::half:
      return wires_[port].set_half(on);
    case FaultKind::twice:
      return wires_[port].set_twice(on);
    case FaultKind::swap:
      return wires_[port].set_swapped(on);
    case FaultKind::freeze:
      return instrument.set_frozen(on);
    case FaultKind::stall:
      return instrument.set_silent(on);
    case FaultKind::mute:
      return instrument.set_mute(on);
    case FaultKind::late:
      return wires_[port].set_late(on);
    case FaultKind::saturate:
      return instrument.set_saturated(on);
    case FaultKind::slow:
      return instrument.set_slow(on);
    case FaultKind::step:
      return set_delivery(port, on ? kDelivery_s : own_delivery_s(port));
    case FaultKind::power:
      return instrument.set_power(!on, now_s);
    default:
      return set_table(kind, on, now_s);
  }
}

void BenchRig::set_table(FaultKind kind, bool on, double now_s) {
  auto& table = dynamic_cast<Gcs2Instrument&>(*instruments_[table_port()]);
  if (kind == FaultKind::runaway) world_.set_runaway(on, now_s);
  if (kind == FaultKind::backwards) table.set_backwards(on);
  if (kind == FaultKind::limit) table.set_at_limit(on);
}

void BenchRig::forget_endings(std::size_t port, FaultKind kind) {
  std::erase_if(endings_, [&](const Ending& e) { return e.port == port && e.kind == kind; });
}

void BenchRig::run_script(double now_s) {
  const auto& script = world_.scenario().faults;
  for (; next_fault_ < script.size() && script[next_fault_].at_s <= now_s; ++next_fault_) {
    const auto fault = parse_fault(script[next_fault_].text, world_.sensors());
    // The scenario's words were checked when it was read; a port it has not got is not there to fail.
    if (fault) static_cast<void>(apply(*fault, now_s));
  }
  // The end of one may begin another.
  std::vector<Ending> over;
  std::erase_if(endings_, [&](const Ending& ending) {
    if (ending.at_s <= now_s) over.push_back(ending);
    return ending.at_s <= now_s;
  });
  if (!over.empty()) advance_all(now_s);
  for (const Ending& ending : over) {
    if (ending.kind == FaultKind::exchange)
      exchange(ending.port, ending.other, now_s);
    else
      set(ending.port, ending.kind, false, now_s);
  }
}

bool BenchRig::mount(std::string_view line, double now_s) {
  std::istringstream in{std::string(line)};
  std::string word;
  double azimuth_deg = 0, pitch_deg = 0, roll_deg = 0;
  if (!(in >> word >> azimuth_deg >> pitch_deg >> roll_deg) || word != "mount") return false;
  advance_all(now_s);
  world_.remount(about_z(azimuth_deg) * about_y(pitch_deg) * about_x(roll_deg), now_s);
  return true;
}

bool BenchRig::surroundings(std::string_view line, double now_s) {
  std::istringstream in{std::string(line)};
  std::string word;
  if (!(in >> word)) return false;
  if (word == "coil") {
    double share = 0;
    if (!(in >> share) || !(share > 0)) return false;
    advance_all(now_s);
    world_.set_coil(share, now_s);
    return true;
  }
  World::Heating heating{.stays = word == "heat"};
  if ((word != "warm" && word != "heat") || !(in >> heating.degC >> heating.tau_s) || !(heating.tau_s > 0))
    return false;
  double after_s = 0;
  if (in >> heating.head) in >> after_s;
  heating.begin_s = now_s + after_s;
  advance_all(now_s);
  world_.heat(heating, now_s);
  return true;
}

}  // namespace mgtd::rig
