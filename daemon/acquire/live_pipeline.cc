// SPDX-License-Identifier: Apache-2.0
#include "daemon/acquire/live_pipeline.h"

#include <fmt/format.h>

#include <utility>

#include "daemon/acquire/calibrated_with.h"
#include "daemon/acquire/instruments.h"

namespace mgtd::daemon::acquire {
namespace {

constexpr auto kFreshAngles = std::chrono::seconds(10);

}  // namespace

SamplerConfig sampler_config(const config::Config& config) {
  SamplerConfig out;
  out.rate_hz = config.rate_hz;
  out.latency_s.clear();
  out.wire_s.clear();
  out.step_s.clear();
  for (const config::DeviceConfig& sensor : config.sensors) {
    out.latency_s.push_back(sensor.latency_s);
    out.wire_s.push_back(wire_s(sensor.device->line_bytes(), sensor.device->baud()));
    out.step_s.push_back(sensor.delivery_s * config.speed_up);
  }
  out.scheduling_s *= config.speed_up;
  out.silence_s *= config.speed_up;
  return out;
}

LatestInputs inputs_of(const config::Config& config) {
  std::vector<std::string> columns;
  for (const auto& [slot, device] : devices_of(config)) {
    for (const drivers::InputChannel& input : device->device->inputs()) columns.push_back(input.column);
  }
  return LatestInputs(std::move(columns));
}

LivePipeline::LivePipeline(const SamplerConfig& sampler, const calib::sensor::Geometry& array,
                           LatestInputs inputs)
    : array_(array),
      sampler_(sampler),
      live_(array),
      raw_(array),
      answering_(array.sensors()),
      inputs_(std::move(inputs)) {}

void LivePipeline::use(std::shared_ptr<const calib::calibration::Calibration> calibration) {
  instruments_.want(calibration ? instruments_among(calibration->checks) : std::vector<InstrumentIdentity>{});
  if (calibration == nullptr) {
    criticism_ = {};
    rearranged_ = {};
    live_ = calib::calibration::LiveTensor(array_);
    return;
  }
  criticism_ = calib::criticism::live::LiveCriticism(*calibration);
  rearranged_ = calib::criticism::tests::RearrangementWatch(calibration);
  live_ = calib::calibration::LiveTensor(calibration);
}

void LivePipeline::answers(int slot, const std::string& identity) {
  std::string& known = answering_.at(static_cast<std::size_t>(slot));
  if (known == identity) return;
  known = identity;
  instruments_.answers({fmt::format("s{}", slot + 1), identity});
}

std::optional<TableAngles> LivePipeline::standing_angles(Instant at) const {
  if (table_ && table_->referenced && !table_->moving && at - table_->arrival.mono < kFreshAngles)
    return table_->angles;
  return std::nullopt;
}

calib::calibration::LiveConditions LivePipeline::conditions(Instant at) const {
  return {.angles = standing_angles(at), .covariates = &inputs_.covariates()};
}

TensorSample LivePipeline::tensor(const Epoch& epoch, bool& finding_changed) {
  inputs_.advance(epoch.t.mono);
  TensorSample sample;
  if (!instruments_.another()) sample = judged(epoch, finding_changed);
  if (instruments_.another() || rearranged_.finding()) {
    sample = raw_.apply(epoch);
    sample.flags |= Flag::identity;
  } else if (const auto& used = live_.calibration(); used && !used->accepted_by_checks) {
    sample.flags |= Flag::forced;
  }
  if (calibrating_) sample.flags |= Flag::calibrating;
  return sample;
}

/// With the calibration, and what that says of the calibration.
TensorSample LivePipeline::judged(const Epoch& epoch, bool& finding_changed) {
  TensorSample sample = live_.apply(epoch, conditions(epoch.t.mono));
  const bool before = rearranged_.finding().has_value();
  finding_changed = criticism_.add(sample, epoch.T_degC);
  rearranged_.add(epoch, criticism_.beyond());
  finding_changed = finding_changed || before != rearranged_.finding().has_value();
  const calib::criticism::live::LiveState state = criticism_.finding().state;
  if (state == calib::criticism::live::LiveState::near_source) sample.flags |= Flag::near_source;
  if (state == calib::criticism::live::LiveState::suspect ||
      (criticism_.beyond().value_or(false) && state != calib::criticism::live::LiveState::near_source))
    sample.flags |= Flag::suspect;
  return sample;
}

}  // namespace mgtd::daemon::acquire
