// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/robust_fit.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "calib/fit/consensus.h"
#include "calib/fit/joint/memory_variance.h"
#include "calib/fit/joint/single_samples.h"
#include "calib/fit/joint/turned_pose.h"
#include "calib/fit/joint/without_poses.h"
#include "calib/stats/median.h"
#include "calib/stats/probability.h"

namespace mgtd::calib::fit::joint {
namespace {

Result<void> plausible(const JointProblem& problem, const JointState& state) {
  for (std::size_t i = 0; i < state.sensors.size(); ++i) {
    const double gain = std::abs(state.sensors[i].response().determinant());
    if (gain > 0.125 && gain < 8) continue;  // each axis within a factor of two of nominal scale
    return fail(
        ErrorCode::refused,
        fmt::format("sensor {}: the fit wants a volume gain of {:.3g}, a fluxgate at nominal scale has 1 "
                    "(limit 1/8 to 8)",
                    i + 1, gain),
        problem.platform_reference()
            ? "check the volts-to-nT scale of this sensor and of the reference; a reference that stands "
              "still beside a table needs the columns azimuth_deg, pitch_deg and roll_deg"
            : "check the volts-to-nT scale of this sensor, the known field, and that the poses cover "
              "the sphere");
  }
  return {};
}

/// Poses that a reading had turned which is left out now begin at the table's angles again: from where they
/// are they would not come back, and their angles would be taken for the table's error.
void turn_back(const JointProblem& problem, const Outliers& outliers, JointState& state) {
  const auto attitude_row = static_cast<std::size_t>(problem.channels()) + 1;
  for (std::size_t k = 0; k < outliers.rows().size(); ++k) {
    const Rows& rows = outliers.rows()[k];
    if (rows.any() && !rows[attitude_row] && is_turned(problem.poses[k], state.nuisances[k]))
      state.nuisances[k] = at_the_table(problem.poses[k], state);
  }
}

/// Fits, weighs anew and leaves out in turn until nothing moves. `unsettled` tells that no more than that
/// went wrong.
Result<RobustFit> weighed(JointProblem& problem, JointState state, const FitNoise& start, Outliers outliers,
                          bool& unsettled) {
  RobustFit out;
  out.outliers = std::move(outliers);
  out.noise = start;
  out.start = state;
  FitNoise& noise = out.noise;
  // While weights still move the fit need not be exact; after kMaxWeighingRounds they are taken as they are.
  double enough = kWeightsUnknown;
  bool settled = false;
  for (int round = 1;; ++round) {
    out.outliers.restore(problem);
    noise.apply(problem);
    out.outliers.leave_out(problem);
    JointState reached;
    auto solution = solve(problem, std::move(state), enough, &reached);
    if (!solution) {
      const auto ok = plausible(problem, reached);
      unsettled = ok.has_value();
      return tl::unexpected(ok ? solution.error() : ok.error());
    }
    unsettled = false;
    if (const auto ok = plausible(problem, solution->state); !ok) return tl::unexpected(ok.error());
    out.rounds = round;
    out.iterations += solution->iterations;
    out.termination = solution->slow_progress ? Termination::slow_progress : Termination::converged;
    out.solution = *std::move(solution);
    JointState& found = out.solution.state;
    out.residuals = pose_residuals(problem, found);
    if (problem.on_round) problem.on_round({round, out.residuals.residual_nT()});
    if (round > kMaxWeighingRounds) {
      if (!settled) out.termination = Termination::round_limit;
      return out;
    }
    const bool judged = out.outliers.judge(problem, found, out.residuals);
    turn_back(problem, out.outliers, found);
    bool moved = noise.update(out.residuals, problem);
    moved = set_memory_variance(problem, found, noise.table_sd_rad) || moved;
    if (moved && !judged) {
      settle(noise, problem, found);
      enough = kConverged;
    }
    settled = !judged && !moved;
    if (settled || round == kMaxWeighingRounds) {
      if (!settled) out.termination = Termination::round_limit;
      if (enough == kConverged) return out;
      enough = kConverged;
    }
    state = std::move(found);
  }
}

/// Readings and scalar reference of all poses, for the search of those that agree.
struct AllReadings {
  ReadingTable y_nT;
  Eigen::VectorXd f_nT;
};

AllReadings all_readings(const JointProblem& problem, double f_nT) {
  const auto n = static_cast<Eigen::Index>(problem.poses.size());
  const int channels = problem.channels();
  AllReadings out{ReadingTable(channels + (problem.platform_reference() ? 3 : 0), n),
                  Eigen::VectorXd::Constant(n, f_nT)};
  for (Eigen::Index k = 0; k < n; ++k) {
    const JointPose& pose = problem.poses[static_cast<std::size_t>(k)];
    out.y_nT.col(k).head(channels) = pose.y_nT;
    if (problem.platform_reference()) out.y_nT.col(k).tail<3>() = pose.reference_nT;
    if (!problem.common_field) out.f_nT[k] = pose.f_nT;
  }
  return out;
}

/// The fit of all poses that starts from the fit of some; empty where nothing comes of it.
std::optional<RobustFit> from_some(JointProblem& problem, const std::vector<Eigen::Index>& poses, double f_nT,
                                   const FitNoise& noise, double most_left_out) {
  JointProblem some = without_poses(problem);
  for (const Eigen::Index k : poses) some.poses.push_back(problem.poses[static_cast<std::size_t>(k)]);
  auto start = joint_start(some, f_nT);
  if (!start) return std::nullopt;
  bool unsettled = false;
  const auto first = weighed(some, *std::move(start), noise, Outliers(most_left_out), unsettled);
  if (!first) return std::nullopt;
  const JointState& known = first->solution.state;
  JointState state = joint_state(problem, known);
  state.coefficients = known.coefficients;
  set_memory_variance(problem, state, first->noise.table_sd_rad);
  first->noise.apply(problem);
  refit_nuisances(problem, state);
  Outliers outliers(most_left_out);
  outliers.judge(problem, state, pose_residuals(problem, state));
  turn_back(problem, outliers, state);
  auto out = weighed(problem, std::move(state), first->noise, std::move(outliers), unsettled);
  if (!out) return std::nullopt;
  out->rounds += first->rounds;
  out->iterations += first->iterations;
  return *std::move(out);
}

/// The fit that starts from the poses that agree with each other; empty where they cannot be told or where
/// nothing comes of it.
std::optional<RobustFit> from_agreeing(JointProblem& problem, const AllReadings& all, double f_nT,
                                       const FitNoise& noise, double most_left_out) {
  // A field that is known as a vector lies in the same plane as the readings, and on no ellipsoid.
  const auto agreeing =
      problem.platform_reference() ? agreeing_poses(all.y_nT) : agreeing_poses(all.y_nT, all.f_nT);
  if (!agreeing) return std::nullopt;
  return from_some(problem, *agreeing, f_nT, noise, most_left_out);
}

/// The fit of a long recording that starts from the fit of a share of its samples, evenly spread in time, so
/// that few iterations are made with all of them; empty where the recording is short or nothing comes of it,
/// which can leave other weights in the problem.
std::optional<RobustFit> from_share(JointProblem& problem, double f_nT, const FitNoise& noise,
                                    double most_left_out) {
  constexpr std::size_t kShare = 2000;
  constexpr std::size_t kLong = 4 * kShare;
  const std::size_t n = problem.poses.size();
  if (n < kLong || !is_recording(problem)) return std::nullopt;
  std::vector<Eigen::Index> share;
  for (std::size_t i = 0; i < kShare; ++i) share.push_back(static_cast<Eigen::Index>(i * n / kShare));
  return from_some(problem, share, f_nT, noise, most_left_out);
}

/// What two fits of the same readings are compared by: minus the logarithm of their likelihood with the
/// spread that the median of each axis tells, a reading left out priced as one three spreads away.
double cost(const JointProblem& problem, const RobustFit& fit) {
  constexpr double kLeftOut = 3 * 3 / 2.0;
  double sum = 0;
  for (int c = 0; c < problem.channels(); ++c) {
    std::vector<double> misfits;
    double squares = 0, left_out = 0;
    for (std::size_t k = 0; k < problem.poses.size(); ++k) {
      const double weight = problem.poses[k].weight[c];
      const double t = static_cast<double>(fit.residuals.t(c, static_cast<Eigen::Index>(k)));
      misfits.push_back(weight > 0 ? t / weight : std::numeric_limits<double>::infinity());
      if (weight > 0) {
        squares += std::pow(misfits.back(), 2);
      } else {
        ++left_out;
      }
    }
    const double spread = std::max(stats::kMadToSd * stats::median(misfits), kNoiseFloor_nT);
    sum += static_cast<double>(misfits.size()) * std::log(spread) + squares / (2 * spread * spread) +
           kLeftOut * left_out;
  }
  return sum;
}

/// By how many of its standard deviations the mean square of the whitened residuals is too large.
double excess(const PoseResiduals& residuals) {
  const double dof = std::max(residuals.freedom - residuals.fitted, 1.0);
  return (residuals.noise_ratio.array().square().mean() - 1) * std::sqrt(dof / 2);
}

/// Of mean square beyond the noise of the dwells, in its standard deviations, where a fit agrees with it.
constexpr double kAgrees = 5;

/// Whether the noise of the dwells says how well the readings kept must agree, and some may be left out.
bool may_leave_out_more(const RobustFit& fit, double most_left_out) {
  return fit.noise.sample_nT && fit.noise.noise_inflation <= 1 && most_left_out > 0;
}

/// A sensor, and the poses in which it is to blame.
struct SensorInPoses {
  Rows rows;  ///< its readings
  std::vector<std::size_t> poses;
};

/// The sensor that all blame lies on in poses of which nothing was left out before; empty where it lies on
/// more, or where the poses that are hit follow each other more than chance has it: that may be a step, or a
/// source that comes and goes.
std::optional<SensorInPoses> sensor_to_blame(const Outliers& outliers, const std::vector<Rows>& before,
                                             int channels) {
  constexpr double kMost = 0.25;  // of the poses
  constexpr double kAlone = 0.5;  // of the poses that are hit, those before which none was
  SensorInPoses out;
  Rows any;
  double alone = 0;
  for (std::size_t k = 0; k < before.size(); ++k) {
    const Rows& rows = outliers.rows()[k];
    if (rows.none() || before[k].any()) continue;
    any |= rows;
    alone += out.poses.empty() || out.poses.back() + 1 < k ? 1 : 0;
    out.poses.push_back(k);
  }
  const auto hit = static_cast<double>(out.poses.size());
  if (hit == 0 || hit > kMost * static_cast<double>(before.size()) || alone < kAlone * hit)
    return std::nullopt;
  for (int i = 0; 3 * i < channels; ++i) {
    out.rows = rows_of_sensor(i);
    if ((any & ~out.rows).none()) return out;
  }
  return std::nullopt;
}

/// The fit without the readings of a sensor that are off by little in many poses: together they draw the fit
/// so far that none of them stands apart from the others. As it was where the rest does not then agree down
/// to the noise of the dwells, or where no two other sensors tell which one is off.
RobustFit without_a_group(JointProblem& problem, RobustFit fit, double most_left_out) {
  constexpr int kFewestChannels = 3 * 3;
  if (problem.channels() < kFewestChannels || !may_leave_out_more(fit, most_left_out)) return fit;
  if (excess(fit.residuals) <= kAgrees || fit.outliers.too_many() > 0) return fit;
  JointProblem other = problem;
  Outliers outliers = fit.outliers;
  outliers.judge(other, fit.solution.state, fit.residuals, BlameLimits::of_groups(fit.residuals));
  const auto sensor = sensor_to_blame(outliers, fit.outliers.rows(), problem.channels());
  if (!sensor) return fit;
  outliers.keep_out(other, sensor->poses, sensor->rows);
  bool unsettled = false;
  auto without = weighed(other, fit.solution.state, fit.noise, std::move(outliers), unsettled);
  if (!without || without->outliers.too_many() > 0 || excess(without->residuals) > kAgrees) return fit;
  without->rounds += fit.rounds;
  without->iterations += fit.iterations;
  without->start = fit.start;
  problem = std::move(other);
  return *std::move(without);
}

/// The fit without the stretches that are shifted against the rest (stretch_scan.h); as it was where none is,
/// or where the rest does not then agree down to the noise of the dwells: that is a law which the model
/// misses.
RobustFit without_stretches(JointProblem& problem, RobustFit fit, double most_left_out) {
  constexpr int kMostStretches = 3;
  if (!may_leave_out_more(fit, most_left_out)) return fit;
  JointProblem other = problem;
  RobustFit without = fit;
  for (int i = 0; i < kMostStretches && excess(without.residuals) > kAgrees; ++i) {
    const auto stretch = shifted_stretch(other, without.solution);
    if (!stretch) return fit;
    Outliers outliers = without.outliers;
    outliers.keep_out(other, *stretch);
    bool unsettled = false;
    auto next = weighed(other, without.solution.state, without.noise, std::move(outliers), unsettled);
    if (!next || next->outliers.too_many() > 0) return fit;
    next->rounds += without.rounds;
    next->iterations += without.iterations;
    next->start = fit.start;
    without = *std::move(next);
  }
  if (excess(without.residuals) > kAgrees) return fit;
  problem = std::move(other);
  return without;
}

/// Of the field: no law that a model misses leaves as much, but a fit that a gross reading has drawn away.
/// The samples of a recording may scatter as far.
constexpr double kLost = 0.01;

/// The better of the fits from all poses and from those that agree.
Result<RobustFit> from_either(JointProblem& problem, Result<JointState> start, double f_nT,
                              const FitNoise& noise, double most_left_out, bool& unsettled) {
  const AllReadings all = all_readings(problem, f_nT);
  JointProblem other = problem;
  Result<RobustFit> plain = tl::unexpected(start ? Error{} : start.error());
  if (start) {
    if (auto shared = from_share(problem, f_nT, noise, most_left_out)) {
      shared->start = *std::move(start);
      plain = *std::move(shared);
    } else {
      if (is_recording(other)) problem = other;  // with the weights it had
      plain = weighed(problem, *std::move(start), noise, Outliers(most_left_out), unsettled);
    }
  }
  const bool suspicious = !plain || plain->outliers.any() || plain->outliers.too_many() > 0 ||
                          (!is_recording(problem) && plain->residuals.residual_nT() > kLost * f_nT);
  if (most_left_out <= 0 || (!suspicious && !looks_spoilt(all.y_nT))) return plain;
  auto agreed = from_agreeing(other, all, f_nT, noise, most_left_out);
  if (!agreed) return plain;
  if (plain && cost(problem, *plain) <= cost(other, *agreed)) return plain;
  problem = std::move(other);
  unsettled = false;
  return *std::move(agreed);
}

}  // namespace

Result<RobustFit> robust_fit_from(JointProblem& problem, JointState warm_start, const FitNoise& noise,
                                  double most_left_out, bool& unsettled) {
  Outliers outliers(most_left_out);
  set_memory_variance(problem, warm_start, noise.table_sd_rad);
  noise.apply(problem);
  refit_nuisances(problem, warm_start);
  outliers.judge(problem, warm_start, pose_residuals(problem, warm_start));
  auto fit = weighed(problem, std::move(warm_start), noise, std::move(outliers), unsettled);
  if (!fit) return fit;
  return without_a_group(problem, without_stretches(problem, *std::move(fit), most_left_out), most_left_out);
}

Result<RobustFit> robust_fit(JointProblem& problem, Result<JointState> start, double f_nT,
                             const FitNoise& noise, double most_left_out, bool& unsettled) {
  auto fit = from_either(problem, std::move(start), f_nT, noise, most_left_out, unsettled);
  if (!fit) return fit;
  return without_a_group(problem, without_stretches(problem, *std::move(fit), most_left_out), most_left_out);
}

}  // namespace mgtd::calib::fit::joint
