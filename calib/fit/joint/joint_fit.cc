// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/joint_fit.h"

#include <algorithm>
#include <cmath>

#include "calib/fit/joint/filled_in_error.h"
#include "calib/fit/joint/reference_turn.h"
#include "calib/fit/joint/robust_fit.h"
#include "calib/fit/joint/sample_correlation.h"
#include "calib/fit/joint/single_samples.h"
#include "calib/linear/cholesky.h"
#include "calib/linear/propagation.h"

namespace mgtd::calib::fit::joint {
namespace {

/// Residual over noise: above the first the noise is inflated, below the second no longer; the third is where
/// to begin when nothing is known.
constexpr double kFarOff = 10, kNearAgain = 3, kVeryFarOff = 100;
constexpr double kSizeSettled = 0.1;

/// Among few poses only single ones can be told apart from the others.
double most_left_out(const JointProblem& problem, const JointOptions& options) {
  constexpr std::size_t kFewPoses = 20;
  constexpr double kOfFew = 0.1;
  return problem.poses.size() < kFewPoses ? std::min(kOfFew, options.most_left_out) : options.most_left_out;
}

void fill_statistics(const PoseResiduals& residuals, const Reduced& reduced, JointFit& fit) {
  const JointProblem& problem = fit.problem;
  fit.chi2 = reduced.cost.of_model() * fit.noise_inflation * fit.noise_inflation;
  // Of the attitudes that count: those left out have a cost, too.
  fit.chi2_table = std::pow(residuals.table_ratio, 2) * residuals.attitude_freedom;
  fit.dof_table = residuals.attitude_freedom;
  double unknowns = problem.slots().sensor_block() + problem.coefficients() + problem.site_unknowns() -
                    (fit.gauge.beside_table && !fit.gauge.reference_turn_sd_rad ? 1 : 0);
  double observed = residuals.readings + residuals.scalars + fit.gauge.constraints +
                    (problem.has_angles && problem.known_inclination_rad ? 1 : 0) +
                    (problem.has_angles && problem.known_declination_rad ? 1 : 0);
  for (const JointPose& pose : problem.poses) {
    // Of an attitude that is left out only the turn about the field counts, that no reading tells.
    const int angles = !pose.has_angles ? 0 : pose.attitude_weight > kLooseAttitude_per_rad ? 3 : 1;
    // Of a pose without angles and without readings only the size of its field is asked.
    unknowns += pose.has_angles ? 4 : pose.weight.isZero(0) && !problem.has_reference ? 1 : 3;
    observed +=
        angles + (problem.common_field ? 1 : 0) + (pose.reference_weight > 0 ? (pose.has_angles ? 1 : 3) : 0);
  }
  fit.dof = observed - unknowns - fit.dof_table;
  // Three standard deviations of a chi-square: wider than noise alone would make it, so the uncertainties
  // follow.
  if (fit.dof > 0 && fit.chi2 > fit.dof + 3 * std::sqrt(2 * fit.dof))
    fit.birge_ratio = std::sqrt(fit.chi2 / fit.dof);
}

/// With the noise of readings and scalar reference inflated by the Birge ratio; the table's angles have their
/// own estimate.
Eigen::MatrixXd widened_information(const JointFit& fit) {
  JointProblem wide = fit.problem;
  for (JointPose& pose : wide.poses) {
    pose.weight *= fit.noise_inflation / fit.birge_ratio;
    pose.f_weight *= fit.noise_inflation / fit.birge_ratio;
    pose.reference_weight *= fit.noise_inflation / fit.birge_ratio;
  }
  return reduce(wide, fit.state, 0).S;
}

/// Of the mean alpha, beta and gamma of all sensors.
std::array<double, 3> common_rotation_sd(int sensors, const Eigen::MatrixXd& covariance) {
  const auto sd = [&](int parameter) {
    Eigen::VectorXd row = Eigen::VectorXd::Zero(covariance.rows());
    for (int i = 0; i < sensors; ++i) row[sensor::kSensorParameters * i + parameter] = 1.0 / sensors;
    return std::sqrt(linear::propagated_variance(row, covariance));
  };
  return {sd(sensor::alpha), sd(sensor::beta), sd(sensor::gamma)};
}

Result<JointFit> run(const PoseTable& table, const JointOptions& options, const JointState* warm_start,
                     bool& unsettled) {
  auto problem = joint_problem(table, options);
  if (!problem) return tl::unexpected(problem.error());
  JointFit fit;
  fit.problem = std::move(*problem);
  fit.gauge = fix_gauge(fit.problem, options);
  const double f_nT = start_field_nT(fit.problem, options);
  Result<JointState> state =
      warm_start != nullptr ? joint_state(fit.problem, *warm_start) : joint_start(fit.problem, f_nT);
  if (state && warm_start != nullptr && warm_start->coefficients.size() == state->coefficients.size())
    state->coefficients = warm_start->coefficients;

  FitNoise noise;
  noise.sample_nT = sample_noise(table);
  noise.table_sd_rad = options.table_sd_rad;
  fit.quantisation = quantisation_of(table);
  noise.pose_nT.setConstant(fit.problem.sensors(), 3, kStartNoise_nT);
  noise.more_nT2 = fit.quantisation.variance_nT2.reshaped<Eigen::RowMajor>().matrix();
  if (options.more_nT2.size() > 0) noise.more_nT2 += options.more_nT2;
  fit.noise_inflation = noise.noise_inflation = noise.sample_nT ? options.noise_inflation : 1;
  for (JointPose& pose : fit.problem.poses) {
    pose.f_weight /= fit.noise_inflation;
    pose.reference_weight /= fit.noise_inflation;
  }
  const double most = most_left_out(fit.problem, options);
  auto found = warm_start != nullptr
                   ? robust_fit_from(fit.problem, *std::move(state), noise, most, unsettled)
                   : robust_fit(fit.problem, std::move(state), f_nT, noise, most, unsettled);
  if (!found) return tl::unexpected(found.error());
  noise = found->noise;
  fit.termination = found->termination;
  fit.rounds = found->rounds;
  fit.iterations = found->iterations;
  fit.start = std::move(found->start);
  fit.state = std::move(found->solution.state);
  fit.outliers = found->outliers.nodes(fit.problem, fit.state);
  fit.contradicting = std::max(found->outliers.share(), found->outliers.too_many());
  fit.pose_noise_nT = assumed_noise(fit.problem) / fit.noise_inflation;
  fit.sample_noise_nT = noise.sample_nT;
  fit.table_sd_rad = fit.problem.has_angles ? noise.table_sd_rad : 0;
  Reduced& reduced = found->solution.reduced;
  if (fit.gauge.beside_table) fit.gauge.reference_turn_sd_rad = reference_turn_sd_rad(fit.problem, reduced.S);
  fill_statistics(found->residuals, reduced, fit);
  if (is_recording(fit.problem))
    fit.samples_per_effective = sample_correlation(fit.problem, fit.state).samples_per_effective();
  auto covariance = covariance_of(fit, reduced);
  if (!covariance) return tl::unexpected(covariance.error());
  fit.covariance = *std::move(covariance);
  fit.common_rotation_sd_rad = common_rotation_sd(fit.problem.sensors(), fit.covariance);
  return fit;
}

/// Fits again until noise_inflation is what the residual says; it is one where that is little.
Result<JointFit> sized(const PoseTable& table, JointOptions options, const JointState* warm_start,
                       JointFit fit) {
  constexpr int kMost = 10;  // where a law accounts for nearly all, the size falls by orders of magnitude
  for (int i = 0; i < kMost; ++i) {
    const double wanted = std::sqrt(fit.chi2 / std::max(fit.dof, 1.0));
    options.noise_inflation = wanted > (fit.noise_inflation > 1 ? kNearAgain : kFarOff) ? wanted : 1;
    if (std::abs(options.noise_inflation / fit.noise_inflation - 1) < kSizeSettled) break;
    bool unsettled = false;
    auto next = run(table, options, warm_start, unsettled);
    if (!next) return next;
    fit = *std::move(next);
  }
  return fit;
}

Result<JointFit> settled_run(const PoseTable& table, JointOptions options, const JointState* warm_start) {
  bool unsettled = false;
  auto fit = run(table, options, warm_start, unsettled);
  if (fit || !unsettled || options.noise_inflation > 1 || !sample_noise(table)) return fit;
  options.noise_inflation = kVeryFarOff;
  auto far = run(table, options, warm_start, unsettled);
  if (far) far = sized(table, options, warm_start, *std::move(far));
  if (!far) return fit;
  options.noise_inflation = 1;
  auto again = run(table, options, &far->state, unsettled);
  return again ? std::move(again) : std::move(far);
}

}  // namespace

double JointFit::noise_nT() const { return calibration::root_mean_square(pose_noise_nT); }

Result<JointFit> fit_joint(const PoseTable& table, const JointOptions& options) {
  return settled_run(table, options, nullptr);
}

Result<JointFit> fit_joint(const PoseTable& table, const JointOptions& options,
                           const JointState& warm_start) {
  return settled_run(table, options, &warm_start);
}

Result<JointFit> fit_joint_at_size(const PoseTable& table, const JointOptions& options,
                                   const JointState* warm_start) {
  auto fit = settled_run(table, options, warm_start);
  return fit ? sized(table, options, warm_start, *std::move(fit)) : std::move(fit);
}

Result<Eigen::MatrixXd> covariance_of(const JointFit& fit, const Reduced& reduced) {
  const auto white = covariance_of(fit.birge_ratio > 1 ? widened_information(fit) : reduced.S);
  if (!white) return tl::unexpected(white.error());
  return Eigen::MatrixXd(fit.samples_per_effective * *white + filled_in_error(fit, reduced));
}

Result<Eigen::MatrixXd> covariance_of(const Eigen::MatrixXd& S) {
  const auto information = linear::Cholesky::of(S);
  if (!information) {
    return fail(ErrorCode::refused, "the poses leave at least one combination of parameters undetermined",
                "turn the rig about a second and a third axis");
  }
  return information->inverse();
}

}  // namespace mgtd::calib::fit::joint
