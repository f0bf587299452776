// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/axis_hysteresis.h"

namespace mgtd::calib {
namespace {

constexpr double kKnown = 0.04;  // of w between lowest and highest: 2 % of the coefficient

}  // namespace

std::unordered_map<int, PlayState> play_before(const std::vector<RememberedPose>& run, double w) {
  std::unordered_map<int, PlayState> out;
  PlayState p;
  p.fill(Eigen::Vector3d::Zero());
  const auto move = [&](const SensorReadings& v_nT) {
    for (std::size_t i = 0; i < kSensors; ++i) {
      for (int a = 0; a < 3; ++a) p[i][a] = play(p[i][a], v_nT[i][a] / kReferenceField_nT, w);
    }
  };
  for (const RememberedPose& pose : run) {
    for (const SensorReadings& v_nT : pose.on_the_way) move(v_nT);
    out[pose.pose] = p;
    move(pose.v_nT);
  }
  return out;
}

void LivePlay::begin(double, const SensorReadings& v_nT) {
  for (std::size_t i = 0; i < kSensors; ++i) {
    const Eigen::Vector3d x = v_nT[i] / kReferenceField_nT;
    low_[i] = x.array() - w_;
    high_[i] = x.array() + w_;
  }
}

void LivePlay::step(double, const SensorReadings& v_nT) {
  for (std::size_t i = 0; i < kSensors; ++i) {
    for (int a = 0; a < 3; ++a) {
      const double x = v_nT[i][a] / kReferenceField_nT;
      low_[i][a] = play(low_[i][a], x, w_);
      high_[i][a] = play(high_[i][a], x, w_);
    }
  }
}

bool LivePlay::known(int sensor) const {
  const auto i = static_cast<std::size_t>(sensor);
  return begun() && ((high_[i] - low_[i]).array() < kKnown * w_).all();
}

std::pair<Hysteresis, std::shared_ptr<LiveMemory>> Hysteresis::live() const {
  auto memory = std::make_shared<LivePlay>(w.value_or(kDefaultWidth));
  return {Hysteresis{w, nullptr, memory}, memory};
}

Result<Hysteresis> Hysteresis::on_run(const EffectContext& context) const {
  const auto run = run_memory(context);
  if (!run) return tl::unexpected(run.error());
  Hysteresis out = *this;
  out.before = std::make_shared<const std::unordered_map<int, PlayState>>(
      play_before(*run, w.value_or(kDefaultWidth)));
  return out;
}

}  // namespace mgtd::calib
