// SPDX-License-Identifier: Apache-2.0
#include "calib/design/candidate_poses.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "calib/design/actions.h"
#include "calib/fit/two_step/azimuth_origin.h"

namespace mgtd::calib::design {
namespace {

constexpr double kNight_s = 20 * 3600.0;
constexpr double kHalfTurn = std::numbers::pi;

using Sensors = PerSensor<sensor::SensorModel>;

/// A column over the time of a run.
struct Trend {
  double mean{0}, mean_t_s{0}, slope_per_s{0};
  bool goes_with_time{false};
  [[nodiscard]] double at(double t_s) const { return mean + slope_per_s * (t_s - mean_t_s); }
};

Trend trend_of(const PoseTable& run, const std::string& name) {
  double n = 0, t = 0, x = 0, tt = 0, tx = 0, xx = 0;
  for (const Pose& pose : run.poses) {
    const auto found = pose.covariates.find(name);
    if (found == pose.covariates.end() || !pose.t_s) continue;
    ++n, t += *pose.t_s, x += found->second;
  }
  if (n < 3) return {};
  Trend out{.mean = x / n, .mean_t_s = t / n};
  for (const Pose& pose : run.poses) {
    const auto found = pose.covariates.find(name);
    if (found == pose.covariates.end() || !pose.t_s) continue;
    const double dt = *pose.t_s - out.mean_t_s, dx = found->second - out.mean;
    tt += dt * dt, tx += dt * dx, xx += dx * dx;
  }
  if (!(tt > 0) || !(xx > 0)) return out;
  out.slope_per_s = tx / tt;
  out.goes_with_time = tx * tx > 0.5 * tt * xx;
  return out;
}

/// The course of a run, for poses behind it.
class Course {
 public:
  Course(const PoseTable& run, const LawAction& action) : run_(run), action_(action) {
    pose_s_ = 60 * minutes_per_pose(run);
    const auto &first = run.poses.front().t_s, &last = run.poses.back().t_s;
    if (first && last) first_s_ = *first, last_s_ = *last;
    for (const auto& column : run.poses.front().covariates)
      trends_.emplace(column.first, trend_of(run, column.first));
  }

  [[nodiscard]] double pose_s() const { return pose_s_; }

  /// Puts a pose `after_s` behind the run.
  void place(Pose& pose, double after_s, const Pose& own) const {
    const double of_run_s = action_.other_day ? first_s_ + after_s : last_s_ + after_s;
    if (pose.t_s) pose.t_s = last_s_ + after_s + (action_.other_day ? kNight_s : 0);
    pose.t_utc.reset();
    pose.T_degC = drifted_temperatures(run_, of_run_s);
    for (auto& [name, value] : pose.covariates) {
      const auto trend = trends_.find(name);
      const auto had = own.covariates.find(name);
      if (trend != trends_.end() && trend->second.goes_with_time) {
        value = trend->second.at(of_run_s);
      } else if (had != own.covariates.end()) {
        value = had->second;
      }
    }
  }

 private:
  const PoseTable& run_;
  const LawAction& action_;
  double pose_s_{0}, first_s_{0}, last_s_{0};
  std::map<std::string, Trend> trends_;
};

/// Attitudes uniform over the rotations, within the tilts of a run.
class Attitudes {
 public:
  Attitudes() = default;
  Attitudes(const PoseTable& run, double wider_rad) {
    azimuth_ = angle_range(run, &Pose::azimuth_rad);
    pitch_ = widened(angle_range(run, &Pose::pitch_rad), wider_rad, kHalfTurn / 2);
    roll_ = widened(angle_range(run, &Pose::roll_rad), wider_rad, kHalfTurn);
  }

  [[nodiscard]] TableAngles draw(std::mt19937_64& random) const {
    const double sine = between(random, {std::sin(std::max(pitch_.least_rad, -kHalfTurn / 2)),
                                         std::sin(std::min(pitch_.most_rad, kHalfTurn / 2))});
    return {between(random, azimuth_), std::asin(std::clamp(sine, -1.0, 1.0)), between(random, roll_)};
  }

 private:
  static AngleRange widened(const AngleRange& t, double by_rad, double most_rad) {
    if (by_rad == 0) return t;
    return {std::max(t.least_rad - by_rad, -most_rad), std::min(t.most_rad + by_rad, most_rad)};
  }
  static double between(std::mt19937_64& random, const AngleRange& t) {
    constexpr double kSteps = 9007199254740992.0;  // 2^53: the same numbers from every library
    return t.least_rad + (t.most_rad - t.least_rad) * (static_cast<double>(random() >> 11U) / kSteps);
  }

  AngleRange azimuth_, pitch_, roll_;
};

/// The same field at another attitude.
void turn(Pose& pose, const TableAngles& to, const Sensors& sensors) {
  const Eigen::Matrix3d by =
      fit::two_step::table_rotation(to) * fit::two_step::table_rotation(*pose.angles()).transpose();
  pose.azimuth_rad = to.azimuth_rad, pose.pitch_rad = to.pitch_rad, pose.roll_rad = to.roll_rad;
  for (std::size_t i = 0; i < sensors.size(); ++i)
    pose.y_nT[i] = sensors[i].predict(by * sensors[i].correct(pose.y_nT[i]));
}

/// From either side, after a wait; where the run recorded such. Returns the wait.
double approach(Pose& pose, std::mt19937_64& random) {
  static constexpr std::array kWaits_s{0.0, 15.0, 55.0};
  if (pose.sense) pose.sense = random() % 2 == 0 ? 1 : -1;
  const double wait_s = kWaits_s[random() % kWaits_s.size()];
  if (!pose.since_stop_s) return 0;
  *pose.since_stop_s += wait_s;
  return wait_s;
}

/// Of many lengths, in an order that has none.
double dwell_of(std::size_t k) {
  static constexpr std::array kDwells_s{5.0, 40.0, 10.0, 60.0, 20.0, 30.0};
  return kDwells_s[(k * 5 + k / 6) % kDwells_s.size()];
}

}  // namespace

std::vector<std::vector<CandidatePose>> candidate_poses(const PoseTable& run, const LawAction& action,
                                                        const Sensors& sensors, std::size_t count,
                                                        std::uint64_t seed) {
  const Course course(run, action);
  const bool chosen = action.placed && turnable(run);
  const Attitudes attitudes = chosen ? Attitudes(run, action.wider_rad) : Attitudes();
  std::mt19937_64 random(seed ^ 0xa0761d6478bd642fU);
  const std::size_t each = chosen ? count : 1, n = run.poses.size();
  const double length_s = course.pose_s() * static_cast<double>(kLawPoses);
  std::vector<std::vector<CandidatePose>> out;
  double after_s = course.pose_s();
  for (std::size_t k = 0; k < kLawPoses; ++k) {
    double took_s = course.pose_s();
    if (action.dwells) took_s += dwell_of(k) - run.poses.back().dwell_s.value_or(0);
    std::vector<CandidatePose> of_k;
    for (std::size_t m = 0; m < each; ++m) {
      const Pose& own = run.poses[chosen ? random() % n : (k * 37 + 11) % n];
      Pose pose = own;
      pose.number = run.poses.back().number + static_cast<int>(k) + 1;
      if (chosen || pose.set == "check") pose.set = "random";
      // Not all at one time: what looks back over the run needs an order.
      const double at_s = after_s + took_s * static_cast<double>(m) / static_cast<double>(2 * each);
      course.place(pose, at_s, own);
      double wait_s = 0;
      if (chosen) {
        turn(pose, attitudes.draw(random), sensors);
        wait_s = approach(pose, random);
      }
      if (action.dwells) pose.dwell_s = dwell_of(k);
      if (action.change != nullptr)
        action.change(pose, {.k = k, .share = (at_s - course.pose_s()) / length_s}, sensors);
      of_k.push_back({std::move(pose), (took_s + wait_s) / 60});
    }
    after_s += took_s;
    out.push_back(std::move(of_k));
  }
  return out;
}

}  // namespace mgtd::calib::design
