// SPDX-License-Identifier: Apache-2.0
#include "daemon/core/daemon_core.h"

#include <fmt/format.h>

#include <utility>

#include "calib/calibration/calibration_json.h"
#include "drivers/manual_table.h"

namespace mgtd::daemon::core {
namespace {

bool is_rearranged(calib::criticism::live::LiveState state) {
  return state == calib::criticism::live::LiveState::exchanged ||
         state == calib::criticism::live::LiveState::turned;
}

}  // namespace

DaemonCore::DaemonCore(const config::Config& config, CoreActions& actions)
    : config_(config),
      actions_(actions),
      instruments_(
          config,
          {.on_send = [this](Slot slot, std::string_view bytes) { actions_.send(slot, bytes); },
           .on_event = [this](Slot slot, const DeviceEvent& event, Stamp now) { on_event(slot, event, now); },
           .on_link = [this](Slot slot, const LinkHealth& health, Stamp now) { on_link(slot, health, now); },
           .on_raw = [this](const RawRecord& record) { on_raw(record); }}),
      pipeline_(acquire::sampler_config(config), config.geometry(), acquire::inputs_of(config)),
      run_([this](const run::Action& action, Stamp now) { carry_out(action, now); }) {}

void DaemonCore::begin(const LifeNote& life, Stamp now) {
  note(life, now);
  acquire::SamplerConfig sampler = acquire::sampler_config(config_);
  sampler.first_seq = life.first_seq;
  pipeline_ = acquire::LivePipeline(sampler, config_.geometry(), acquire::inputs_of(config_));
}

void DaemonCore::use(std::shared_ptr<const calib::calibration::Calibration> calibration, Stamp now) {
  note(CalibrationNote{calibration ? calib::calibration::to_json_text(*calibration) : std::string()}, now);
  pipeline_.use(std::move(calibration));
}

void DaemonCore::on_event(Slot slot, const DeviceEvent& event, Stamp now) {
  if (const auto* reading = std::get_if<FieldReading>(&event)) {
    pipeline_.answers(reading->slot, instruments_.link(slot).device().health().identity);
    pipeline_.push(*reading);
    return deliver(now);
  }
  if (const auto* temperature = std::get_if<TemperatureReading>(&event)) return pipeline_.push(*temperature);
  if (const auto* scalar = std::get_if<ScalarReading>(&event)) return run_.feed(*scalar, now);
  if (const auto* auxiliary = std::get_if<AuxiliaryReading>(&event)) {
    pipeline_.push(*auxiliary);
    return run_.feed(*auxiliary, now);
  }
  if (const auto* table = std::get_if<TableReading>(&event)) {
    if (!instruments_.has_port(slot)) note(TableNote{*table}, table->arrival);
    pipeline_.push(*table);
    return run_.feed(*table, now);
  }
  if (const auto* said = std::get_if<DeviceNote>(&event)) return inform(slot.name(), said->what, now.mono);
  if (const auto* fault = std::get_if<DeviceFault>(&event)) {
    warn(slot.name(), fault->remedy.empty() ? fault->what : fault->what + "; " + fault->remedy, now.mono);
    run_.feed(run::DeviceFaulted{slot, *fault}, now);
  }
}

void DaemonCore::on_link(Slot slot, const LinkHealth& health, Stamp now) {
  const auto [known, first] = link_states_.try_emplace(slot, LinkState::absent);
  if (!first && known->second == health.state) return;
  const bool answered = answers(std::exchange(known->second, health.state));
  if (answers(health.state) && !answered) {
    came_back(slot, health, now);
  } else if (health.state == LinkState::live) {
    inform(slot.name(), "live again", now.mono);
  }
  if (health.state == LinkState::live) return;
  const std::string words =
      fmt::format("{}: {}", kLinkStateNames.at(static_cast<std::size_t>(health.state)), health.detail);
  if (health.state == LinkState::probing)
    inform(slot.name(), words, now.mono);
  else
    warn(slot.name(), words, now.mono);
  if (answered && !answers(health.state)) run_.feed(run::DeviceLost{slot, health.detail}, now);
}

void DaemonCore::came_back(Slot slot, const LinkHealth& health, Stamp now) {
  inform(slot.name(), health.identity.empty() ? "live" : "live, " + health.identity, now.mono);
  if (const auto sensor = slot.sensor_index()) {
    note(ReopenedNote{*sensor}, now);
    pipeline_.reopened(*sensor);
  }
  run_.feed(run::LinkSeen{slot, health}, now);  // who it is, before it counts as back
  run_.feed(run::DeviceBack{slot}, now);
}

void DaemonCore::on_raw(const RawRecord& record) {
  settle_calibrating(record.at);
  actions_.record(record);
}

void DaemonCore::note(const JournalNote& note, Stamp at) {
  const std::string text = encode(note);
  actions_.record({.device = kRawDaemon, .direction = RawDirection::note, .at = at, .bytes = text});
}

/// Between records only, so that a replay does it at the same sample.
void DaemonCore::settle_calibrating(Stamp at) {
  const bool calibrating = run_.active() || probing();
  if (calibrating == calibrating_) return;
  calibrating_ = calibrating;
  pipeline_.set_calibrating(calibrating);
  note(CalibratingNote{calibrating}, at);
}

void DaemonCore::deliver(Stamp now) {
  pipeline_.deliver(
      [&](const Epoch& epoch, const TensorSample& sample, bool finding_changed) {
        if (finding_changed) tell_criticism(now);
        follow_probe(epoch.t.mono, &epoch);
        actions_.publish(epoch, sample, pipeline_.inputs().values());
        run_.feed(epoch, now);
      },
      [&](const Gap& gap) {
        actions_.publish(gap);
        run_.feed(gap, now);
      });
}

void DaemonCore::tick(Stamp now) {
  instruments_.tick(now);  // before the tick is on record: a replay is told in this order
  on_raw({.device = kRawDaemon, .direction = RawDirection::tick, .at = now, .bytes = {}});
  pipeline_.advance(now.mono);
  deliver(now);
  if (run_.active() && run_.fsm()->status(now.mono).state == RunState::preflight) show_links(now);
  run_.feed(run::Tick{}, now);
  follow_probe(now.mono, nullptr);
}

void DaemonCore::every_second(Stamp now) {
  show_links(now);
  tell_left_out(now.mono);
  tell_identity(now.mono);
}

void DaemonCore::show_links(Stamp now) {
  if (!run_.active()) return;
  for (const auto& [slot, health] : instruments_.links()) run_.feed(run::LinkSeen{slot, health}, now);
  if (!readings_say_.empty()) run_.feed(run::ReadingsSay{readings_say_, pipeline_.finding().remedy}, now);
}

void DaemonCore::order(const TableOrder& order, Stamp now) {
  if (instruments_.has_port(Slot::table())) note(order, now);
  acquire::carry_out(order, instruments_.table());
  instruments_.link(Slot::table()).flush(now);
}

void DaemonCore::abandon_run(Stamp now) {
  if (run_.active()) order({TableOrder::What::stop, {}}, now);
}

void DaemonCore::carry_out(const run::Action& action, Stamp now) {
  if (std::holds_alternative<run::HomeTable>(action)) return order({TableOrder::What::home, {}}, now);
  if (std::holds_alternative<run::StopTable>(action)) return order({TableOrder::What::stop, {}}, now);
  if (const auto* move = std::get_if<run::MoveTable>(&action))
    return order({TableOrder::What::move, move->target}, now);
  if (const auto* set = std::get_if<run::SetTable>(&action)) {
    if (auto* const table = dynamic_cast<drivers::ManualTable*>(&instruments_.table()))
      table->set(set->angles);
    return;
  }
  actions_.carry_out(action, now);
}

Result<void> DaemonCore::begin_probe(Stamp now) {
  if (probing())
    return fail(ErrorCode::state, "a magnet test is going on", "Ctrl-C where it runs, or: mgt run abort");
  if (run_.active())
    return fail(ErrorCode::state, "a run is going on: a magnet would spoil it",
                "wait for it, or: mgt run abort");
  if (auto ready = run::ready_for_magnet(instruments_.links()); !ready) return ready;
  inform("", "magnet test: begun", now.mono);
  probe_.emplace(now.mono, config_.speed_up, config_.geometry());
  return {};
}

void DaemonCore::stop_probe() {
  if (probing()) probe_->stop();
}

/// Without an epoch, time only passes.
void DaemonCore::follow_probe(Instant now, const Epoch* epoch) {
  if (!probing()) return;
  if (epoch != nullptr) probe_->add(*epoch);
  probe_->advance(now);
  if (!probe_->ended()) return;
  const MagnetStatus found = probe_->status();
  inform("", "magnet test: " + found.text, now);
  for (const std::string& finding : findings(found)) warn("", "magnet test: " + finding, now);
}

/// On a change of state only.
void DaemonCore::tell_criticism(Stamp now) {
  const calib::report::LiveReport found = pipeline_.finding();
  const bool rearranged = is_rearranged(found.state);
  if (rearranged || !readings_say_.empty()) {
    readings_say_ = rearranged ? found.measured : std::string();
    run_.feed(run::ReadingsSay{readings_say_, found.remedy}, now);
  }
  if (found.state == calib::criticism::live::LiveState::suspect) {
    warn("",
         fmt::format("the calibration is suspect: {}; limit {}; {}", found.measured, found.limit,
                     found.remedy),
         now.mono);
  } else if (found.state == calib::criticism::live::LiveState::near_source) {
    warn("", fmt::format("something magnetic is near: {}; {}", found.measured, found.remedy), now.mono);
  } else if (rearranged) {
    warn("", fmt::format("the samples are raw from here on: {}; {}", found.measured, found.remedy), now.mono);
  } else {
    inform("", fmt::format("the stream's closure: {}", calib::criticism::live::to_string(found.state)),
           now.mono);
  }
}

void DaemonCore::tell_left_out(Instant now) {
  if (pipeline_.live().left_out() == left_out_) return;
  left_out_ = pipeline_.live().left_out();
  for (const auto& [effect, lacks] : left_out_)
    warn("",
         fmt::format("{} is not corrected: {} is not measured; the samples say incomplete", effect, lacks),
         now);
  if (left_out_.empty()) inform("", "every effect of the calibration is corrected", now);
}

void DaemonCore::tell_identity(Instant now) {
  std::string measured = pipeline_.instruments().measured();
  if (measured == identity_) return;
  identity_ = std::move(measured);
  if (identity_.empty())
    inform("", "every sensor is the one that was calibrated in its place", now);
  else
    warn("", fmt::format("the samples are raw: {}; {}", identity_, pipeline_.instruments().remedy()), now);
}

}  // namespace mgtd::daemon::core
