// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/pose_blame.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "calib/fit/joint/turned_pose.h"
#include "calib/fit/joint/without_poses.h"
#include "calib/linear/cholesky4.h"
#include "calib/stats/median.h"
#include "calib/stats/probability.h"

namespace mgtd::calib::fit::joint {
namespace {

/// Robust spreads of a single observation: one false alarm in 10^8 Gaussian observations.
constexpr double kSingle = 6;
/// The same for the root of the sum of squares over a sensor and over a pose, where the noise is Gaussian.
constexpr double kSensor = 7, kPose = 9;
/// And where it is not: robust spreads of that root above its median.
constexpr double kAboveMedian = 8;
/// Many poses that are off by less make a group of their own: above kLow spreads more of them than kGroup of
/// all, and between kFringe and kLow fewer than a share kBetweenGroups of those.
constexpr double kLow = 5, kFringe = 3, kGroup = 0.04, kBetweenGroups = 0.25;
/// A spread below one is chance, or noise that was estimated with gross readings in it: below this it is
/// that.
constexpr double kOverstated = 0.7;
/// Two more readings must explain so much more of chi-square before a sensor is blamed instead of a reading.
constexpr double kSensorInstead = 25;

double limit_of(const std::vector<double>& roots, double gaussian) {
  std::vector<double> values = roots;
  const double centre = stats::median(values);
  for (double& x : values) x = std::abs(x - centre);
  const double spread = stats::kMadToSd * stats::median(values);
  if (!std::isfinite(spread)) return gaussian;
  const double limit = std::max(gaussian, centre + kAboveMedian * spread), low = centre + kLow * spread;
  const auto above = [&](double x) {
    return static_cast<double>(std::count_if(roots.begin(), roots.end(), [x](double r) { return r > x; }));
  };
  const double lost = above(low), near = above(centre + kFringe * spread) - lost;
  const bool group = lost > kGroup * static_cast<double>(roots.size()) && near < kBetweenGroups * lost;
  return group ? std::min(low, limit) : limit;
}

double root_of(const Observations& t, int sensor) { return t.segment<3>(3 * sensor).matrix().norm(); }

/// Of the readings and the scalar reference.
double root_of_pose(const Observations& t) {
  constexpr int kOfCross = sensor::kChannels + 1;
  return t.size() == kOfCross + 1 ? t.head<kOfCross>().matrix().norm() : t.head(t.size() - 1).matrix().norm();
}

}  // namespace

BlameLimits BlameLimits::of(const PoseResiduals& residuals, std::span<const Rows> left_out) {
  constexpr double kBeyond = std::numeric_limits<double>::infinity();
  BlameLimits out;
  out.single = kSingle;
  out.spread = Observations::Ones(residuals.t.rows());
  const int sensors = static_cast<int>(residuals.scalar_row() / 3);
  out.sensor.resize(sensors);
  const auto is_out = [&](Eigen::Index k, int row) {
    return left_out[static_cast<std::size_t>(k)][static_cast<std::size_t>(row)];
  };
  for (int row = 0; row < residuals.t.rows(); ++row) {
    std::vector<double> values;
    for (Eigen::Index k = 0; k < residuals.t.cols(); ++k) {
      if (is_out(k, row)) values.push_back(kBeyond);
      if (residuals.t(row, k) > 0) values.push_back(static_cast<double>(residuals.t(row, k)));
    }
    const double spread = stats::kMadToSd * stats::median(values);
    if ((spread > 1 || (spread > 0 && spread < kOverstated)) && std::isfinite(spread))
      out.spread[row] = spread;
  }
  PerSensor<std::vector<double>> roots(static_cast<std::size_t>(sensors));
  std::vector<double> poses;
  for (Eigen::Index k = 0; k < residuals.t.cols(); ++k) {
    const Observations t = residuals.of_pose(k) / out.spread;
    bool any = false;
    for (int i = 0; i < sensors; ++i) {
      const bool gone = (left_out[static_cast<std::size_t>(k)] & rows_of_sensor(i)).any();
      roots.at(static_cast<std::size_t>(i)).push_back(gone ? kBeyond : root_of(t, i));
      any = any || gone;
    }
    poses.push_back(any ? kBeyond : root_of_pose(t));
  }
  for (int i = 0; i < sensors; ++i) out.sensor[i] = limit_of(roots.at(static_cast<std::size_t>(i)), kSensor);
  out.pose = limit_of(poses, kPose);
  return out;
}

BlameLimits BlameLimits::of_groups(const PoseResiduals& residuals) {
  // The median of the root of a Gaussian sensor and its robust spread.
  constexpr double kMedian = 1.54, kSpread = 0.67;
  BlameLimits out;
  out.single = kSingle;
  out.spread = Observations::Ones(residuals.t.rows());
  out.sensor.setConstant(residuals.scalar_row() / 3, kMedian + kLow * kSpread);
  out.pose = kPose;
  return out;
}

double BlameLimits::excess(const Observations& t) const {
  double worst = std::max(t.maxCoeff() / single, root_of_pose(t) / pose);
  for (int i = 0; i < sensor.size(); ++i) worst = std::max(worst, root_of(t, i) / sensor[i]);
  return worst;
}

PoseBlame::PoseBlame(const JointProblem& problem, const JointState& state, const BlameLimits& limits)
    : alone_(without_poses(problem)),
      at_(without_poses(state)),
      problem_(problem),
      state_(state),
      limits_(limits),
      model_(problem, state) {
  alone_.poses.resize(1);
  at_.nuisances.resize(1);
}

/// The pose with its own best field and attitude when these rows do not count.
PoseBlame::Trial PoseBlame::without(const Rows& out) {
  constexpr int kSteps = 12;
  constexpr double kSolved = 1e-6;
  JointPose& pose = alone_.poses.front();
  pose = whole_;
  const int channels = problem_.channels();
  for (int c = 0; c < channels; ++c)
    if (out[static_cast<std::size_t>(c)]) pose.weight[c] = 0;
  if (out[static_cast<std::size_t>(channels)]) pose.f_weight = 0;
  for (int i = 0; i < kSteps; ++i) {
    assemble(alone_, model_, at_, 0, Blocks::own, blocks_);
    const Nuisance step = linear::Cholesky4(blocks_.H).solve(blocks_.g);
    at_.nuisances.front() += step;
    if (step.dot(blocks_.g) < kSolved) break;
  }
  assemble(alone_, model_, at_, 0, Blocks::own, blocks_);
  const linear::Cholesky4 H(blocks_.H);
  Trial trial{.t = Observations::Zero(channels + 2),
              .chi2 = blocks_.cost.readings + blocks_.cost.scalar,
              .nuisance = at_.nuisances.front()};
  const auto whitened = [&](double residual, const Eigen::Matrix<double, 1, kNuisances>& row) {
    const double free = 1 - H.whitened(row.transpose()).squaredNorm();
    return free > 1e-6 ? std::abs(residual) / std::sqrt(free) : 0;
  };
  for (int c = 0; c < channels; ++c)
    if (pose.weight[c] > 0) trial.t[c] = whitened(blocks_.residual[c], blocks_.N.row(c));
  if (pose.f_weight > 0) trial.t[channels] = whitened(blocks_.scalar.residual, blocks_.scalar.nuisance);
  return trial;
}

/// The fewest readings without which the others agree.
Rows PoseBlame::readings_of(double limit) {
  const Nuisance start = at_.nuisances.front();
  const auto tried = [&](const Rows& out) {
    at_.nuisances.front() = start;
    return without(out);
  };
  const auto agrees = [&](const Trial& trial) { return limits_.excess(trial.t) <= limit; };
  if (agrees(without({}))) return {};
  struct Candidate {
    Rows rows;
    double chi2{std::numeric_limits<double>::infinity()};
    bool agrees{false};
  };
  const auto consider = [&](Candidate& best, const Rows& rows) {
    const Trial trial = tried(rows);
    const bool good = agrees(trial);
    if (good != best.agrees ? good : trial.chi2 < best.chi2) best = {rows, trial.chi2, good};
  };
  Candidate single, sensor;
  std::vector<Candidate> singles;
  const int channels = problem_.channels(), last = problem_.common_field ? channels : channels + 1;
  for (int row = 0; row < last; ++row) {
    Candidate one;
    consider(one, Rows().set(static_cast<std::size_t>(row)));
    singles.push_back(one);
    if (one.agrees != single.agrees ? one.agrees : one.chi2 < single.chi2) single = one;
  }
  for (int i = 0; i < problem_.sensors(); ++i) consider(sensor, rows_of_sensor(i));
  const bool within = (single.rows & sensor.rows).any();
  if (single.agrees && !(sensor.agrees && within && sensor.chi2 < single.chi2 - kSensorInstead))
    return single.rows;
  if (sensor.agrees) return sensor.rows;
  constexpr std::size_t kBest = 3;
  std::sort(singles.begin(), singles.end(), [](const auto& a, const auto& b) { return a.chi2 < b.chi2; });
  Candidate pair;
  for (std::size_t j = 0; j < kBest; ++j) {
    for (int row = 0; row < last; ++row) {
      Rows rows = singles[j].rows;
      if (rows[static_cast<std::size_t>(row)]) continue;
      consider(pair, rows.set(static_cast<std::size_t>(row)));
    }
  }
  if (pair.agrees) return pair.rows;
  return Rows((1ULL << static_cast<unsigned>(channels)) - 1);
}

Rows PoseBlame::of(std::size_t k, double strictness) {
  const int channels = problem_.channels(), scalar_row = channels, attitude_row = channels + 1;
  whole_ = problem_.poses[k];
  whole_.weight.array() /= limits_.spread.head(channels);
  whole_.f_weight /= limits_.spread[scalar_row];
  const double attitude_weight = whole_.attitude_weight / limits_.spread[attitude_row];
  // The readings are judged without the table, which may be wrong by more than any of them.
  whole_.attitude_weight = std::min(whole_.attitude_weight, kLooseAttitude_per_rad);
  at_.nuisances.front() = state_.nuisances[k];
  Rows out = readings_of(strictness);
  if (is_turned(whole_, state_.nuisances[k])) {  // seen from the table's angles less may be to blame
    at_.nuisances.front() = at_the_table(whole_, state_);
    const Rows from_table = readings_of(strictness);
    const bool fewer = from_table.count() <= out.count();
    if (fewer) out = from_table;
    at_.nuisances.front() = fewer ? at_the_table(whole_, state_) : state_.nuisances[k];
  }
  if (whole_.has_angles && !(out.count() >= static_cast<std::size_t>(channels))) {
    const Trial rest = without(out);
    out[static_cast<std::size_t>(attitude_row)] =
        rest.nuisance.head<3>().norm() * attitude_weight > strictness * kSingle;
  }
  return out;
}

}  // namespace mgtd::calib::fit::joint
