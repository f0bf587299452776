// SPDX-License-Identifier: Apache-2.0
#include "tests/rig/bench_rig.h"

#include <fmt/format.h>

#include <algorithm>

#include "tests/rig/gcs2_instrument.h"
#include "tests/rig/gsm_instrument.h"
#include "tests/rig/obsdaq_instrument.h"

namespace mgtd::rig {

BenchRig::BenchRig(Scenario scenario, double utc_s) : world_(std::move(scenario)) {
  for (int slot = 0; slot < 4; ++slot)
    instruments_.push_back(std::make_unique<ObsdaqInstrument>(world_, slot, utc_s));
  instruments_.push_back(std::make_unique<Gcs2Instrument>(world_));
  if (world_.scenario().scalar) instruments_.push_back(std::make_unique<GsmInstrument>(world_, utc_s));
  for (std::size_t i = 0; i < instruments_.size(); ++i)
    wires_.emplace_back(instruments_[i]->baud(), world_.scenario().seed + i);
  plugged_.assign(instruments_.size(), true);
}

void BenchRig::write(std::size_t port, std::string_view bytes, double now_s) {
  if (plugged_.at(port) && !bytes.empty()) instruments_.at(port)->receive(bytes, now_s);
}

std::string BenchRig::read(std::size_t port, double now_s) {
  Instrument& instrument = *instruments_.at(port);
  instrument.advance(now_s);
  Wire& wire = wires_.at(port);
  std::string said = instrument.take_output();
  if (!plugged_.at(port)) return {};
  wire.push(std::move(said));
  return wire.pull(now_s);
}

tl::expected<void, std::string> BenchRig::apply(const Fault& fault, double now_s) {
  const auto found = std::find(kPortNames.begin(), kPortNames.end(), fault.port);
  const auto port = static_cast<std::size_t>(found - kPortNames.begin());
  if (port >= ports())
    return tl::unexpected(
        fmt::format("no port '{}'; there are: {}", fault.port, fmt::join(kPortNames, ", ")));
  switch (fault.kind) {
    case FaultKind::unplug:
      plugged_[port] = false;
      wires_[port].clear();
      break;
    case FaultKind::garbage:
      wires_[port].garbage();
      break;
    case FaultKind::torn:
      wires_[port].set_torn(true);
      break;
    case FaultKind::freeze:
      instruments_[port]->set_frozen(true);
      break;
    case FaultKind::stall:
      instruments_[port]->set_silent(true);
      break;
    case FaultKind::restore:
      for (const FaultKind kind : {FaultKind::unplug, FaultKind::torn, FaultKind::freeze, FaultKind::stall})
        end(port, kind);
      break;
  }
  if (fault.for_s) endings_.push_back({now_s + *fault.for_s, port, fault.kind});
  return {};
}

void BenchRig::end(std::size_t port, FaultKind kind) {
  switch (kind) {
    case FaultKind::unplug:
      plugged_[port] = true;
      break;
    case FaultKind::torn:
      wires_[port].set_torn(false);
      break;
    case FaultKind::freeze:
      instruments_[port]->set_frozen(false);
      break;
    case FaultKind::stall:
      instruments_[port]->set_silent(false);
      break;
    case FaultKind::garbage:
    case FaultKind::restore:
      break;
  }
}

void BenchRig::run_script(double now_s) {
  const auto& script = world_.scenario().faults;
  for (; next_fault_ < script.size() && script[next_fault_].at_s <= now_s; ++next_fault_) {
    if (const auto fault = parse_fault(script[next_fault_].text)) static_cast<void>(apply(*fault, now_s));
  }
  std::erase_if(endings_, [&](const Ending& ending) {
    if (ending.at_s > now_s) return false;
    end(ending.port, ending.kind);
    return true;
  });
}

}  // namespace mgtd::rig
