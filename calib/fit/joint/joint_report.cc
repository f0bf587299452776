// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/joint_report.h"

#include <cmath>
#include <limits>
#include <memory>
#include <utility>

#include "calib/calibration/array_model.h"
#include "calib/fit/calibration_frame.h"
#include "calib/fit/error_summary.h"
#include "calib/fit/joint/agreement.h"
#include "calib/fit/joint/joint_cost.h"
#include "calib/fit/joint/joint_errors.h"
#include "calib/fit/joint/joint_findings.h"
#include "calib/fit/joint/memory_variance.h"
#include "calib/fit/joint/profile_search.h"
#include "calib/fit/joint/tensor_uncertainty.h"
#include "calib/fit/joint/wandering_covariance.h"
#include "calib/fit/two_step/two_step.h"
#include "calib/linear/parts.h"
#include "calib/linear/propagation.h"

namespace mgtd::calib::fit::joint {
namespace {

SiteField site_of(const JointFit& fit) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  SiteField out{.f_nT = mean_field(fit),
                .inclination_rad = kUnknown,
                .declination_rad = kUnknown,
                .inclination_sd_rad = kUnknown,
                .declination_sd_rad = kUnknown};
  if (!fit.problem.has_angles) return out;
  const Eigen::Matrix2d rows = inclination_declination_rows(fit.state.direction);
  const Eigen::Matrix2d C = linear::propagated_covariance(
      rows, fit.covariance.block<2, 2>(fit.problem.slots().site(), fit.problem.slots().site()));
  out.inclination_rad = inclination_of(fit.state.direction);
  out.declination_rad = declination_of(fit.state.direction);
  out.inclination_sd_rad = std::sqrt(C(0, 0));
  out.declination_sd_rad = std::sqrt(C(1, 1));
  return out;
}

/// Poses of which the fit left nothing out.
std::vector<Eigen::Index> untouched(const JointFit& fit) {
  std::vector<bool> touched(fit.problem.poses.size(), false);
  for (const OutlierNode& node : fit.outliers) touched.at(node.place) = true;
  std::vector<Eigen::Index> out;
  for (std::size_t k = 0; k < touched.size(); ++k)
    if (!touched[k]) out.push_back(static_cast<Eigen::Index>(k));
  return out;
}

/// Errors of the other methods on the same readings, where those methods can answer.
void compare_methods(const Readings& readings, const FitOptions& options, const JointFit& fit,
                     FitReport& report) {
  const auto errors = [&, counts = counted(fit.problem)](const FieldTable& b_nT) {
    return summarise(b_nT, readings.f_nT, options.geometry, counts);
  };
  report.before = errors(raw_fields(readings));
  FieldTable b = raw_fields(readings);
  const Readings kept = readings.subset(untouched(fit));
  for (std::size_t i = 0; i < readings.y_nT.size(); ++i) {
    const auto step1 = sensor::scalar_calibration(kept.y_nT[i], kept.f_nT);
    if (!step1) continue;  // the row then shows this sensor as it was read
    b.middleRows<3>(3 * static_cast<Eigen::Index>(i)) =
        fit.state.sensors[i].mounting * step1->correct(readings.y_nT[i]);
  }
  report.after_step1 = errors(b);
  FitOptions other = options;
  for (const Method method : {Method::two_step, Method::simplified}) {
    other.method = method;
    const auto fitted = two_step::two_step(kept, other);
    if (!fitted) continue;
    auto& row = method == Method::two_step ? report.two_step : report.simplified;
    row = errors(corrected_fields(readings, fitted->sensors));
  }
}

/// Poses of the set "check", each with its own best field.
std::optional<ErrorSummary> errors_of_check_poses(const PoseTable& table, const JointOptions& options,
                                                  const JointFit& fit) {
  auto problem = joint_problem(table, options, PoseUse::check);
  if (!problem) return std::nullopt;
  for (JointPose& pose : problem->poses) {
    pose.weight = fit.pose_noise_nT.reshaped<Eigen::RowMajor>().cwiseInverse();
    if (pose.has_angles) pose.weigh_attitude(fit.table_sd_rad);
  }
  JointState state = joint_state(*problem, fit.state);
  state.coefficients = fit.state.coefficients;
  set_memory_variance(*problem, state, fit.table_sd_rad);
  add_memory_variance(*problem, 1);
  refit_nuisances(*problem, state);
  return joint_errors(*problem, state, FixedBlock::given).summary;
}

/// How the iterations ended. The start is weighed as the end is, so that the two chi-squares compare.
FitSummary summary_of(const JointFit& fit, double final_cost) {
  return {.termination = fit.termination,
          .rounds = fit.rounds,
          .iterations = fit.iterations,
          .initial_cost = cost_of(fit.problem, fit.start).total(),
          .final_cost = final_cost};
}

void fill_statistics(const JointFit& fit, const Reduced& equations, FitReport& report) {
  report.chi2 = fit.chi2;
  report.dof = fit.dof;
  report.noise_nT = fit.noise_nT();
  report.noise_known = fit.sample_noise_nT.has_value();
  report.table.chi2 = fit.chi2_table;
  report.table.dof = fit.dof_table;
  report.table.sd_rad = fit.table_sd_rad;
  report.outliers = fit.outliers;
  report.site = site_of(fit);
  report.tensor_sd_nT_per_m =
      calibration_tensor_sd(fit.state.sensors, fit.problem.geometry, fit.covariance, report.site.f_nT);
  const JointErrors in = joint_errors(fit.problem, fit.state, FixedBlock::fitted);
  report.after = in.summary;
  report.residual_nT = in.residual_nT;
  if (const auto out = held_out_errors(fit, equations)) {
    report.held_out = out->summary;
    report.held_out_residual_nT = out->residual_nT;
  }
}

/// What an effect does to the corrected components, rms over the poses.
sensor::FieldVector size_of(const JointFit& fit, const effects::EffectPtr& effect, int first) {
  const auto m = static_cast<Eigen::Index>(effect->coefficients().size());
  const calibration::ArrayModel alone(fit.state.sensors, fit.problem.geometry, {effect},
                                      fit.state.coefficients.segment(first, m));
  const calibration::ArrayModel none(fit.state.sensors, fit.problem.geometry, {}, {});
  sensor::FieldVector squares = sensor::FieldVector::Zero(fit.problem.geometry.channels());
  for (const JointPose& pose : fit.problem.poses) {
    const effects::Conditions at = pose.conditions();
    std::optional<Eigen::Matrix3d> R;
    if (pose.has_angles) R = pose.T;
    sensor::FieldVector change = alone.correct(at, pose.y_nT, R) - none.correct(at, pose.y_nT, R);
    if (R) change -= alone.site_field(at, *R);
    squares += change.cwiseAbs2();
  }
  return (squares / static_cast<double>(fit.problem.poses.size())).cwiseSqrt();
}

}  // namespace

double mean_field(const JointFit& fit) {
  if (fit.problem.common_field) return fit.state.f_nT;
  double sum = 0;
  for (const JointPose& pose : fit.problem.poses) sum += pose.f_nT;
  return sum / static_cast<double>(fit.problem.poses.size());
}

JointOptions joint_options(const FitOptions& options) {
  JointOptions out;
  out.geometry = options.geometry;
  out.effects = options.effects;
  out.field_nT = options.field_nT;
  if (options.field_sd_nT > 0) out.field_sd_nT = options.field_sd_nT;
  out.inclination_rad = options.inclination_rad;
  out.declination_rad = options.declination_rad;
  out.table_sd_rad = options.table_sd_rad;
  out.most_left_out = options.most_left_out;
  out.stop = options.stop;
  out.on_round = options.on_round;
  return out;
}

Result<JointOptions> profiled_options(const PoseTable& table, const FitOptions& options) {
  JointOptions out = joint_options(options);
  auto profiled = profile_search(table, out);
  if (!profiled) return tl::unexpected(profiled.error());
  out.effects = *std::move(profiled);
  return out;
}

void fill_calibration(const JointFit& fit, calibration::Calibration& c) {
  const FixedSlots slots = fit.problem.slots();
  const Eigen::Index parameters = slots.sensor_block();
  c.sensors = fit.state.sensors;
  c.covariance = fit.covariance.topLeftCorner(parameters, parameters);
  c.pose_noise_nT = fit.pose_noise_nT * fit.birge_ratio;
  const auto m = fit.state.coefficients.size();
  c.effect_covariance.resize(m, parameters + m);
  c.effect_covariance << fit.covariance.block(slots.effects(), 0, m, parameters),
      fit.covariance.bottomRightCorner(m, m);
  int slot = 0;
  for (const effects::EffectPtr& effect : fit.problem.effects) {
    calibration::CalibratedEffect out{effect->spec(), {}, size_of(fit, effect, slot)};
    for (const effects::Coefficient& coefficient : effect->coefficients()) {
      const double variance = fit.covariance(slots.effects() + slot, slots.effects() + slot);
      out.coefficients.push_back(
          {coefficient.name, fit.state.coefficients[slot], std::sqrt(variance), coefficient.unit});
      ++slot;
    }
    c.effects.push_back(std::move(out));
  }
}

Result<FitReport> joint_report(const PoseTable& table, const FitOptions& options) {
  const auto joint = profiled_options(table, options);
  if (!joint) return tl::unexpected(joint.error());
  auto fit = fit_joint(table, *joint);
  if (!fit) return tl::unexpected(fit.error());
  const Reduced equations = reduce(fit->problem, fit->state, 0);
  const SlowCosines cosines(fit->problem, fit->state);
  const WanderingEstimate wandering = wandering_of(*fit, equations, cosines);
  if (wandering.any()) {
    if (auto covariance = covariance_with_wandering(*fit, equations, cosines, wandering))
      fit->covariance = *std::move(covariance);
  }
  FitOptions with_field = options;
  if (!with_field.field_nT) with_field.field_nT = fit->state.f_nT;  // used only where a pose has none
  const auto readings = readings_of(table, with_field);
  if (!readings) return tl::unexpected(readings.error());
  FitReport report;
  calibration::Calibration frame;
  linear::for_each_part(2, [&](std::size_t part) {
    if (part == 0)
      frame = calibration_frame(table, *readings, options);
    else
      compare_methods(*readings, with_field, *fit, report);
  });
  report.calibration = std::move(frame);
  fill_calibration(*fit, report.calibration);
  fill_statistics(*fit, equations, report);
  report.check_poses = errors_of_check_poses(table, *joint, *fit);
  report.table.stated_sd_rad = options.table_sd_rad;
  if (options.most_left_out > 0) report.contradicting = fit->contradicting;
  report.summary = summary_of(*fit, equations.cost.total());
  report.joint = std::make_shared<const JointFindings>(JointFindings{
      .gauge = fit->gauge,
      .common_rotation_sd_rad = fit->common_rotation_sd_rad,
      .birge_ratio = fit->birge_ratio,
      .samples_per_effective = fit->samples_per_effective,
      .known = identifiability(fit->problem, fit->state, equations.S, report.site.f_nT),
      .agreement = agreement(*fit, equations.S, report.residual_nT, report.held_out_residual_nT),
      .wandering = wandering,
      .quantisation = fit->quantisation,
      .reference_scatter = reference_scatter(table, *fit),
      .dwell_motion = fit->sample_noise_nT ? dwell_motion(table) : std::nullopt});
  return report;
}

}  // namespace mgtd::calib::fit::joint
