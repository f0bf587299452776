// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <unordered_map>
#include <vector>

#include "calib/effects/laws/axis_nonlinearity.h"
#include "calib/effects/laws/live_memory.h"
#include "calib/effects/laws/run_memory.h"

/// `axis.hysteresis` makes a reading depend on where the field came from, since the core remembers it. It is
/// a play operator of width w over the whole run, started at p = 0:
///
///     p <- max(x - w, min(x + w, p)),   y += h (p - x)/w        x = v/F0, h in nT, w of F0
///
/// Follows the path of the table where the run kept it, else from dwell to dwell: a turn that overshoots both
/// ends is then missed. Where a turn on the way set the play, p is known as well as the table's angles are
/// there (way_deviation.h), and the term has an uncertainty of its own. Where the readings before a pose are
/// not known (an effect that is not bound to the run) the term is left out. On a stream every sample moves p;
/// where it began is known once each axis has swung by 2w, whatever it was.
namespace mgtd::calib::effects::laws {

/// p after x.
[[nodiscard]] inline double play(double p, double x, double w) { return std::max(x - w, std::min(x + w, p)); }

/// The play at one pose before the pose's own field has moved it.
struct Play {
  double p{0};  ///< of F0
  /// Of p, for each radian of the table's accuracy; 0 where the pose moves the play. Poses between which the
  /// play did not move share its error, and the weight of all together is that of one: times the root of
  /// their number.
  double sd_per_rad{0};
};
/// By pose number, sensor and axis.
class PlayOfRun {
 public:
  /// At rest, for each pose that is remembered.
  explicit PlayOfRun(const RunMemory& run);
  [[nodiscard]] bool contains(int pose) const { return row_.contains(pose); }
  /// Throws std::out_of_range for a pose of another run.
  [[nodiscard]] const Play& at(int pose, int sensor, int axis) const {
    return plays_[place(pose, sensor, axis)];
  }
  [[nodiscard]] Play& at(int pose, int sensor, int axis) { return plays_[place(pose, sensor, axis)]; }

 private:
  [[nodiscard]] std::size_t place(int pose, int sensor, int axis) const {
    return (row_.at(pose) * sensors_ + static_cast<std::size_t>(sensor)) * 3 + static_cast<std::size_t>(axis);
  }

  std::size_t sensors_;
  std::unordered_map<int, std::size_t> row_;
  std::vector<Play> plays_;
};
[[nodiscard]] PlayOfRun play_before(const RunMemory& run, double w);

/// The play on a stream: the lowest and the highest it can be. Both end at one value after a swing of 2w.
class LivePlay final : public LiveMemory {
 public:
  explicit LivePlay(double w) : w_(w) {}
  [[nodiscard]] bool known(int sensor) const;
  [[nodiscard]] double p(int sensor, int axis) const {
    const auto i = static_cast<std::size_t>(sensor);
    return (low_[i][axis] + high_[i][axis]) / 2;
  }

 protected:
  void begin(double t_s, const SensorReadings& v_nT) override;
  void step(double dt_s, const SensorReadings& v_nT) override;

 private:
  double w_;
  SensorReadings low_, high_;  // of F0
};

struct Hysteresis {
  static constexpr std::string_view kName = "axis.hysteresis";
  static constexpr int kPerAxis = 1;
  static constexpr double kDefaultWidth = 0.1;
  std::optional<double> w;
  std::shared_ptr<const PlayOfRun> before{};
  std::shared_ptr<const LivePlay> now{};  ///< on a stream

  static AxisCoefficients coefficients() { return one_per_axis("nT", 1); }
  [[nodiscard]] std::string_view missing(const Pose& pose, int sensor) const {
    if (now) return now->known(sensor) ? "" : kNoMemory;
    return before && before->contains(pose.number) ? "" : kNoMemory;
  }
  void parameters(EffectSpec& spec) const {
    if (w) spec.set("w", *w);
  }
  [[nodiscard]] Result<Hysteresis> on_run(const EffectContext& context) const;
  [[nodiscard]] std::pair<Hysteresis, std::shared_ptr<LiveMemory>> live() const;
  template <class S>
  S shape(const Conditions& at, int sensor, int axis, std::span<const S> v, int) const {
    const double width = w.value_or(kDefaultWidth);
    const double p = now ? now->p(sensor, axis) : before_pose(at.pose, sensor, axis).p;
    const S behind = (S(p) - in_F0(v, axis)) * S(1 / width);
    return behind > S(1.0) ? S(1.0) : behind < S(-1.0) ? S(-1.0) : behind;
  }
  [[nodiscard]] double shape_sd_per_rad(const Conditions& at, int sensor, int axis) const {
    return now ? 0 : before_pose(at.pose, sensor, axis).sd_per_rad / w.value_or(kDefaultWidth);
  }

 private:
  [[nodiscard]] const Play& before_pose(const Pose& pose, int sensor, int axis) const {
    return before->at(pose.number, sensor, axis);
  }
};

}  // namespace mgtd::calib::effects::laws
