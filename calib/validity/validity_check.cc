// SPDX-License-Identifier: Apache-2.0
#include "calib/validity/validity_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/fit/joint/data_faults.h"
#include "calib/fit/joint/joint_cost.h"
#include "calib/fit/joint/joint_errors.h"
#include "calib/fit/joint/joint_report.h"
#include "calib/fit/joint/memory_variance.h"
#include "calib/fit/joint/outliers.h"
#include "calib/fit/site_difference.h"
#include "calib/linear/propagation.h"
#include "calib/linear/symmetric_eigen.h"
#include "calib/poses/pose_table.h"
#include "calib/poses/run_time.h"
#include "calib/sensor/sensor_equations.h"
#include "calib/stats/chi_square.h"
#include "calib/validity/fixed_calibration.h"
#include "calib/validity/restricted_fit.h"

namespace mgtd::calib::validity {
namespace {

/// Scatter beyond the noise that a calibration may show and still be called valid: its own run set the noise,
/// so more than this is something new.
constexpr double kMaxExcess = 1.5;
constexpr double kByChance = 0.003;  ///< probability that noise alone scatters so much more or less
constexpr double kLeastNoise_nT = 1e-3;
constexpr std::size_t kMinPoses = 4;
/// Of the poses: what more of them contradict is the calibration.
constexpr double kMostLeftOut = 0.1;

/// The poses as the test wants them: all alike, and without table angles unless an effect needs them. Of a
/// reference beside the table the size of the field is then what is left.
PoseTable prepared(const PoseTable& table, bool needs_angles) {
  PoseTable out = table;
  const fit::SiteDifference difference = fit::site_difference(table);
  for (Pose& pose : out.poses) {
    pose.set = "check";  // predicted, never fitted: as few as there are
    if (needs_angles || !pose.angles()) continue;
    if (pose.ref_nT) {
      const fit::TotalField field = fit::total_field(pose, difference);
      pose.f_nT = field.f_nT, pose.f_sd_nT = field.sd_nT;
    }
    pose.azimuth_rad = pose.pitch_rad = pose.roll_rad = std::nullopt;
    pose.ref_nT = std::nullopt, pose.ref_sd_nT = std::nullopt;
  }
  return out;
}

/// Each axis as noisy as its dwells say, and no less than it scattered in the calibration's own run: what
/// that run's model left out is not news.
bool weight(const calibration::Calibration& c, const PoseTable& poses, fit::joint::JointProblem& problem) {
  const calibration::AxisNoise own = c.pose_noise_nT.cwiseMax(kLeastNoise_nT);
  fit::joint::weight_by_pose(problem, own);
  const auto sample = fit::joint::sample_noise(poses);
  if (!sample) return false;
  fit::joint::weight_by_samples(problem, *sample);
  for (fit::joint::JointPose& pose : problem.poses)
    pose.weight = pose.weight.cwiseMin(own.reshaped<Eigen::RowMajor>().cwiseInverse());
  return true;
}

/// A gauge is no evidence; a known field and what is known of the site are.
void keep_site_priors(const std::vector<Eigen::Index>& tested, fit::joint::JointProblem& problem) {
  std::erase_if(problem.priors,
                [&](const fit::joint::LinearPrior& prior) { return !prior.row(tested).isZero(); });
}

/// Effects of time and of currents count from where they counted in the run that was fitted.
void as_in_its_run(const calibration::Calibration& c, fit::joint::JointProblem& problem) {
  poses::RunTime time;
  if (const auto start = parse_utc(c.reference.t_utc)) time.start = *start;
  problem.means = std::make_shared<const effects::CovariateMeans>(c.reference.currents_A);
  for (fit::joint::JointPose& pose : problem.poses) {
    pose.t_h = time.hours(*pose.pose);
    pose.means = problem.means.get();
  }
}

/// Score and information of the tested slots, everything else eliminated.
struct Score {
  Eigen::MatrixXd S;
  Eigen::VectorXd g;
};

Score score_of(const fit::joint::Reduced& reduced, const FixedCalibration& fixed) {
  const auto &t = fixed.tested, &n = fixed.nuisance;
  const Eigen::MatrixXd border = reduced.S(t, n);
  const Eigen::MatrixXd corner = inverse_of(reduced.S(n, n)).W;
  return {reduced.S(t, t) - border * corner * border.transpose(),
          reduced.g(t) - border * corner * reduced.g(n)};
}

/// The directions of the tested slots that these poses see, whitened: z = A (change) + unit noise.
struct Seen {
  Eigen::MatrixXd A;
  Eigen::VectorXd z;
};

Seen seen_of(const Score& score) {
  constexpr double kUnseen = 1e-10;  // of the largest eigenvalue; rounding leaves 1e-13
  const Eigen::VectorXd d = score.S.diagonal().cwiseMax(0).cwiseSqrt();
  const Eigen::VectorXd inverse = (d.array() > 0).select(d.cwiseInverse(), 0.0);
  const linear::SymmetricEigen eigen =
      linear::symmetric_eigen(inverse.asDiagonal() * score.S * inverse.asDiagonal());
  const Eigen::VectorXd& values = eigen.values;
  const auto unseen = (values.array() < kUnseen * values.maxCoeff()).count();
  const Eigen::Index seen = values.size() - unseen;
  const Eigen::MatrixXd V = eigen.vectors.rightCols(seen);
  const Eigen::VectorXd root = values.tail(seen).cwiseSqrt();
  return {root.asDiagonal() * V.transpose() * d.asDiagonal(),
          root.cwiseInverse().asDiagonal() * (V.transpose() * inverse.cwiseProduct(score.g))};
}

bool field_known(const fit::joint::JointProblem& problem) {
  return std::any_of(problem.priors.begin(), problem.priors.end(), [&](const fit::joint::LinearPrior& prior) {
    return prior.row[problem.slots().field()] != 0;
  });
}

/// Scatter that no change of the tested parameters explains, over the noise; 1 where that is chance. With
/// all of them free, as a fit of these poses alone would leave it.
double excess_of(const fit::joint::JointProblem& problem, const fit::joint::JointState& state,
                 const FixedCalibration& fixed, Eigen::Index seen) {
  std::vector<Eigen::Index> free = fixed.tested;
  free.insert(free.end(), fixed.nuisance.begin(), fixed.nuisance.end());
  const fit::joint::JointState best = restricted_fit(problem, free, state);
  const fit::joint::PoseResiduals residuals = fit::joint::pose_residuals(problem, best);
  double observed = residuals.readings + residuals.scalars - residuals.attitude_freedom;
  for (const fit::joint::JointPose& pose : problem.poses)
    observed += pose.beside() + (problem.common_field ? 1 : 0);
  const double site = problem.site_unknowns() - (problem.common_field && field_known(problem) ? 1 : 0) +
                      static_cast<double>(fixed.nuisance.size()) - fit::joint::kGlobals;
  const double dof = observed - site - static_cast<double>(seen);
  const double chi2 = fit::joint::cost_of(problem, best).of_model();
  if (!(dof > 0)) return 1;
  const double p = stats::chi_square_p(chi2, dof);
  return std::min(p, 1 - p) < kByChance / 2 ? std::sqrt(chi2 / dof) : 1;
}

Evidence evidence_of(const FixedCalibration& fixed, const PerSensor<sensor::SensorModel>& sensors,
                     const Score& score, const Seen& seen, double noise, bool free_scale) {
  const Eigen::MatrixXd A = seen.A / noise;
  const Eigen::Index n = A.rows();
  const Eigen::MatrixXd freedoms = common_freedoms(sensors, A.cols(), free_scale);
  // A freedom that these poses do not see at all is out already.
  std::vector<Eigen::Index> visible;
  for (Eigen::Index j = 0; j < freedoms.cols(); ++j) {
    const double whole = freedoms.col(j).cwiseAbs2().dot(score.S.diagonal());
    if ((seen.A * freedoms.col(j)).squaredNorm() > 1e-8 * whole) visible.push_back(j);
  }
  return {.difference = seen.z / noise,
          .covariance = Eigen::MatrixXd::Identity(n, n) + linear::propagated_covariance(A, fixed.covariance),
          .gain = A,
          .common = A * freedoms(Eigen::all, visible),
          .slots = shown_slots(sensors.size(), fixed.instrument),
          .sensors = sensors.size()};
}

/// The turn Q by which the array was placed, and what is left of it.
std::optional<CommonTurn> turn_of(const fit::joint::JointProblem& problem, const Eigen::Matrix3d& Q,
                                  const Evidence& evidence) {
  if (!problem.platform_reference() || evidence.common.cols() != 3) return std::nullopt;
  const CommonPart rest = common_part(evidence);
  const Eigen::Vector3d small = rest.size;
  return common_turn(sensor::turn_by<double>(small) * Q, rest.covariance.diagonal().cwiseSqrt());
}

double rms_noise(const fit::joint::JointProblem& problem) {
  double variance = 0;
  for (const fit::joint::JointPose& pose : problem.poses)
    variance += sensor::over_channels(pose.weight.size(), [&](auto n) {
      return pose.weight.head(n).cwiseMax(1e-9).cwiseAbs2().cwiseInverse().mean();
    });
  return std::sqrt(variance / static_cast<double>(problem.poses.size()));
}

/// The fixed calibration among the poses: problem and state, poses that contradict set aside.
struct Settled {
  fit::joint::JointProblem problem;
  fit::joint::PlacedState placed;
  fit::joint::Outliers outliers;
};

Result<Settled> settle(const calibration::Calibration& c, const PoseTable& poses,
                       const FixedCalibration& fixed, const fit::FitOptions& options,
                       ValidityReport& report) {
  fit::joint::JointOptions joint = fit::joint::joint_options(options);
  joint.inclination_rad = joint.declination_rad = std::nullopt;
  joint.geometry = c.geometry;
  joint.effects = fixed.effects;
  auto problem = fit::joint::joint_problem(poses, joint, fit::PoseUse::check);
  if (!problem) return tl::unexpected(problem.error());
  as_in_its_run(c, *problem);
  fit::joint::fix_gauge(*problem, joint);
  keep_site_priors(fixed.tested, *problem);
  report.noise_from_dwells = weight(c, poses, *problem);
  report.noise_nT = rms_noise(*problem);
  const double f_nT =
      options.field_nT.value_or(c.reference.f_nT.value_or(fit::joint::start_field_nT(*problem, joint)));
  if (const auto units = fit::joint::check_units(*problem, f_nT); !units)
    return tl::unexpected(units.error());
  Settled out{.problem = std::move(*problem), .placed = {}, .outliers = fit::joint::Outliers(kMostLeftOut)};
  auto placed = fit::joint::placed_state(out.problem, c.sensors, f_nT);
  if (!placed) return tl::unexpected(placed.error());
  out.placed = *std::move(placed);
  fit::joint::JointState& state = out.placed.state;
  state.coefficients = fixed.coefficients;
  fit::joint::set_memory_variance(out.problem, state, joint.table_sd_rad);
  fit::joint::add_memory_variance(out.problem, 1);
  do {
    state = restricted_fit(out.problem, fixed.nuisance, std::move(state));
  } while (out.outliers.judge(out.problem, state, fit::joint::pose_residuals(out.problem, state)));
  return out;
}

/// The covariance in the platform frame in which the array stands now.
void turn_covariance(const calibration::Calibration& c, const Eigen::Matrix3d& Q, FixedCalibration& fixed) {
  const Eigen::MatrixXd J = turned(c.sensors, Q).jacobian;
  const Eigen::MatrixXd rows = J * fixed.covariance.topRows(J.rows());
  fixed.covariance.topRows(J.rows()) = rows;
  const Eigen::MatrixXd columns = fixed.covariance.leftCols(J.rows()) * J.transpose();
  fixed.covariance.leftCols(J.rows()) = columns;
}

}  // namespace

Result<ValidityReport> check(const calibration::Calibration& calibration, const PoseTable& table,
                             const fit::FitOptions& options) {
  if (table.poses.size() < kMinPoses) {
    return fail(ErrorCode::refused,
                fmt::format("{} poses to check with; at least {} are needed", table.poses.size(), kMinPoses),
                "measure a dozen poses with the field in different directions");
  }
  auto fixed = fixed_calibration(calibration, options.effects);
  if (!fixed) return tl::unexpected(fixed.error());
  const PoseTable poses = prepared(table, fixed->needs_angles);
  ValidityReport report;
  report.calibration = calibration.id;
  report.poses = static_cast<int>(poses.poses.size());
  report.own_poses = poses::data_hash(table) == calibration.data_hash;
  const auto settled = settle(calibration, poses, *fixed, options, report);
  if (!settled) return tl::unexpected(settled.error());
  const fit::joint::JointProblem& problem = settled->problem;
  const fit::joint::JointState& state = settled->placed.state;
  report.outliers = settled->outliers.nodes(problem, state);
  turn_covariance(calibration, settled->placed.Q, *fixed);
  const Score score = score_of(fit::joint::reduce(problem, state, 0), *fixed);
  const Seen seen = seen_of(score);
  report.excess = excess_of(problem, state, *fixed, seen.z.size());
  const double factor = small_sample_factor(calibration.poses, calibration.sensors.size());
  fixed->covariance *= factor;
  const double noise = report.excess * std::sqrt(factor);
  const bool free_scale = problem.common_field && !options.field_nT;
  const Evidence evidence = evidence_of(*fixed, state.sensors, score, seen, noise, free_scale);
  report.change = judge(evidence);
  report.turn = turn_of(problem, settled->placed.Q, evidence);
  const fit::joint::JointErrors errors =
      fit::joint::joint_errors(problem, state, fit::joint::FixedBlock::given);
  report.errors = errors.summary;
  report.residual_nT = errors.residual_nT;
  report.valid = !report.changed() && report.excess <= kMaxExcess;
  return report;
}

}  // namespace mgtd::calib::validity
