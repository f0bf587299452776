// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/axis_hysteresis.h"

namespace mgtd::calib::effects::laws {
namespace {

constexpr double kKnown = 0.04;  // of w between lowest and highest: 2 % of the coefficient

/// The extreme that a field passes between three points of the way: that of the parabola through them. A play
/// turns there, and points a quarter of a second apart miss it by some 0.1 % of the field.
double turning_point(const RememberedPose& pose, std::size_t k, std::size_t i, int a) {
  const double y = pose.on_the_way[k][i][a];
  if (k == 0 || k + 1 >= pose.on_the_way.size()) return y;
  const double before_s = pose.way_s[k] - pose.way_s[k - 1], after_s = pose.way_s[k + 1] - pose.way_s[k];
  const double fall = y - pose.on_the_way[k - 1][i][a], rise = pose.on_the_way[k + 1][i][a] - y;
  if (!(fall * rise < 0) || !(before_s > 0) || !(after_s > 0)) return y;
  const double curve = (rise / after_s - fall / before_s) / (before_s + after_s);
  const double slope = fall / before_s + curve * before_s;
  return y - slope * slope / (4 * curve);
}

}  // namespace

std::unordered_map<int, PlayState> play_before(const std::vector<RememberedPose>& run, double w) {
  std::unordered_map<int, PlayState> out;
  PlayState p(run.empty() ? kSensorCount : run.front().v_nT.size(), Eigen::Vector3d::Zero());
  const auto move = [&](const SensorReadings& v_nT) {
    for (std::size_t i = 0; i < p.size(); ++i) {
      for (int a = 0; a < 3; ++a) p[i][a] = play(p[i][a], v_nT[i][a] / kReferenceField_nT, w);
    }
  };
  for (const RememberedPose& pose : run) {
    for (std::size_t k = 0; k < pose.on_the_way.size(); ++k) {
      SensorReadings v_nT(p.size());
      for (std::size_t i = 0; i < p.size(); ++i) {
        for (int a = 0; a < 3; ++a) v_nT[i][a] = turning_point(pose, k, i, a);
      }
      move(v_nT);
    }
    out[pose.pose] = p;
    move(pose.v_nT);
  }
  return out;
}

void LivePlay::begin(double, const SensorReadings& v_nT) {
  low_.resize(v_nT.size());
  high_.resize(v_nT.size());
  for (std::size_t i = 0; i < v_nT.size(); ++i) {
    const Eigen::Vector3d x = v_nT[i] / kReferenceField_nT;
    low_[i] = x.array() - w_;
    high_[i] = x.array() + w_;
  }
}

void LivePlay::step(double, const SensorReadings& v_nT) {
  for (std::size_t i = 0; i < v_nT.size(); ++i) {
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

}  // namespace mgtd::calib::effects::laws
