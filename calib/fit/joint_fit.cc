// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint_fit.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/fit/consensus.h"

namespace mgtd::calib {
namespace {

constexpr int kMaxRounds = 30;
constexpr double kSettled = 0.01;  ///< relative change of a noise estimate that no longer matters
constexpr double kNoiseFloor_nT = 1e-4;
/// Residual over noise from which the readings are taken as worse, below which they are not any more, and
/// where to begin when nothing is known.
constexpr double kFarOff = 10, kNearAgain = 3, kVeryFarOff = 100;
constexpr double kSizeSettled = 0.1;
/// Of chi-square: less is not worth a step before the weights are known.
constexpr double kWeightsUnknown = 10;
const double kTableFloor_rad = to_rad(0.0005), kTableCeiling_rad = to_rad(10);

struct Noise {
  AxisNoise pose_nT{AxisNoise::Constant(kStartNoise_nT)};
  std::optional<AxisNoise> sample_nT;
  double table_sd_rad{0};
  double worse{1};
  /// Beside the dwells' own: of the digitiser's step, and what JointOptions adds.
  Channels more_nT2{Channels::Zero()};
};

void apply(const Noise& noise, JointProblem& problem) {
  if (noise.sample_nT) {
    weight_by_samples(problem, *noise.sample_nT * noise.worse);
    add_variance(problem, noise.more_nT2 * noise.worse * noise.worse);
  } else {
    weight_by_pose(problem, noise.pose_nT);
  }
  for (JointPose& pose : problem.poses) {
    // Loosened attitudes stay loose.
    if (pose.has_angles && pose.attitude_weight > 1 / kTableCeiling_rad)
      pose.attitude_weight = 1 / noise.table_sd_rad;
  }
}

/// Changes of an estimate that its own uncertainty makes meaningless: a tenth of it.
double settled(double freedom) { return std::max(kSettled, 0.1 / std::sqrt(2 * std::max(freedom, 1.0))); }

/// Returns whether anything moved enough to fit again.
bool update(const PoseResiduals& residuals, const JointProblem& problem, Noise& noise) {
  bool moved = false;
  if (!noise.sample_nT) {
    noise.pose_nT = noise.pose_nT.cwiseProduct(residuals.noise_ratio).cwiseMax(kNoiseFloor_nT);
    moved = (residuals.noise_ratio.array() - 1).abs().maxCoeff() > kSettled &&
            noise.pose_nT.maxCoeff() > kNoiseFloor_nT;
  }
  if (problem.has_angles) {
    const double before = noise.table_sd_rad;
    noise.table_sd_rad = std::clamp(before * residuals.table_ratio, kTableFloor_rad, kTableCeiling_rad);
    moved = moved || std::abs(noise.table_sd_rad / before - 1) > settled(residuals.attitude_freedom);
  }
  return moved;
}

Result<void> plausible(const JointState& state) {
  for (std::size_t i = 0; i < kSensors; ++i) {
    const double gain = std::abs(state.sensors[i].response().determinant());
    if (gain > 0.125 && gain < 8) continue;  // each axis within a factor of two of nominal scale
    return fail(
        ErrorCode::refused,
        fmt::format("sensor {}: the fit wants a volume gain of {:.3g}, a fluxgate at nominal scale has 1 "
                    "(limit 1/8 to 8)",
                    i + 1, gain),
        "check the volts-to-nT scale of this sensor, the known field, and that the poses cover the sphere");
  }
  return {};
}

void fill_statistics(const PoseResiduals& residuals, const Reduced& reduced, JointFit& fit) {
  const JointProblem& problem = fit.problem;
  fit.chi2 = (reduced.cost.readings + reduced.cost.scalar) * fit.worse * fit.worse;
  fit.chi2_table = reduced.cost.attitude;
  fit.dof_table = residuals.attitude_freedom;
  double unknowns =
      kSensorBlock + problem.coefficients() + (problem.common_field ? 1 : 0) + (problem.has_angles ? 2 : 0);
  double observed = residuals.readings + residuals.scalars + fit.gauge.constraints +
                    (problem.has_angles && problem.known_inclination_rad ? 1 : 0) +
                    (problem.has_angles && problem.known_declination_rad ? 1 : 0);
  for (const JointPose& pose : problem.poses) {
    // Of a pose without angles and without readings only the size of its field is asked.
    unknowns += pose.has_angles ? 4 : pose.weight.isZero(0) ? 1 : 3;
    observed += (pose.has_angles ? 3 : 0) + (problem.common_field ? 1 : 0);
  }
  fit.dof = observed - unknowns - fit.dof_table;
  // Three standard deviations of a chi-square: wider than noise alone would make it, so the uncertainties
  // follow.
  if (fit.dof > 0 && fit.chi2 > fit.dof + 3 * std::sqrt(2 * fit.dof))
    fit.spread = std::sqrt(fit.chi2 / fit.dof);
}

/// With readings and scalar reference worse by the spread; the table's angles have their own estimate.
Eigen::MatrixXd widened_information(const JointFit& fit) {
  JointProblem wide = fit.problem;
  for (JointPose& pose : wide.poses) {
    pose.weight *= fit.worse / fit.spread;
    pose.f_weight *= fit.worse / fit.spread;
  }
  return reduce(wide, fit.state, 0).S;
}

std::string describe_gauge(const JointFit& fit) {
  const auto sd_deg = [&](int parameter) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(fit.covariance.rows());
    for (int i = 0; i < kSensors; ++i) row[kSensorParameters * i + parameter] = 1.0 / kSensors;
    return to_deg(std::sqrt(row.dot(fit.covariance * row)));
  };
  std::string text;
  if (fit.gauge.angles == AngleCoverage::none) {
    text =
        "no table angles: mean alpha = mean beta = mean gamma = 0 of the four sensors, relative to their "
        "mountings; the "
        "common rotation against the platform is unknown";
  } else {
    const bool convention = fit.gauge.angles == AngleCoverage::one_axis && !fit.gauge.declination_known;
    text = fmt::format(
        "{} (table angles to {:.3g} deg a pose, estimated); common rotation known to {:.2g} deg about X, "
        "{:.2g} about Y",
        fit.gauge.angles == AngleCoverage::full ? "platform frame is the table frame"
                                                : "platform by the table's one axis",
        to_deg(fit.table_sd_rad), sd_deg(alpha), sd_deg(beta));
    text += convention ? "; about Z by convention mean gamma = 0, because the angles turn about one axis only"
                       : fmt::format(", {:.2g} about Z", sd_deg(gamma));
    if (fit.gauge.declination_known) text += "; declination as given";
  }
  if (!fit.gauge.scale_known)
    text += fmt::format("; no field is known: mean scale factor of the twelve axes = 1, {}", kScaleIsFree);
  return text;
}

/// The weights settle while the fixed block stays: a fraction of the cost of a fit for each.
void settle(JointProblem& problem, JointState& state, Noise& noise) {
  constexpr int kMost = 3;
  for (int i = 0; i < kMost; ++i) {
    apply(noise, problem);
    refit_nuisances(problem, state);
    if (!update(pose_residuals(problem, state), problem, noise)) return;
  }
}

/// Noise of a pose mean as it was weighted, rms over the poses.
AxisNoise assumed_noise(const JointProblem& problem) {
  Eigen::Array<double, kChannels, 1> squares = Eigen::Array<double, kChannels, 1>::Zero();
  Eigen::Array<double, kChannels, 1> count = squares;
  for (const JointPose& pose : problem.poses) {
    for (int c = 0; c < kChannels; ++c) {
      if (!(pose.weight[c] > 0)) continue;
      squares[c] += 1 / (pose.weight[c] * pose.weight[c]);
      ++count[c];
    }
  }
  return (squares / count.max(1)).sqrt().matrix().reshaped<Eigen::RowMajor>(kSensors, 3);
}

/// Where fitting, weighing anew and leaving out ended.
struct Weighed {
  JointSolution solution;
  PoseResiduals residuals;
  Outliers outliers;
  Noise noise;
  int iterations{0};
};

/// Fits, weighs anew and leaves out in turn until nothing moves. `unsettled` tells that no more than that
/// went wrong.
Result<Weighed> weighed(JointProblem& problem, JointState state, const Noise& start, Outliers outliers,
                        bool& unsettled) {
  Weighed out;
  out.outliers = std::move(outliers);
  out.noise = start;
  Noise& noise = out.noise;
  // While weights still move the fit need not be exact; after kMaxRounds they are taken as they are.
  double enough = kWeightsUnknown;
  for (int round = 1;; ++round) {
    out.outliers.restore(problem);
    apply(noise, problem);
    out.outliers.leave_out(problem);
    auto solution = solve(problem, std::move(state), enough);
    unsettled = !solution;
    if (!solution) return tl::unexpected(solution.error());
    if (const auto ok = plausible(solution->state); !ok) return tl::unexpected(ok.error());
    out.iterations += solution->iterations;
    out.solution = *std::move(solution);
    JointState& found = out.solution.state;
    out.residuals = pose_residuals(problem, found);
    if (round > kMaxRounds) return out;
    const bool judged = out.outliers.judge(problem, found, out.residuals);
    const bool moved = update(out.residuals, problem, noise);
    if (moved && !judged) {
      settle(problem, found, noise);
      enough = kConverged;
    }
    if ((!judged && !moved) || round == kMaxRounds) {
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
  AllReadings out{ReadingTable(kChannels, n), Eigen::VectorXd::Constant(n, f_nT)};
  for (Eigen::Index k = 0; k < n; ++k) {
    const JointPose& pose = problem.poses[static_cast<std::size_t>(k)];
    out.y_nT.col(k) = pose.y_nT;
    if (!problem.common_field) out.f_nT[k] = pose.f_nT;
  }
  return out;
}

/// The fit that starts from the poses that agree with each other; empty where they cannot be told or where
/// nothing comes of it.
std::optional<Weighed> from_agreeing(JointProblem& problem, const AllReadings& all, double f_nT,
                                     const Noise& noise, double most_left_out) {
  const auto agreeing = agreeing_poses(all.y_nT, all.f_nT);
  if (!agreeing) return std::nullopt;
  JointProblem some = problem;
  some.poses.clear();
  for (const Eigen::Index k : *agreeing) some.poses.push_back(problem.poses[static_cast<std::size_t>(k)]);
  auto start = joint_start(some, f_nT);
  if (!start) return std::nullopt;
  bool unsettled = false;
  const auto first = weighed(some, *std::move(start), noise, Outliers(most_left_out), unsettled);
  if (!first) return std::nullopt;
  const JointState& known = first->solution.state;
  apply(first->noise, problem);
  JointState state = joint_state(problem, known.sensors, known.direction, known.f_nT);
  state.coefficients = known.coefficients;
  refit_nuisances(problem, state);
  Outliers outliers(most_left_out);
  outliers.judge(problem, state, pose_residuals(problem, state));
  auto out = weighed(problem, std::move(state), first->noise, std::move(outliers), unsettled);
  if (!out) return std::nullopt;
  out->iterations += first->iterations;
  return *std::move(out);
}

/// What two fits of the same readings are compared by: minus the logarithm of their likelihood with the
/// spread that the median of each axis tells, a reading left out priced as one three spreads away.
double cost(const JointProblem& problem, const Weighed& fit) {
  constexpr double kMadToSd = 1.4826, kLeftOut = 3 * 3 / 2.0;
  double sum = 0;
  for (int c = 0; c < kChannels; ++c) {
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
    const auto middle = misfits.begin() + static_cast<std::ptrdiff_t>(misfits.size() / 2);
    std::nth_element(misfits.begin(), middle, misfits.end());
    const double spread = std::max(kMadToSd * *middle, kNoiseFloor_nT);
    sum += static_cast<double>(misfits.size()) * std::log(spread) + squares / (2 * spread * spread) +
           kLeftOut * left_out;
  }
  return sum;
}

/// Of few poses only single ones can be told from the others.
double most_left_out(const JointProblem& problem, const JointOptions& options) {
  constexpr std::size_t kFewPoses = 20;
  constexpr double kOfFew = 0.1;
  return problem.poses.size() < kFewPoses ? std::min(kOfFew, options.most_left_out) : options.most_left_out;
}

/// From the end of a fit of these readings: what contradicts there is left out before anything moves.
Result<Weighed> from_near(JointProblem& problem, JointState near, const Noise& noise, double most_left_out,
                          bool& unsettled) {
  Outliers outliers(most_left_out);
  apply(noise, problem);
  refit_nuisances(problem, near);
  outliers.judge(problem, near, pose_residuals(problem, near));
  return weighed(problem, std::move(near), noise, std::move(outliers), unsettled);
}

/// Least squares from all poses; where that, or the readings alone, show that some poses are far from the
/// others, also from those that agree; the more likely of the two.
Result<Weighed> robust(JointProblem& problem, Result<JointState> start, double f_nT, const Noise& noise,
                       double most_left_out, bool& unsettled) {
  const AllReadings all = all_readings(problem, f_nT);
  JointProblem other = problem;
  Result<Weighed> plain = tl::unexpected(start ? Error{} : start.error());
  if (start) plain = weighed(problem, *std::move(start), noise, Outliers(most_left_out), unsettled);
  const bool suspicious = !plain || plain->outliers.any() || plain->outliers.too_many() > 0;
  if (most_left_out <= 0 || (!suspicious && !looks_spoilt(all.y_nT))) return plain;
  auto agreed = from_agreeing(other, all, f_nT, noise, most_left_out);
  if (!agreed) return plain;
  if (plain && cost(problem, *plain) <= cost(other, *agreed)) return plain;
  problem = std::move(other);
  unsettled = false;
  return *std::move(agreed);
}

Result<JointFit> run(const PoseTable& table, const JointOptions& options, const JointState* near,
                     bool& unsettled) {
  auto problem = joint_problem(table, options);
  if (!problem) return tl::unexpected(problem.error());
  JointFit fit;
  fit.problem = std::move(*problem);
  fit.gauge = fix_gauge(fit.problem, options);
  const double f_nT = start_field_nT(fit.problem, options);
  Result<JointState> state = near != nullptr
                                 ? joint_state(fit.problem, near->sensors, near->direction, near->f_nT)
                                 : joint_start(fit.problem, f_nT);
  if (state && near != nullptr && near->coefficients.size() == state->coefficients.size())
    state->coefficients = near->coefficients;

  Noise noise;
  noise.sample_nT = sample_noise(table);
  noise.table_sd_rad = options.table_sd_rad;
  fit.quantisation = quantisation_of(table);
  noise.more_nT2 = options.more_nT2 + fit.quantisation.variance_nT2.reshaped<Eigen::RowMajor>().matrix();
  fit.worse = noise.worse = noise.sample_nT ? options.worse : 1;
  for (JointPose& pose : fit.problem.poses) pose.f_weight /= fit.worse;
  const double most = most_left_out(fit.problem, options);
  auto found = near != nullptr ? from_near(fit.problem, *std::move(state), noise, most, unsettled)
                               : robust(fit.problem, std::move(state), f_nT, noise, most, unsettled);
  if (!found) return tl::unexpected(found.error());
  noise = found->noise;
  fit.iterations = found->iterations;
  fit.state = std::move(found->solution.state);
  fit.outliers = found->outliers.nodes(fit.problem, fit.state);
  fit.contradicting = std::max(found->outliers.share(), found->outliers.too_many());
  fit.pose_noise_nT = assumed_noise(fit.problem) / fit.worse;
  fit.sample_noise_nT = noise.sample_nT;
  fit.table_sd_rad = fit.problem.has_angles ? noise.table_sd_rad : 0;
  Reduced& reduced = found->solution.reduced;
  fill_statistics(found->residuals, reduced, fit);
  auto covariance = covariance_of(fit.spread > 1 ? widened_information(fit) : std::move(reduced.S));
  if (!covariance) return tl::unexpected(covariance.error());
  fit.covariance = *std::move(covariance);
  fit.gauge_text = describe_gauge(fit);
  return fit;
}

/// Again until the readings are as much worse as the residual says; as the table says where that is little.
Result<JointFit> sized(const PoseTable& table, JointOptions options, const JointState* near, JointFit fit) {
  constexpr int kMost = 10;  // where a law accounts for nearly all, the size falls by orders of magnitude
  for (int i = 0; i < kMost; ++i) {
    const double wanted = std::sqrt(fit.chi2 / std::max(fit.dof, 1.0));
    options.worse = wanted > (fit.worse > 1 ? kNearAgain : kFarOff) ? wanted : 1;
    if (std::abs(options.worse / fit.worse - 1) < kSizeSettled) break;
    bool unsettled = false;
    auto next = run(table, options, near, unsettled);
    if (!next) return next;
    fit = *std::move(next);
  }
  return fit;
}

Result<JointFit> settled_run(const PoseTable& table, JointOptions options, const JointState* near) {
  bool unsettled = false;
  auto fit = run(table, options, near, unsettled);
  if (fit || !unsettled || options.worse > 1 || !sample_noise(table)) return fit;
  options.worse = kVeryFarOff;
  auto far = run(table, options, near, unsettled);
  if (far) far = sized(table, options, near, *std::move(far));
  if (!far) return fit;
  options.worse = 1;
  auto again = run(table, options, &far->state, unsettled);
  return again ? std::move(again) : std::move(far);
}

}  // namespace

double JointFit::noise_nT() const { return std::sqrt(pose_noise_nT.array().square().mean()); }

Result<JointFit> fit_joint(const PoseTable& table, const JointOptions& options) {
  return settled_run(table, options, nullptr);
}

Result<JointFit> fit_joint(const PoseTable& table, const JointOptions& options, const JointState& near) {
  return settled_run(table, options, &near);
}

Result<JointFit> fit_joint_at_size(const PoseTable& table, const JointOptions& options,
                                   const JointState* near) {
  auto fit = settled_run(table, options, near);
  return fit ? sized(table, options, near, *std::move(fit)) : std::move(fit);
}

Result<Eigen::MatrixXd> covariance_of(const Eigen::MatrixXd& S) {
  const Eigen::VectorXd d = S.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::LLT<Eigen::MatrixXd> llt(d.asDiagonal() * S * d.asDiagonal());
  if (!d.allFinite() || llt.info() != Eigen::Success) {
    return fail(ErrorCode::refused, "the poses leave at least one combination of parameters undetermined",
                "turn the rig about a second and a third axis");
  }
  const Eigen::MatrixXd C = llt.solve(Eigen::MatrixXd::Identity(S.rows(), S.cols()));
  return Eigen::MatrixXd(d.asDiagonal() * C * d.asDiagonal());
}

}  // namespace mgtd::calib
