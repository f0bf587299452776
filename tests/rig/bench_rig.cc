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

namespace mgtd::rig {
namespace {

constexpr double kClockStep_s = 3;  ///< leap seconds learnt late
constexpr std::size_t kTable = 4;
constexpr std::array kLasting{FaultKind::unplug, FaultKind::torn, FaultKind::freeze, FaultKind::stall,
                              FaultKind::saturate};

}  // namespace

BenchRig::BenchRig(Scenario scenario, double utc_s) : world_(std::move(scenario)) {
  for (int slot = 0; slot < 4; ++slot) {
    auto digitiser = std::make_unique<ObsdaqInstrument>(world_, slot, utc_s);
    if (world_.scenario().autostart) digitiser->autostart(0);
    instruments_.push_back(std::move(digitiser));
  }
  instruments_.push_back(std::make_unique<Gcs2Instrument>(world_));
  names_.assign(kPortNames.begin(), kPortNames.begin() + kTable + 1);
  if (world_.scenario().scalar) {
    instruments_.push_back(std::make_unique<GsmInstrument>(world_, utc_s));
    names_.push_back("scalar");
  }
  if (auto inputs = recorded(world_.scenario().covariates); !inputs.empty()) {
    instruments_.push_back(std::make_unique<DconInstrument>(std::move(inputs)));
    names_.push_back("auxiliary");
  }
  for (std::size_t i = 0; i < instruments_.size(); ++i)
    wires_.emplace_back(instruments_[i]->baud(), world_.scenario().seed + i);
  plugged_.assign(instruments_.size(), true);
}

void BenchRig::advance(std::size_t port, double now_s) {
  instruments_.at(port)->advance(now_s);
  for (Utterance& said : instruments_[port]->take_utterances()) {
    if (plugged_[port]) wires_[port].push(std::move(said));
  }
}

void BenchRig::write(std::size_t port, std::string_view bytes, double now_s) {
  if (!plugged_.at(port) || bytes.empty()) return;
  // What was measured before a command must not know of it.
  for (std::size_t i = 0; i < ports(); ++i) advance(i, now_s);
  instruments_[port]->receive(bytes, now_s);
}

std::string BenchRig::read(std::size_t port, double now_s) {
  advance(port, now_s);
  return wires_[port].pull(now_s);
}

void BenchRig::drop(std::size_t port, double now_s) {
  advance(port, now_s);
  wires_[port].clear();
}

tl::expected<void, std::string> BenchRig::apply(const Fault& fault, double now_s) {
  const auto port =
      static_cast<std::size_t>(std::find(names_.begin(), names_.end(), fault.port) - names_.begin());
  if (port >= ports()) return tl::unexpected(fmt::format("this rig has no {}", fault.port));
  for (std::size_t i = 0; i < ports(); ++i) advance(i, now_s);
  if (fault.kind == FaultKind::restore) {
    for (const FaultKind kind : kLasting) {
      set(port, kind, false);
      forget_endings(port, kind);
    }
  } else if (fault.kind == FaultKind::garbage) {
    if (plugged_[port]) wires_[port].garbage(now_s);
  } else if (fault.kind == FaultKind::clock) {
    instruments_[port]->step_clock(kClockStep_s);
  } else {
    set(port, fault.kind, true);
    forget_endings(port, fault.kind);
    if (fault.for_s) endings_.push_back({now_s + *fault.for_s, port, fault.kind});
  }
  return {};
}

void BenchRig::set(std::size_t port, FaultKind kind, bool on) {
  Instrument& instrument = *instruments_[port];
  if (kind == FaultKind::unplug) {
    plugged_[port] = !on;
    wires_[port].clear();
  } else if (kind == FaultKind::torn) {
    wires_[port].set_torn(on);
  } else if (kind == FaultKind::freeze) {
    instrument.set_frozen(on);
  } else if (kind == FaultKind::stall) {
    instrument.set_silent(on);
  } else if (kind == FaultKind::saturate) {
    instrument.set_saturated(on);
  }
}

void BenchRig::forget_endings(std::size_t port, FaultKind kind) {
  std::erase_if(endings_, [&](const Ending& e) { return e.port == port && e.kind == kind; });
}

void BenchRig::run_script(double now_s) {
  const auto& script = world_.scenario().faults;
  for (; next_fault_ < script.size() && script[next_fault_].at_s <= now_s; ++next_fault_) {
    const auto fault = parse_fault(script[next_fault_].text);
    // The scenario's words were checked when it was read; a port it has not got is not there to fail.
    if (fault) static_cast<void>(apply(*fault, now_s));
  }
  std::erase_if(endings_, [&](const Ending& ending) {
    if (ending.at_s > now_s) return false;
    set(ending.port, ending.kind, false);
    return true;
  });
}

bool BenchRig::mount(std::string_view line, double now_s) {
  std::istringstream in{std::string(line)};
  std::string word;
  double azimuth_deg = 0, pitch_deg = 0, roll_deg = 0;
  if (!(in >> word >> azimuth_deg >> pitch_deg >> roll_deg) || word != "mount") return false;
  world_.remount(about_z(azimuth_deg) * about_y(pitch_deg) * about_x(roll_deg), now_s);
  return true;
}

}  // namespace mgtd::rig
