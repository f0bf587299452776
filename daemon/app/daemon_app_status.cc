// SPDX-License-Identifier: Apache-2.0
// What the rig says of itself.
#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "daemon/acquire/clock_report.h"
#include "daemon/app/daemon_app.h"
#include "proto/version.h"

namespace mgtd::daemon::app {

namespace {

/// What every input measures now.
std::vector<InputStatus> inputs_now(const config::Config& config, const acquire::LatestInputs& latest,
                                    Instant now) {
  std::vector<InputStatus> out;
  for (const auto& [slot, device] : acquire::devices_of(config)) {
    for (const drivers::InputChannel& input : device->device->inputs()) {
      const double value = latest.values()[out.size()].value;
      const std::optional<Instant> heard = latest.heard(input.column);
      const bool fresh = heard && now - *heard <= acquire::kFreshInput;
      out.push_back({.name = input.column,
                     .device = device->name,
                     .input = input.input,
                     .unit = input.unit,
                     .value = fresh ? std::optional(value) : std::nullopt,
                     .heard = heard});
    }
  }
  return out;
}

/// How `used` is used while the inputs are these. What was made after now has no age: the clock was set.
CalibrationUse use_of(const calib::calibration::Calibration& used, const std::vector<InputStatus>& inputs,
                      WallTime now) {
  CalibrationUse out{.forced = !used.accepted_by_checks, .left_out = {}};
  if (const auto made = parse_utc(used.reference.t_utc); made && made->ns <= now.ns)
    out.age_s = to_seconds(Duration(now.ns - made->ns));
  out.made_at_degC.assign(used.reference.T_degC.begin(), used.reference.T_degC.end());
  for (std::size_t i = 0; i < used.sensors.size(); ++i) {
    const auto of_sensor = [name = fmt::format("s{}_T_degC", i + 1)](const InputStatus& input) {
      return input.name == name;
    };
    const auto input = std::find_if(inputs.begin(), inputs.end(), of_sensor);
    out.now_degC.push_back(input == inputs.end() ? std::nullopt : input->value);
  }
  return out;
}

}  // namespace

StatusReport DaemonApp::report() const {
  const acquire::LivePipeline& pipeline = core_.pipeline();
  const Stamp now = clock_.now();
  StatusReport out;
  out.at = now;
  out.uptime_s = to_seconds(now.mono - started_.mono) / config_.speed_up;
  out.software = software();
  out.rig = config_.rig_name;
  out.array = array_;
  out.speed_up = config_.speed_up;
  out.calibration = store_.active_id();
  out.inputs = inputs_now(config_, pipeline.inputs(), now.mono);
  if (const auto& used = pipeline.live().calibration()) {
    out.calibration_use = use_of(*used, out.inputs, now.wall);
    for (const auto& [effect, lacks] : pipeline.live().left_out())
      out.calibration_use.left_out.push_back({effect, lacks});
  }
  const calib::report::LiveReport found = pipeline.finding();
  out.criticism = {std::string(calib::criticism::live::to_string(found.state)), found.measured, found.limit,
                   found.remedy};
  if (const acquire::InstrumentWatch& instruments = pipeline.instruments(); instruments.another())
    out.criticism = {"identity", instruments.measured(),
                     "the calibration holds for the sensors that it was made with", instruments.remedy()};
  out.devices = core_.instruments().status();
  for (std::size_t i = 0; i < std::min(out.devices.size(), published_.frames.size()); ++i)
    out.devices[i].rate_hz = published_.frames[i].rate_hz();
  const acquire::SamplerHealth sampler = pipeline.sampler().health();
  for (std::size_t i = 0; i < sampler.sensors.size(); ++i) {
    if (sampler.sensors[i].clock.samples > 0)
      out.devices.at(i).clock = acquire::clock_report(sampler.sensors[i].clock, config_.rate_hz);
  }
  out.sampler = {.epochs = sampler.epochs,
                 .gaps = sampler.gaps,
                 .rate_hz = published_.rate.rate_hz(),
                 .skew_bound_s = published_.last_skew_s};
  out.stream = stream_.stats();
  out.control = control_.stats();
  recording_.report(out);
  if (!console_.server.address().empty()) out.console = console_.server.address();
  std::error_code ec;
  if (const auto space = std::filesystem::space(config_.store.dir, ec); !ec)
    out.disk_free_bytes = space.available;
  out.run = run_.status(now.mono);
  if (core_.probing()) out.magnet = core_.probe()->status();
  return out;
}

}  // namespace mgtd::daemon::app
