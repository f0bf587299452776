// SPDX-License-Identifier: Apache-2.0
#include "calib/design/experiment_design.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "calib/fit/joint/field_uncertainty.h"
#include "calib/fit/joint/joint_fit.h"
#include "calib/fit/joint/tensor_uncertainty.h"
#include "calib/sensor/shown_parameters.h"

#include "calib/calibration/tensor.h"
#include "calib/sensor/sensor_equations.h"

namespace mgtd::calib::design {
namespace {

constexpr std::size_t kHelpful = 6;

Gradient unknown() {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  return {kNaN, kNaN, kNaN, kNaN, kNaN, kNaN};
}

/// Over the components that the array can tell; empty where it can tell none.
std::optional<double> mean_square(const Gradient& g) {
  double sum = 0, count = 0;
  for (const double x : components(g))
    if (!std::isnan(x)) sum += x * x, ++count;
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

/// A room that warms up: fast at first, all of it by the end, so that temperature and time are not the same.
void assume_warming(PoseTable& table, double warming_degC) {
  const bool known = std::any_of(table.poses.begin(), table.poses.end(),
                                 [](const Pose& pose) { return pose.T_degC[0].has_value(); });
  const auto &begin = table.poses.front().t_s, &end = table.poses.back().t_s;
  if (known || warming_degC == 0 || !begin || !end || !(*end > *begin)) return;
  constexpr double kTimeConstants = 3;
  for (Pose& pose : table.poses) {
    if (!pose.t_s) continue;
    const double elapsed = (*pose.t_s - *begin) / (*end - *begin);
    const double rise = (1 - std::exp(-kTimeConstants * elapsed)) / (1 - std::exp(-kTimeConstants));
    pose.T_degC.fill(effects::kReferenceT_degC + warming_degC * rise);
  }
}

PoseTable measured_in_thought(const DesignRequest& request) {
  const Eigen::Vector3d n = fit::joint::direction_of(request.inclination_rad, request.declination_rad);
  PoseTable table = request.poses;
  for (Pose& pose : table.poses) {
    pose.set.clear();
    pose.y_nT = no_readings(request.sensors.size());
    const TableAngles a = pose.angles().value_or(TableAngles{});
    const Eigen::Vector3d b =
        request.f_nT * sensor::table_rotation(a.azimuth_rad, a.pitch_rad, a.roll_rad, 0.0, 0.0) * n;
    for (std::size_t i = 0; i < pose.y_nT.size(); ++i) pose.y_nT[i] = request.sensors[i].predict(b);
    pose.f_nT = request.scalar_sd_nT ? std::optional(request.f_nT) : std::nullopt;
    pose.f_sd_nT = request.scalar_sd_nT;
  }
  if (!table.poses.empty()) assume_warming(table, request.warming_degC);
  return table;
}

struct Named {
  std::string name, unit;
  double factor;
};

/// The fixed block but for the site's own slots, by slot.
std::vector<std::pair<int, Named>> named_slots(const fit::joint::JointProblem& problem) {
  std::vector<std::pair<int, Named>> out;
  for (int slot = 0; slot < problem.slots().sensor_block(); ++slot) {
    const sensor::ShownParameter& shown =
        sensor::shown_parameters()[static_cast<std::size_t>(slot % sensor::kSensorParameters)];
    out.push_back({slot,
                   {fmt::format("s{} {}", slot / sensor::kSensorParameters + 1, shown.name), shown.unit,
                    shown.factor}});
  }
  int slot = problem.slots().effects();
  for (const effects::EffectPtr& effect : problem.effects) {
    for (const effects::Coefficient& c : effect->coefficients())
      out.push_back({slot++, {fmt::format("{} {}", effect->name(), c.name), c.unit, 1}});
  }
  return out;
}

std::vector<Expected> standard_errors(const fit::joint::JointProblem& problem,
                                      const Eigen::MatrixXd& covariance) {
  std::vector<Expected> out;
  for (const auto& [slot, named] : named_slots(problem))
    out.push_back({named.name, std::sqrt(covariance(slot, slot)) * named.factor, named.unit});
  return out;
}

std::vector<Separation> separations(const fit::joint::JointProblem& problem, const Eigen::MatrixXd& S,
                                    const Eigen::MatrixXd& covariance) {
  std::vector<Separation> out;
  const auto named = named_slots(problem);
  for (const auto& [slot, own] : named) {
    if (slot < problem.slots().effects()) continue;
    Separation s{
        .name = own.name, .inflation = std::sqrt(covariance(slot, slot) * S(slot, slot)), .alternative = {}};
    for (const auto& [other, theirs] : named) {
      const double r = covariance(slot, other) / std::sqrt(covariance(slot, slot) * covariance(other, other));
      if (other == slot || std::abs(r) <= std::abs(s.correlation)) continue;
      s.correlation = r;
      s.alternative = theirs.name;
    }
    out.push_back(std::move(s));
  }
  return out;
}

/// Tried one by one: the variance of the tensor, or of the field, with each candidate added.
std::vector<DesignReport::Helpful> most_helpful(const fit::joint::JointProblem& problem,
                                                const fit::joint::JointState& state, const Eigen::MatrixXd& S,
                                                double f_nT, const std::vector<TableAngles>& candidates) {
  const auto variance = [&](const Eigen::MatrixXd& information) {
    const auto covariance = fit::joint::covariance_of(information);
    if (!covariance) return std::numeric_limits<double>::infinity();
    if (const auto tensor = mean_square(
            fit::joint::calibration_tensor_sd(state.sensors, problem.geometry, *covariance, f_nT)))
      return *tensor;
    return std::pow(fit::joint::calibration_field_sd_nT(state.sensors, *covariance, f_nT), 2);
  };
  const double now = variance(S);
  std::vector<DesignReport::Helpful> out;
  for (const TableAngles& angles : candidates)
    out.push_back({angles, 1 - variance(S + fit::joint::information_of(problem, state, angles, f_nT)) / now});
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.share > b.share; });
  out.resize(std::min(out.size(), kHelpful));
  return out;
}

Gradient noise_of_tensor(const DesignRequest& request) {
  const auto rows = calibration::gradient_rows(request.geometry);
  const Eigen::Matrix<double, 6, 1> sd = request.pose_noise_nT * rows.rowwise().norm();
  return {sd[0], sd[1], sd[2], sd[3], sd[4], sd[5]};
}

}  // namespace

bool DesignReport::sees_gradient() const { return mean_square(noise_sd_nT_per_m).has_value(); }

Result<DesignReport> evaluate_design(const DesignRequest& request) {
  const PoseTable table = measured_in_thought(request);
  const auto design = design_problem(request, table);
  if (!design) return tl::unexpected(design.error());
  const auto& [problem, state, gauge] = *design;
  const Eigen::MatrixXd S = fit::joint::reduce(problem, state, 0).S;

  DesignReport report;
  report.sensors = request.sensors.size();
  if (request.power) {
    auto power = design_power(request, table);
    if (!power) return tl::unexpected(power.error());
    report.power = std::move(*power);
  }
  report.poses = static_cast<int>(table.poses.size());
  report.noise_sd_nT_per_m = noise_of_tensor(request);
  report.tensor_sd_nT_per_m = unknown();
  report.assumed = {.f_nT = request.f_nT,
                    .scalar_sd_nT = request.scalar_sd_nT,
                    .field_known = request.field_known,
                    .field_sd_nT = request.field_sd_nT,
                    .inclination_rad = request.inclination_rad,
                    .pose_noise_nT = request.pose_noise_nT,
                    .table_sd_rad = request.table_sd_rad,
                    .warming_degC = request.warming_degC};
  report.gauge = gauge;
  report.known = fit::joint::identifiability(problem, state, S, request.f_nT, request.candidates);
  const auto covariance = fit::joint::covariance_of(S);
  report.determined = covariance && report.known.worst_nT() < fit::joint::kUnusable * request.f_nT;
  if (!report.determined) return report;
  report.parameters = standard_errors(problem, *covariance);
  report.separations = separations(problem, S, *covariance);
  report.tensor_sd_nT_per_m =
      fit::joint::calibration_tensor_sd(request.sensors, request.geometry, *covariance, request.f_nT);
  report.field_sd_nT = fit::joint::calibration_field_sd_nT(request.sensors, *covariance, request.f_nT);
  report.helpful = most_helpful(problem, state, S, request.f_nT, request.candidates);
  return report;
}

}  // namespace mgtd::calib::design
