// SPDX-License-Identifier: Apache-2.0
#include "calib/criticism/next_measurement.h"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <span>

#include "calib/criticism/residual.h"

namespace mgtd::calib {
namespace {

constexpr std::size_t kPoses = 24;  ///< that an action adds
constexpr double kWorth = 0.01;     ///< gain of the probability that is worth telling
constexpr double kPose_min = 0.5;   ///< where the table tells no times

struct Action {
  const char* text;
  double extra_min;
  /// Changes pose `k` of kPoses; what it needs of the pose is there or left alone.
  void (*change)(Pose& pose, std::size_t k);
};

double share(std::size_t k) { return static_cast<double>(k) / (kPoses - 1); }

void warm(Pose& pose, std::size_t k) {
  for (auto& T : pose.T_degC)
    if (T) *T += 5 * std::sin(std::numbers::pi * share(k));
}

void weaker_field(Pose& pose, std::size_t) {
  constexpr double kShare = 0.8;
  for (auto& y : pose.y_nT) y *= kShare;
  if (pose.f_nT) *pose.f_nT *= kShare;
}

void dwell(Pose& pose, std::size_t k) {
  static constexpr std::array kWaits_s{5.0, 20.0, 60.0};
  if (pose.since_stop_s) pose.since_stop_s = kWaits_s[k % kWaits_s.size()];
}

void toggle(Pose& pose, std::size_t k) {
  for (auto& [name, value] : pose.covariates)
    if (name.ends_with("_A")) value += k % 2 == 0 ? 0.5 : -0.5;
}

void reverse(Pose& pose, std::size_t k) {
  if (pose.sense) pose.sense = k % 2 == 0 ? 1 : -1;
}

constexpr std::array kActions{
    Action{"24 more poses as before", 0, [](Pose&, std::size_t) {}},
    Action{"a heat pulse: warm the heads by 5 degC and let them cool again during 24 poses", 10, &warm},
    Action{"24 poses with the field a fifth weaker (coil)", 5, &weaker_field},
    Action{"24 poses in mixed order with waits of 5, 20 and 60 s before the dwell", 8, &dwell},
    Action{"24 poses with the current switched from pose to pose", 2, &toggle},
    Action{"24 poses approached from alternating sides", 2, &reverse},
};

double minutes_per_pose(const PoseTable& table) {
  const auto &first = table.poses.front().t_s, &last = table.poses.back().t_s;
  if (!first || !last || !(*last > *first)) return kPose_min;
  return (*last - *first) / 60 / static_cast<double>(table.poses.size() - 1);
}

/// The run with the poses of an action behind it; readings stand for the attitude only.
PoseTable extended(const PoseTable& table, const Action& action) {
  PoseTable out = table;
  const Pose& last = table.poses.back();
  const std::size_t n = table.poses.size();
  for (std::size_t k = 0; k < kPoses; ++k) {
    // Attitudes spread over the run, in an order that has none.
    Pose pose = table.poses[(k * 37 + 11) % n];
    pose.number = last.number + static_cast<int>(k) + 1;
    if (pose.set == "check") pose.set = "random";
    if (last.t_s) pose.t_s = *last.t_s + 60 * minutes_per_pose(table) * static_cast<double>(k + 1);
    pose.t_utc.reset();
    action.change(pose, k);
    out.poses.push_back(std::move(pose));
  }
  return out;
}

double normal_cdf(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

/// The fit's model on other poses, ready to project signatures.
struct Design {
  JointProblem problem;
  JointState state;
};

Result<Design> design_of(const PoseTable& table, const JointFit& fit, const JointOptions& options) {
  auto problem = joint_problem(table, options);
  if (!problem) return tl::unexpected(problem.error());
  Design out{.problem = std::move(*problem), .state = {}};
  fix_gauge(out.problem, options);
  weight_by_pose(out.problem, fit.pose_noise_nT);
  for (JointPose& pose : out.problem.poses)
    if (pose.has_angles && fit.table_sd_rad > 0) pose.attitude_weight = 1 / fit.table_sd_rad;
  out.state = joint_state(out.problem, fit.state.sensors, fit.state.direction, fit.state.f_nT);
  if (out.state.coefficients.size() == fit.state.coefficients.size())
    out.state.coefficients = fit.state.coefficients;
  refit_nuisances(out.problem, out.state);
  return out;
}

/// Projected columns of an effect; empty when these poses cannot feed it.
Eigen::MatrixXd columns_of(const Design& design, const Residual& residual, const std::string& spec,
                           const PoseTable& table, std::vector<std::string>* names) {
  const auto parsed = EffectSpec::parse(spec);
  if (!parsed) return {};
  const auto effect = make_effect(*parsed, EffectContext{.table = &table, .offset_nT = {}});
  if (!effect || !(*effect)->check(table)) return {};
  if (names != nullptr)
    for (const Coefficient& c : (*effect)->coefficients()) names->push_back(c.name);
  return residual.project(effect_rows(design.problem, design.state, *effect)).projected;
}

Eigen::VectorXd sizes_of(const Candidate& winner, const std::vector<std::string>& names) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(names.size()));
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (const EffectCoefficient& c : winner.coefficients)
      if (c.name == names[i]) out[static_cast<Eigen::Index>(i)] = c.value;
  }
  return out;
}

/// Smallest probability over the rivals that the winner's name is told right, were it true.
double p_right(const PoseTable& table, const JointFit& fit, const JointOptions& options,
               const Candidate& winner, const std::vector<const Rival*>& rivals) {
  const auto design = design_of(table, fit, options);
  if (!design) return 0;
  const Residual residual(design->problem, design->state, 0);
  std::vector<std::string> names;
  const Eigen::MatrixXd Z = columns_of(*design, residual, winner.spec, table, &names);
  if (Z.cols() == 0) return 0;
  const Eigen::VectorXd v = Z * sizes_of(winner, names);
  double lambda = v.squaredNorm();
  for (const Rival* rival : rivals) {
    const Eigen::MatrixXd B = columns_of(*design, residual, rival->spec, table, nullptr);
    if (B.cols() == 0) continue;
    Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(B);
    qr.setThreshold(1e-6);
    lambda = std::min(lambda, (v - B * qr.solve(v)).squaredNorm());
  }
  return normal_cdf(std::sqrt(lambda) / 2);
}

std::vector<const Rival*> hardest(const Candidate& winner) {
  std::vector<const Rival*> out;
  for (const Rival& rival : winner.rivals)
    if (rival.possible) out.push_back(&rival);
  if (out.empty() && !winner.rivals.empty()) {
    out.push_back(&*std::min_element(winner.rivals.begin(), winner.rivals.end(),
                                     [](const Rival& a, const Rival& b) { return a.p_right < b.p_right; }));
  }
  return out;
}

}  // namespace

std::vector<NextMeasurement> next_measurements(const PoseTable& table, const JointFit& fit,
                                               const JointOptions& options, const Candidate& winner) {
  std::vector<NextMeasurement> out;
  const auto rivals = hardest(winner);
  if (rivals.empty()) return out;
  const double before = p_right(table, fit, options, winner, rivals);
  for (const Action& action : kActions) {
    const double after = p_right(extended(table, action), fit, options, winner, rivals);
    if (after < before + kWorth) continue;
    out.push_back({.action = action.text,
                   .minutes = action.extra_min + minutes_per_pose(table) * static_cast<double>(kPoses),
                   .p_right_before = before,
                   .p_right_after = after});
  }
  std::stable_sort(out.begin(), out.end(), [](const NextMeasurement& a, const NextMeasurement& b) {
    return a.p_right_after > b.p_right_after;
  });
  return out;
}

}  // namespace mgtd::calib
