// SPDX-License-Identifier: Apache-2.0
#include "daemon/live_pipeline.h"

namespace mgtd::daemon {
namespace {

constexpr auto kFreshAngles = std::chrono::seconds(10);
constexpr auto kFreshInput = std::chrono::seconds(120);  // twice the slowest asking

}  // namespace

SamplerConfig sampler_config(const Config& config) {
  SamplerConfig out;
  out.rate_hz = config.rate_hz;
  for (std::size_t i = 0; i < kSensors; ++i) {
    const DeviceConfig& sensor = config.sensors.at(i);
    out.latency_s.at(i) = sensor.latency_s;
    out.wire_s.at(i) = wire_s(sensor.device->line_bytes(), sensor.device->baud());
  }
  out.silence_s *= config.speed_up;
  return out;
}

LivePipeline::LivePipeline(const SamplerConfig& sampler, double baseline_m)
    : baseline_m_(baseline_m), sampler_(sampler), live_(calib::Geometry{baseline_m}) {}

void LivePipeline::use(std::shared_ptr<const calib::Calibration> calibration) {
  if (calibration == nullptr) {
    criticism_ = {};
    live_ = calib::LiveTensor(calib::Geometry{baseline_m_});
    return;
  }
  criticism_ = calib::LiveCriticism(*calibration);
  live_ = calib::LiveTensor(calibration);
}

void LivePipeline::push(const AuxiliaryReading& reading) {
  for (const auto& [column, value] : reading.values) {
    auxiliary_[column] = value;
    auxiliary_at_[column] = reading.arrival.mono;
  }
}

/// Where the array stands is known while a referenced table stands still and says so; an input that has not
/// been heard of for long is not known any more.
calib::LiveConditions LivePipeline::conditions(Instant at) {
  std::erase_if(auxiliary_, [&](const auto& input) { return at - auxiliary_at_[input.first] > kFreshInput; });
  calib::LiveConditions out;
  if (table_ && table_->referenced && !table_->moving && at - table_->arrival.mono < kFreshAngles)
    out.angles = table_->angles;
  out.covariates = &auxiliary_;
  return out;
}

TensorSample LivePipeline::tensor(const Epoch& epoch, bool& verdict_changed) {
  TensorSample sample = live_.apply(epoch, conditions(epoch.t.mono));
  if (calibrating_) sample.flags |= Flag::calibrating;
  if (const auto& used = live_.calibration(); used && !used->accepted_by_checks) sample.flags |= Flag::forced;
  verdict_changed = criticism_.add(sample, epoch.T_degC);
  if (verdict().state == calib::LiveState::suspect) sample.flags |= Flag::suspect;
  if (verdict().state == calib::LiveState::near_source) sample.flags |= Flag::near_source;
  return sample;
}

}  // namespace mgtd::daemon
