// SPDX-License-Identifier: Apache-2.0
#include "calib/effects/laws/axis_hysteresis.h"

#include <cmath>
#include <map>
#include <utility>

namespace mgtd::calib::effects::laws {
namespace {

constexpr double kKnown = 0.04;  // of w between lowest and highest: 2 % of the coefficient

/// The extreme that a field passes between three points of the way: that of the parabola through them. A play
/// turns there, and points a quarter of a second apart miss it by some 0.1 % of the field.
double turning_point(const std::vector<RememberedWayPoint>& way, std::size_t k, std::size_t i, int a) {
  const double y = way[k].v_nT[i][a];
  if (k == 0 || k + 1 >= way.size()) return y;
  const double before_s = way[k].t_s - way[k - 1].t_s, after_s = way[k + 1].t_s - way[k].t_s;
  const double fall = y - way[k - 1].v_nT[i][a], rise = way[k + 1].v_nT[i][a] - y;
  if (!(fall * rise < 0) || !(before_s > 0) || !(after_s > 0)) return y;
  const double curve = (rise / after_s - fall / before_s) / (before_s + after_s);
  const double slope = fall / before_s + curve * before_s;
  return y - slope * slope / (4 * curve);
}

/// The play of one axis along a run.
struct PlayOnRun {
  double p{0};
  const RememberedWayPoint* set_by{nullptr};  ///< the point of the way that p was set by; null: a dwell

  void move(double v_nT, double w, const RememberedWayPoint* by) {
    const double before = std::exchange(p, play(p, v_nT / kReferenceField_nT, w));
    if (p != before) set_by = by;
  }
};

}  // namespace

PlayOfRun::PlayOfRun(const RunMemory& run)
    : sensors_(run.poses.empty() ? 0 : run.poses.front().v_nT.size()),
      plays_(run.poses.size() * sensors_ * 3) {
  row_.reserve(run.poses.size());
  for (std::size_t k = 0; k < run.poses.size(); ++k) row_[run.poses[k].pose] = k;
}

PlayOfRun play_before(const RunMemory& run, double w) {
  PlayOfRun out(run);
  const std::size_t sensors = run.poses.empty() ? 0 : run.poses.front().v_nT.size();
  PerSensor<std::array<PlayOnRun, 3>> axes(sensors);
  const auto each = [&](const auto& visit) {
    for (std::size_t i = 0; i < sensors; ++i) {
      for (int a = 0; a < 3; ++a) visit(i, a, axes[i][static_cast<std::size_t>(a)]);
    }
  };
  std::map<std::pair<const RememberedWayPoint*, int>, std::vector<Play*>> alike;  // set by one point
  for (const RememberedPose& pose : run.poses) {
    const std::vector<RememberedWayPoint>& way = pose.on_the_way;
    for (std::size_t k = 0; k < way.size(); ++k)
      each(
          [&](std::size_t i, int a, PlayOnRun& axis) { axis.move(turning_point(way, k, i, a), w, &way[k]); });
    each([&](std::size_t i, int a, PlayOnRun& axis) {
      Play& play = out.at(pose.pose, static_cast<int>(i), a);
      play.p = axis.p;
      axis.move(pose.v_nT[i][a], w, nullptr);
      if (axis.set_by == nullptr) return;
      play.sd_per_rad = run.sd_nT_per_rad(*axis.set_by)[i][a] / kReferenceField_nT;
      alike[{axis.set_by, static_cast<int>(3 * i) + a}].push_back(&play);
    });
  }
  for (auto& [by, plays] : alike)
    for (Play* play : plays) play->sd_per_rad *= std::sqrt(static_cast<double>(plays.size()));
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
  out.before = std::make_shared<const PlayOfRun>(play_before(**run, w.value_or(kDefaultWidth)));
  return out;
}

}  // namespace mgtd::calib::effects::laws
