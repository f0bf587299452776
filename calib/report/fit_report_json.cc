// SPDX-License-Identifier: Apache-2.0
#include "calib/report/fit_report_json.h"

#include <Eigen/LU>
#include <cmath>
#include <nlohmann/json.hpp>

#include "calib/calibration/calibration_json.h"
#include "calib/effects/effect_spec.h"
#include "calib/fit/joint/joint_findings.h"
#include "calib/report/fit_reasons.h"
#include "calib/report/fit_summary_text.h"
#include "calib/sensor/shown_parameters.h"
#include "proto/json_text.h"
#include "proto/units.h"

namespace mgtd::calib::report {
namespace {

using nlohmann::json;

json components_json(const Gradient& g) {
  return {{"xx", g.xx}, {"yy", g.yy}, {"zz", g.zz}, {"xy", g.xy}, {"xz", g.xz}, {"yz", g.yz}};
}

json value_and_sd(double value, double sd) { return {{"value", value}, {"sd", sd}}; }

json maybe(const std::optional<fit::ErrorSummary>& errors) { return errors ? to_json(*errors) : json(); }

json mounting_json(const Eigen::Matrix3d& m) {
  json rows = json::array();
  for (int i = 0; i < 3; ++i) rows.push_back({m(i, 0), m(i, 1), m(i, 2)});
  return rows;
}

json sensor_json(const calibration::Calibration& c, std::size_t i) {
  const sensor::ParameterVector p = c.sensors[i].parameters();
  json out;
  for (int k = 0; k < sensor::kSensorParameters; ++k) {
    const sensor::ShownParameter& shown = sensor::shown_parameters()[static_cast<std::size_t>(k)];
    const auto at = static_cast<Eigen::Index>(i) * sensor::kSensorParameters + k;
    out[shown.key] =
        value_and_sd(p[k] * shown.factor, std::sqrt(std::max(0.0, c.covariance(at, at))) * shown.factor);
  }
  out["mounting"] = mounting_json(c.sensors[i].mounting);
  out["mirrored"] = c.sensors[i].mounting.determinant() < 0;
  return out;
}

json half_json(const fit::ErrorSummary& errors, const PerSensor<sensor::SensorModel>& sensors) {
  json out = to_json(errors);
  for (const sensor::SensorModel& sensor : sensors) {
    out["sensors"].push_back({{"alpha_deg", to_deg(sensor.alpha_rad)},
                              {"beta_deg", to_deg(sensor.beta_rad)},
                              {"gamma_deg", to_deg(sensor.gamma_rad)}});
  }
  return out;
}

json halves_json(const std::optional<fit::HalvesComparison>& halves) {
  if (!halves) return {};
  json difference = json::array();
  for (std::size_t i = 0; i < halves->odd_sensors.size(); ++i) {
    const sensor::SensorModel &odd = halves->odd_sensors[i], &even = halves->even_sensors[i];
    difference.push_back({{"alpha_deg", to_deg(odd.alpha_rad - even.alpha_rad)},
                          {"beta_deg", to_deg(odd.beta_rad - even.beta_rad)},
                          {"gamma_deg", to_deg(odd.gamma_rad - even.gamma_rad)}});
  }
  return {{"two_step_odd", half_json(halves->odd, halves->odd_sensors)},
          {"two_step_even", half_json(halves->even, halves->even_sensors)},
          {"odd_less_even", std::move(difference)},
          {"largest_difference_deg", to_deg(halves->angle_difference_rad)}};
}

json effects_json(const std::vector<calibration::CalibratedEffect>& effects) {
  json out = json::array();
  for (const calibration::CalibratedEffect& e : effects) {
    json coefficients = json::array();
    for (const calibration::EffectCoefficient& c : e.coefficients) {
      coefficients.push_back({{"name", c.name}, {"value", c.value}, {"sd", c.sd}, {"unit", c.unit}});
    }
    out.push_back({{"effect", effects::family_name(e.effect)},
                   {"spec", e.effect},
                   {"coefficients", std::move(coefficients)}});
  }
  return out;
}

json outliers_json(const std::vector<fit::OutlierNode>& outliers) {
  json out = json::array();
  for (const fit::OutlierNode& o : outliers) {
    out.push_back(
        {{"pose", o.pose}, {"where", o.where}, {"shift", o.shift}, {"unit", o.unit}, {"sigmas", o.sigmas}});
    if (!o.cause.empty()) out.back()["cause"] = o.cause;
  }
  return out;
}

json site_json(const fit::SiteField& site) {
  return {{"f_nT", site.f_nT},
          {"inclination_deg", value_and_sd(to_deg(site.inclination_rad), to_deg(site.inclination_sd_rad))},
          {"declination_deg", value_and_sd(to_deg(site.declination_rad), to_deg(site.declination_sd_rad))}};
}

void add_joint(const fit::FitReport& report, json& out) {
  out["table"] = {
      {"sd_deg", to_deg(report.table.sd_rad)}, {"chi2", report.table.chi2}, {"dof", report.table.dof}};
  out["residual_nT"] = report.residual_nT;
  out["held_out_residual_nT"] = or_null(report.held_out_residual_nT);
  out["outliers"] = outliers_json(report.outliers);
  if (report.joint->samples_per_effective > 1)
    out["samples_per_effective"] = report.joint->samples_per_effective;
  if (const auto& reference = report.joint->reference_scatter)
    out["reference"] = {{"measured_sd_nT", reference->measured_nT},
                        {"stated_sd_nT", reference->stated_nT},
                        {"against", reference->by_scalar ? "f_nT" : "sensors"},
                        {"differs", reference->differs}};
  out["weak"] = weak_texts(report);
  out["tensor_sd_nT_per_m"] = components_json(report.tensor_sd_nT_per_m);
}

}  // namespace

json to_json(const fit::FitSummary& summary) {
  return {{"termination", to_string(summary.termination)},
          {"converged", summary.converged()},
          {"rounds", summary.rounds},
          {"iterations", summary.iterations},
          {"initial_cost", summary.initial_cost},
          {"final_cost", summary.final_cost}};
}

json to_json(const fit::ErrorSummary& errors) {
  return {{"total_field_rmse_nT", errors.total_field_rmse_nT},
          {"tensor_rmse_nT_per_m", components_json(errors.tensor_rmse_nT_per_m)}};
}

json to_json(const fit::FitReport& report) {
  const calibration::Calibration& c = report.calibration;
  json sensors = json::array();
  for (std::size_t i = 0; i < c.sensors.size(); ++i) sensors.push_back(sensor_json(c, i));
  json out{{"schema", "mgt.fit/1"},
           {"id", c.id},
           {"method", c.method},
           {"poses", c.poses},
           {"accepted", c.accepted_by_checks},
           {"reasons", fit_reasons(report)},
           {"checks", calibration::to_json(c.checks)},
           {"summary", to_json(report.summary)},
           {"gauge", c.gauge},
           {"site", site_json(report.site)},
           {"chi2", report.chi2},
           {"dof", report.dof},
           {"noise_nT", report.noise_nT},
           {"baseline_m", c.geometry.cross_baseline_m() ? json(*c.geometry.cross_baseline_m()) : json()},
           {"sensors", std::move(sensors)},
           {"effects", effects_json(c.effects)},
           {"before", to_json(report.before)},
           {"two_step", maybe(report.two_step)},
           {"simplified", maybe(report.simplified)},
           {"after_step1", to_json(report.after_step1)},
           {"after", to_json(report.after)},
           {"held_out", maybe(report.held_out)},
           {"check_poses", maybe(report.check_poses)},
           {"halves", halves_json(report.halves)},
           {"data_hash", c.data_hash},
           {"software", c.software}};
  if (c.method == name(fit::Method::joint)) add_joint(report, out);
  return out;
}

}  // namespace mgtd::calib::report
