// SPDX-License-Identifier: Apache-2.0
#include "calib/fit/joint/joint_setup.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "calib/effects/library/common_turn.h"
#include "calib/fit/joint/joint_fit.h"
#include "calib/fit/joint/reference_turn.h"
#include "calib/fit/site_difference.h"
#include "calib/poses/run_time.h"
#include "calib/sensor/sensor_equations.h"

namespace mgtd::calib::fit::joint {
namespace {

/// A reference cannot be better than its last digit, and the weights stay finite.
constexpr double kMinFieldSd_nT = 1e-3;
/// Field over its uncertainty from which on a vector has a direction, and the error of its size is Gaussian.
constexpr double kLeastFieldOfReference = 30;
/// Length of a vector reference over the scalar reference, either way: iron between them makes no more.
constexpr double kMostOfField = 2;
/// Weights of constraints that define a gauge: far stiffer than any data, far softer than rounding.
constexpr double kAngleConstraint = 1 / 1e-7, kScaleConstraint = 1 / 1e-7;

double reference_sd_nT(const Pose& pose) { return std::max(fit::reference_sd_nT(pose), kMinFieldSd_nT); }

/// The vector reference of a pose that has one, and the total field beside it.
void set_reference(const Pose& pose, const SiteDifference& difference, JointPose& out) {
  const double sd_nT = reference_sd_nT(pose);
  const TotalField total = total_field(pose, difference);
  out.reference_nT = *pose.ref_nT;
  out.f_nT = total.f_nT;
  if (pose.f_nT) out.f_weight = 1 / std::max(total.sd_nT, kMinFieldSd_nT);
  if (!pose.angles()) {
    out.reference_weight = 1 / sd_nT;
    return;
  }
  out.reference_sd_rad = sd_nT / pose.ref_nT->norm();
  if (pose.f_nT) return;  // two places, two sizes: that of the array counts
  if (difference.known()) {
    out.filled_in = true;
    out.f_weight = 1 / std::max(total.sd_nT, kMinFieldSd_nT);
  } else {
    out.reference_weight = 1 / sd_nT;
  }
}

JointPose joint_pose(const Pose& pose, const JointOptions& options, bool common_field,
                     const SiteDifference& difference, const poses::RunTime& time) {
  JointPose out;
  out.pose = &pose;
  out.t_h = time.hours(pose);
  out.y_nT = calibration::stacked(pose.y_nT);
  out.weight = Channels::Constant(out.y_nT.size(), 1 / kStartNoise_nT);
  if (pose.ref_nT) {
    set_reference(pose, difference, out);
  } else if (common_field) {
    out.f_weight = 1 / kCommonFieldSpread_nT;
  } else {
    const double sd = pose.f_nT ? scalar_sd_nT(pose) : options.field_sd_nT.value_or(kCommonFieldSpread_nT);
    out.f_nT = pose.f_nT ? *pose.f_nT : *options.field_nT;
    out.f_weight = 1 / std::max(sd, kMinFieldSd_nT);
    out.filled_in = !pose.f_nT;
  }
  if (const auto angles = pose.angles()) {
    out.has_angles = true;
    out.T = sensor::table_rotation(angles->azimuth_rad, angles->pitch_rad, angles->roll_rad, 0.0, 0.0);
    out.weigh_attitude(options.table_sd_rad);
  }
  return out;
}

LinearPrior mean_of(const JointProblem& problem, std::initializer_list<int> parameters, double target,
                    double weight) {
  LinearPrior prior{.row = Eigen::VectorXd::Zero(problem.fixed()), .target = target, .weight = weight};
  const double share = 1.0 / (problem.sensors() * static_cast<double>(parameters.size()));
  for (int i = 0; i < problem.sensors(); ++i) {
    for (const int p : parameters) prior.row[sensor::kSensorParameters * i + p] = share;
  }
  return prior;
}

LinearPrior about_slot(const JointProblem& problem, int slot, double target, double sd) {
  LinearPrior prior{.row = Eigen::VectorXd::Zero(problem.fixed()), .target = target, .weight = 1 / sd};
  prior.row[slot] = 1;
  return prior;
}

void add_coefficient_priors(JointProblem& problem) {
  int slot = problem.slots().effects();
  for (const effects::EffectPtr& effect : problem.effects) {
    for (const effects::Coefficient& c : effect->coefficients()) {
      if (c.prior_sd > 0) problem.priors.push_back(about_slot(problem, slot, 0, c.prior_sd));
      ++slot;
    }
  }
}

/// Without attitudes, a turn that all sensors make with the temperature is one of the array: s1 makes none.
void hold_common_turns(JointProblem& problem, Gauge& gauge) {
  constexpr double kHeld = 1e-4;  // of the size that occurs
  int slot = problem.slots().effects();
  for (const effects::EffectPtr& effect : problem.effects) {
    const Eigen::MatrixXd turn = effects::library::turn_of_first_sensor(*effect, problem.sensors());
    for (Eigen::Index k = 0; k < turn.rows(); ++k) {
      LinearPrior prior{.row = Eigen::VectorXd::Zero(problem.fixed()),
                        .target = 0,
                        .weight = 1 / (kHeld * effect->coefficients().front().typical)};
      prior.row.segment(slot, turn.cols()) = turn.row(k);
      problem.priors.push_back(std::move(prior));
      ++gauge.constraints;
      gauge.turns_held = true;
    }
    slot += static_cast<int>(effect->coefficients().size());
  }
}

Result<void> check_reference(const PoseTable& table, std::ptrdiff_t with_reference, std::ptrdiff_t total,
                             const auto& fitted) {
  if (with_reference == 0) return {};
  if (with_reference != total)
    return fail(
        ErrorCode::refused,
        fmt::format("{} of {} poses have the field as a vector (ref_x_nT ...)", with_reference, total),
        "give it for every pose, or take the columns out");
  const auto turned = std::count_if(table.poses.begin(), table.poses.end(),
                                    [&](const Pose& p) { return fitted(p) && p.angles(); });
  if (turned == 0) return {};
  if (turned != total)
    return fail(
        ErrorCode::refused,
        fmt::format("{} of {} poses with the field as a vector have table angles", turned, total),
        "give the angles of every pose (the reference then stands still beside the table) or of none (the "
        "vector is then in a frame fixed to the sensors)");
  const auto weak = std::find_if(table.poses.begin(), table.poses.end(), [&](const Pose& p) {
    return fitted(p) && p.ref_nT->norm() < kLeastFieldOfReference * reference_sd_nT(p);
  });
  if (weak != table.poses.end())
    return fail(
        ErrorCode::refused,
        fmt::format("pose {}: the vector of the reference, {:.4g} nT long and known to {:.3g} nT for each "
                    "component, has no direction (limit {:.0f} times that, {:.3g} nT)",
                    weak->number, weak->ref_nT->norm(), reference_sd_nT(*weak), kLeastFieldOfReference,
                    kLeastFieldOfReference * reference_sd_nT(*weak)),
        "check ref_sd_nT and the unit of ref_x_nT, ref_y_nT and ref_z_nT, or leave this pose out");
  const auto other_size = std::find_if(table.poses.begin(), table.poses.end(), [&](const Pose& p) {
    if (!fitted(p) || !p.f_nT) return false;
    const double ratio = p.ref_nT->norm() / *p.f_nT;
    return ratio > kMostOfField || ratio < 1 / kMostOfField;
  });
  if (other_size != table.poses.end())
    return fail(ErrorCode::refused,
                fmt::format("pose {}: the vector of the reference is {:.4g} nT long where f_nT is {:.4g} nT "
                            "(limit a factor of {:.0f})",
                            other_size->number, other_size->ref_nT->norm(), *other_size->f_nT, kMostOfField),
                "check the units of ref_x_nT, ref_y_nT, ref_z_nT and of f_nT");
  return {};
}

}  // namespace

Result<JointProblem> joint_problem(const PoseTable& table, const JointOptions& options, PoseUse use) {
  JointProblem problem;
  problem.geometry = options.geometry;
  problem.stop = options.stop;
  problem.on_round = options.on_round;
  auto effects = effects::library::bound_to_run(options.effects, {.table = &table, .offset_nT = {}});
  if (!effects) return tl::unexpected(effects.error());
  problem.effects = std::move(*effects);
  for (const effects::EffectPtr& effect : problem.effects) {
    if (const auto ok = effect->applicable(table); !ok) return tl::unexpected(ok.error());
  }
  const auto fitted = [use](const Pose& pose) { return (pose.set == "check") == (use == PoseUse::check); };
  const auto total = std::count_if(table.poses.begin(), table.poses.end(), fitted);
  const auto with_f = std::count_if(table.poses.begin(), table.poses.end(),
                                    [&](const Pose& p) { return fitted(p) && p.f_nT; });
  if (static_cast<std::size_t>(total) < (use == PoseUse::fit ? kFewestPoses : 1)) {
    return fail(ErrorCode::refused,
                fmt::format("{} poses to fit; the joint fit needs at least {}", total, kFewestPoses),
                "measure at least 12 poses in general position, better 60");
  }
  const auto with_reference = std::count_if(table.poses.begin(), table.poses.end(),
                                            [&](const Pose& p) { return fitted(p) && p.ref_nT; });
  if (auto ok = check_reference(table, with_reference, total, fitted); !ok) return tl::unexpected(ok.error());
  if (with_f != 0 && with_f != total && with_reference == 0 && !options.field_nT) {
    return fail(ErrorCode::refused, fmt::format("{} of {} poses have a scalar reference f_nT", with_f, total),
                "give f_nT for every pose, or give the field of the others with --field");
  }
  problem.has_reference = with_reference > 0;
  problem.common_field = with_f == 0 && !problem.has_reference;
  problem.means = std::make_shared<const effects::CovariateMeans>(effects::covariate_means(table));
  const SiteDifference difference = site_difference(table);
  problem.filled_in_sd_nT =
      problem.has_reference ? difference.sd_nT : options.field_sd_nT.value_or(kCommonFieldSpread_nT);
  const poses::RunTime time = poses::RunTime::of(table);
  const Pose* previous = nullptr;
  problem.poses.reserve(static_cast<std::size_t>(total));
  for (const Pose& pose : table.poses) {
    if (fitted(pose)) {
      problem.poses.push_back(joint_pose(pose, options, problem.common_field, difference, time));
      problem.poses.back().means = problem.means.get();
      problem.poses.back().previous = previous;
      problem.has_angles = problem.has_angles || problem.poses.back().has_angles;
    }
    previous = &pose;
  }
  return problem;
}

Gauge fix_gauge(JointProblem& problem, const JointOptions& options) {
  Gauge gauge{.angles = angle_coverage(problem),
              .declination_known = false,
              .scale_known = !problem.common_field || options.field_nT.has_value(),
              .constraints = 0};
  gauge.declination_known = gauge.angles == AngleCoverage::one_axis && options.declination_rad;
  add_coefficient_priors(problem);
  // Where the angles decide, what the operator says is compared with the result and does not enter it.
  if (gauge.angles != AngleCoverage::full) {
    problem.known_inclination_rad = options.inclination_rad;
    problem.known_declination_rad = options.declination_rad;
    problem.direction_weight = 1 / options.table_sd_rad;
  }
  gauge.by_reference = problem.platform_reference();
  gauge.beside_table = problem.site_reference();
  if (gauge.beside_table)
    problem.priors.push_back(about_slot(problem, problem.slots().field(), 0,
                                        keeps_direction(problem) ? kHeldTurn_rad : kFreeTurn_rad));
  if (gauge.angles == AngleCoverage::none && !gauge.by_reference) {
    for (const int p : {sensor::alpha, sensor::beta, sensor::gamma})
      problem.priors.push_back(mean_of(problem, {p}, 0, kAngleConstraint));
    gauge.constraints += 3;
    hold_common_turns(problem, gauge);
  } else if (gauge.angles == AngleCoverage::one_axis && !gauge.declination_known) {
    problem.priors.push_back(mean_of(problem, {sensor::gamma}, 0, kAngleConstraint));
    gauge.constraints += 1;
  }
  if (!gauge.scale_known) {
    problem.priors.push_back(mean_of(problem, {sensor::cx, sensor::cy, sensor::cz}, 1, kScaleConstraint));
    gauge.constraints += 1;
  } else if (problem.common_field) {
    problem.priors.push_back(about_slot(problem, problem.slots().field(), *options.field_nT,
                                        options.field_sd_nT.value_or(kCommonFieldSpread_nT)));
  }
  return gauge;
}

double start_field_nT(const JointProblem& problem, const JointOptions& options) {
  if (problem.common_field && options.field_nT) return *options.field_nT;
  double sum = 0;
  if (!problem.common_field) {
    for (const JointPose& pose : problem.poses) sum += pose.f_nT;
    return sum / static_cast<double>(problem.poses.size());
  }
  // Readings of unit scale on a sphere about their centre: the spread of all directions together is the
  // radius.
  Channels mean = Channels::Zero(problem.channels());
  for (const JointPose& pose : problem.poses) mean += pose.y_nT / static_cast<double>(problem.poses.size());
  for (const JointPose& pose : problem.poses)
    sum += sensor::over_channels(mean.size(),
                                 [&](auto rows) { return (pose.y_nT - mean).head(rows).squaredNorm(); }) /
           problem.sensors();
  return std::sqrt(sum / static_cast<double>(problem.poses.size()));
}

}  // namespace mgtd::calib::fit::joint
